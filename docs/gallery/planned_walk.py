"""A walk planned from footsteps, from rest to rest, that nothing has to hold."""

import math

import exo_pin
from exo_pin.walking import footsteps, plan_walk

robot = exo_pin.load_robot()
plan = plan_walk(robot, footsteps(4, 0.25, turn=math.radians(10), width=robot.body.hip_width))

print(f"{plan.gait.time[-1]:.1f} s, {len(plan.gait.time)} samples")
forward, sideways = plan.zmp_rms
print(f"zero-moment point off its path: {1e3 * forward:.1f} mm rms forward, {1e3 * sideways:.1f} sideways")
print(f"least margin inside the soles: {1e3 * plan.margins.min():.0f} mm")
print("the device can do it" if plan.ok else "\n".join(plan.reasons))
