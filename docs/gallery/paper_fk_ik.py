"""The paper's forward and inverse kinematics: a walk's foot paths, and joint angles from them."""

import numpy as np

import exo_pin

robot = exo_pin.load_robot(exo_pin.Body.from_stature(1.75))
gait = exo_pin.normative_gait("free", leg_length=robot.body.leg_length)
q = robot.from_gait(gait)  # (n, 12) rad

feet = exo_pin.poses(robot, q, base=gait.base)  # (n, 2, 4, 4): left and right sole in the world
track = exo_pin.ik.track(robot, {"left_foot": feet[:, 0], "right_foot": feet[:, 1]}, base=gait.base)

left = feet[:, 0, :3, 3]
print(f"left foot: {np.ptp(left[:, 0]):.3f} m fore and aft, {np.ptp(left[:, 2]):.3f} m up")
print(f"feet reached within {track.position_error.max():.0e} m")
print(f"joint angles recovered within {np.degrees(abs(track.q - q).max()):.0e} deg")
assert track.converged.all()
