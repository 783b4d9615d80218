"""The Denavit-Hartenberg table of the left leg, and its chain of matrices against Pinocchio."""

import math

import numpy as np

import exo_pin
from exo_pin import crosscheck, dh

robot = exo_pin.load_robot()

print(f"{'joint':24} alpha [deg]  a [m]  offset [deg]  d [m]")
for row in dh.table(robot.body, "left"):
    alpha, offset = math.degrees(row.alpha), math.degrees(row.offset)
    print(f"{row.joint:24} {alpha:11.0f}  {row.a:5.3f}  {offset:12.0f}  {row.d:5.3f}")

q = np.random.default_rng(1).uniform(robot.lower, robot.upper, (100, 12))
difference = crosscheck.forward(robot, q)["dh"]
print(f"against Pinocchio in 100 random poses: {difference:.0e} m")
assert difference < 1e-12
