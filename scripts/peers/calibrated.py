"""Calibrated legs: axes turned by 2 degrees and moved by 10 mm, so that no closed form holds."""

from __future__ import annotations

import re

import numpy as np

from exo_pin import ik
from exo_pin.robot import load_urdf
from peers import jobs

ANGLE, SHIFT = np.radians(2.0), 0.010  # [rad], [m] a careful assembly


def robot_of(robot, rng, *, angle=ANGLE, shift=SHIFT):
    """The robot with every leg joint's axis turned and its origin moved at random, as a URDF."""
    import xml.etree.ElementTree as ET

    root = ET.fromstring(re.sub(r"<\?xml.*?\?>", "", robot.urdf))
    for joint in root.findall("joint"):
        if joint.get("type") != "revolute":
            continue
        origin, axis = joint.find("origin"), joint.find("axis")
        xyz = np.array([float(x) for x in origin.get("xyz").split()]) + shift * _direction(rng)
        origin.set("xyz", " ".join(repr(float(x)) for x in xyz))
        old = np.array([float(x) for x in axis.get("xyz").split()])
        aside = np.cross(old, _direction(rng))
        new = np.cos(angle) * old + np.sin(angle) * aside / np.linalg.norm(aside)
        axis.set("xyz", " ".join(repr(float(x)) for x in new / np.linalg.norm(new)))
    return load_urdf(ET.tostring(root, encoding="unicode"), placement=robot.placement)


def _direction(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def section(robot, rng, n, budget, eaik):
    own = robot_of(robot, rng)
    lines = [
        "| calibrated legs, axes off by 2 deg and 10 mm | fr/s | x EAIK on the ideal leg | hit % |",
        "|---|---|---|---|",
    ]
    for job in (jobs.gait(own, n), jobs.cold(own, n, rng)):
        took, track = jobs.best_time(lambda j=job: ik.track(own, j.targets), budget)
        hit, _ = jobs.verdict(own, job, track.q)
        against = f"{n / took / eaik:.2f}" if eaik else "-"
        lines.append(f"| {job.name} | {n / took:,.0f} | {against} | {hit:.4f} |")
    return "\n".join(lines)
