"""Joint torques of a walk without force plates: inverse dynamics with a predicted ground reaction."""

import numpy as np

import exo_pin
from exo_pin import dynamics

robot, walk = exo_pin.load_robot(exo_pin.Body.from_stature(1.75, mass=70)), exo_pin.normative_gait("free")
found = dynamics.torques(robot, walk)

print("joint                     largest torque [N m]  largest power [W]")
for j, joint in enumerate(robot.joints[:6]):
    print(f"{joint:24} {np.nanmax(abs(found.torque[:, j])):21.1f} {np.nanmax(abs(found.power[:, j])):18.1f}")
print(f"force under both feet: {found.ground.force[..., 2].sum(axis=1).mean():.0f} N in the mean")
