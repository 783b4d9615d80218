"""Devices side by side: what each loses of the normal walk."""

import exo_pin

done = exo_pin.compare.compare(exo_pin.normative_gait("free"), ["exo12", "lokomat", "lopes8"])
print("device    sole off the recorded path, rms [mm]")
for loss in done.best:
    print(f"{loss.device.name:9} {1e3 * loss.rms:.1f}")
