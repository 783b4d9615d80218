"""The walk on another robot: joint angles for TALOS."""

import numpy as np

import exo_pin

done = exo_pin.retarget.retarget(exo_pin.normative_gait("free"), "talos")
print(f"{done.target.name}: {done.q.shape[1]} joints, paths scaled by {done.scale[0]:.2f}")
for j, joint in enumerate(done.biped.joints):
    low, high = np.degrees([done.q[:, j].min(), done.q[:, j].max()])
    print(f"{joint:24} {low:6.1f} .. {high:5.1f} deg")
print(f"largest step between samples: {np.degrees(abs(np.diff(done.q, axis=0)).max()):.1f} deg")
for note in done.notes:
    print("note:", note)
