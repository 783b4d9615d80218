"""A recording: written as an OpenSim motion file, read again with its events found, and its cycles."""

import tempfile
from pathlib import Path

import numpy as np

import exo_pin
from exo_pin.kinematics import spatiotemporal, with_events

robot = exo_pin.load_robot()
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "walk.mot"
    exo_pin.save_gait(exo_pin.normative_gait("slow", leg_length=robot.body.leg_length).repeated(4), path)
    walk = exo_pin.load_gait(path)

walk = with_events(robot, walk)
strikes = [event.time for event in walk.events if event.kind == "heel_strike" and event.side == "left"]
print(f"{len(walk.time)} samples, {walk.time[-1]:.2f} s; left heel strikes at {np.round(strikes, 2)} s")
for name, number in spatiotemporal(robot, walk).items():
    if name in ("cadence", "speed", "stride_length", "left_stance"):
        print(f"{name}: {number.mean:.2f} {number.unit} (n = {number.n})")
