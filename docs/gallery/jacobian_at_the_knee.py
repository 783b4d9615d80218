"""The Jacobian of a foot, and the direction that it loses where the knee is straight."""

import numpy as np

import exo_pin
from exo_pin.kinematics import jacobian, poses

robot = exo_pin.load_robot()
knee = robot.joints.index("left_knee_flexion")
print("knee [deg]  smallest singular value of the left foot's Jacobian")
smallest = []
for degrees in (60, 30, 10, 3, 1, 0):
    q = np.zeros(12)
    q[knee] = np.radians(degrees)
    smallest.append(np.linalg.svd(jacobian(robot, q, "left_foot"), compute_uv=False)[5])
    print(f"{degrees:10d}  {smallest[-1]:.5f}")
assert smallest[-1] < 1e-9  # the foot cannot move along the straight leg

q, step = np.full(12, 0.2), 1e-6  # a difference quotient is the same as the Jacobian
turned = q + step * np.eye(12)[knee]
moved = (poses(robot, turned)[0] - poses(robot, q)[0])[:3, 3] / step
difference = abs(jacobian(robot, q, "left_foot")[:3, knee] - moved).max()
print(f"against a difference quotient: {difference:.0e} m/rad")
assert difference < 1e-5
