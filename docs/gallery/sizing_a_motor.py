"""Which gear ratio lets a motor bear the normal walk, joint by joint."""

import exo_pin
from exo_pin import dynamics, sizing

robot, walk = exo_pin.load_robot(), exo_pin.normative_gait("slow")
found = sizing.size(
    dynamics.torques(robot, walk),
    stride=sizing.stride_time(robot, walk),
    motor=sizing.find_motor("maxon-ec-90-flat-48v"),
)
for joint in found.joints[:6]:
    best = joint.ratios.best
    ratio = f"gear {best.ratio:.0f}:1" if best else "no gear ratio bears it"
    print(f"{joint.load.joint:24} {joint.load.rms_torque:6.1f} N m rms: {ratio}")
