"""Plots of the benchmark: noisy feet with and without damping, cost per frame over the number of frames."""

from __future__ import annotations

import numpy as np

from exo_pin import ik
from exo_pin.gait import normative_gait
from exo_pin.kinematics import poses
from peers import jobs

BLUE, RED, GREY = "#2b75b3", "#d13d4a", "#6b7280"


def noise(robot, rng, folder):
    """The left knee of a walk whose feet carry 3 mm of noise."""
    import matplotlib.pyplot as plt

    walk = normative_gait("free", leg_length=robot.body.leg_length)
    n = round(100 * walk.duration)
    q = np.clip(robot.from_gait(walk.resampled(n)), robot.lower, robot.upper)
    T = poses(robot, q)
    T[..., :3, 3] += 0.003 * rng.normal(size=T[..., :3, 3].shape)
    targets = {foot: T[:, k] for k, foot in enumerate(jobs.FEET)}
    knee = robot.column("left_knee_flexion")
    figure, axes = plt.subplots(figsize=(7, 3.2))
    percent = 100 * np.arange(n) / n
    for label, settings, colour in (
        ("exact: follows the noise", ik.Auto(), RED),
        ("Dls(damping=0.05)", ik.Dls(damping=0.05), BLUE),
    ):
        track = ik.track(robot, targets, settings=settings)
        axes.plot(percent, np.degrees(track.q[:, knee]), color=colour, linewidth=1.4, label=label)
    axes.plot(percent, np.degrees(q[:, knee]), color=GREY, linewidth=1.0, linestyle="--", label="the walk")
    axes.set(xlabel="gait cycle [%]", ylabel="left knee flexion [deg]", xlim=(0, 100))
    _finish(figure, axes, folder / "ik_noise.svg")


def flat(cost, folder):
    """Cost per frame: {frames in one call: us per frame}."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(7, 2.6))
    axes.plot(list(cost), list(cost.values()), color=BLUE, marker="o", label="ik.track, verified")
    axes.set(xscale="log", xlabel="frames in one call", ylabel="CPU us per frame", ylim=(0, None))
    _finish(figure, axes, folder / "ik_flat.svg")


def _finish(figure, axes, path):
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False)
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
