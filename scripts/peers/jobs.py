"""Jobs of the benchmark: targets, referee and stopwatch."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from exo_pin import dh
from exo_pin.gait import normative_gait
from exo_pin.kinematics import poses

FEET = ("left_foot", "right_foot")


@dataclass(frozen=True, eq=False)
class Job:
    """Targets (n, 4, 4) of both feet, the angles behind them, and what counts as a hit."""

    name: str
    q: np.ndarray
    left: np.ndarray
    right: np.ndarray
    position: float
    rotation: float
    cold: bool

    @property
    def targets(self):
        return {"left_foot": self.left, "right_foot": self.right}


def feet(robot, q):
    """Both feet by the referee: the paper's recursion where there is a body, else Pinocchio."""
    if robot.body is None:
        return poses(robot, q, FEET)
    links = dh.recursion(robot.body, q, hip_order=robot.hip_order)
    return np.stack([robot.placement @ links[foot] for foot in FEET], axis=1)


def gait(robot, n):
    """A normative walk at 100 Hz on a held pelvis."""
    walk = normative_gait("free", leg_length=0.93)
    cycle = walk.resampled(round(walk.duration * 100))
    q = np.clip(robot.from_gait(cycle.repeated(n // len(cycle.q) + 1))[:n], robot.lower, robot.upper)
    return _job("gait", robot, q, 1e-6, 1e-6, cold=False)


def cold(robot, n, rng):
    """Uniform joint angles."""
    q = robot.lower + (robot.upper - robot.lower) * rng.random((n, 12))
    return _job("cold", robot, q, 1e-5, 1e-3, cold=True)


def hard(robot, n, rng):
    """Two thirds of the joints exactly on a limit, a third of the knees exactly straight."""
    q = robot.lower + (robot.upper - robot.lower) * rng.random((n, 12))
    end = rng.random((n, 12))
    q = np.where(end < 1 / 3, robot.lower, np.where(end < 2 / 3, robot.upper, q))
    for side in ("left", "right"):
        knee = robot.column(f"{side}_knee_flexion")
        q[rng.random(n) < 1 / 3, knee] = 0.0
    return _job("hard", robot, q, 1e-5, 1e-3, cold=True)


def _job(name, robot, q, position, rotation, *, cold):
    T = feet(robot, q)
    left, right = (np.ascontiguousarray(T[:, k]) for k in range(2))
    return Job(name, q, left, right, position, rotation, cold)


def part(job, n):
    """The first n frames of a job."""
    return Job(job.name, job.q[:n], job.left[:n], job.right[:n], job.position, job.rotation, job.cold)


def verdict(robot, job, q):
    """Share of the answers (n, 12) that meet both feet within the limits, and the worst position error."""
    T = feet(robot, np.nan_to_num(q))
    n = len(q)
    wanted = np.stack([job.left[:n], job.right[:n]], axis=1)
    apart = np.linalg.norm(T[..., :3, 3] - wanted[..., :3, 3], axis=-1)
    chord = np.linalg.norm(T[..., :3, :3] - wanted[..., :3, :3], axis=(-2, -1))
    turned = 2 * np.arcsin(np.minimum(chord / np.sqrt(8), 1.0))
    inside = ((q >= robot.lower - 1e-6) & (q <= robot.upper + 1e-6)).all(axis=1)
    hit = (apart <= job.position).all(axis=1) & (turned <= job.rotation).all(axis=1) & inside
    return 100 * hit.mean(), apart.max()


def best_time(function, budget, clock=time.perf_counter):
    """The shortest of several runs [s], and what the function returned: the machine has other work, too."""
    shortest, spent, answer = np.inf, 0.0, None
    while spent < budget or answer is None:
        start = clock()
        answer = function()
        took = clock() - start
        shortest, spent = min(shortest, took), spent + took
    return shortest, answer


def loop(single, job, seed, budget):
    """One call per frame: answers and times of as many frames as fit into the budget [s]."""
    answers, times, spent, q = [], [], 0.0, seed
    for left, right in zip(job.left, job.right, strict=True):
        start = time.perf_counter()
        q = single(left, right, seed if job.cold or not np.isfinite(q).all() else q)
        times.append(time.perf_counter() - start)
        answers.append(np.array(q))
        spent += times[-1]
        if spent > budget:
            break
    return np.array(answers), np.array(times)
