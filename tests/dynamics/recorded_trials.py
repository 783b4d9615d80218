"""Two adults' recorded walks with force plates, and the torques that others found for them."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import JOINTS, Body
from exo_pin.arrays import Array
from exo_pin.formats import load_forces, load_gait
from exo_pin.formats.opensim.osim_person import model_person
from exo_pin.gait import Gait
from exo_pin.gait.trial import ForcePlate
from exo_pin.robot import Robot, load_robot


class Trial(NamedTuple):
    """A walk, its plates, and the robot on the body that its model was scaled to."""

    walk: Gait
    plates: tuple[ForcePlate, ...]
    robot: Robot


def trial(folder: Path, angles: str, model: str, forces: str) -> Trial:
    """A trial from its files."""
    known = {name: measure.value for name, measure in model_person(folder / model).sizes.items()}
    body = Body.from_stature(1.8, **known)
    walk = load_gait(folder / angles, model=folder / model)
    return Trial(walk, load_forces(folder / forces), load_robot(body))


def subject01(shared: Path) -> Trial:
    """An adult on a treadmill with two plates."""
    names = ("subject01_walk1_ik.mot", "subject01_simbody.osim", "subject01_walk1_grf.mot")
    return trial(shared / "opensim_subject01_walk", *names)


def lai_arnold(shared: Path) -> Trial:
    """An adult over ground, with two plates."""
    folder = shared.parent / "trials" / "lai_arnold_walk"
    return trial(folder, "walking1_ik.mot", "scaled.osim", "walking1_forces.mot")


def misfit(ours: Array, theirs: Array, joint: str) -> tuple[float, float]:
    """Root mean square difference as a part of the range of the others' torque, and correlation."""
    k = JOINTS.index(joint)
    known = np.isfinite(ours[:, k]) & np.isfinite(theirs[:, k])
    a, b = ours[known, k], theirs[known, k]
    return float(np.sqrt(np.mean((a - b) ** 2)) / np.ptp(b)), float(np.corrcoef(a, b)[0, 1])


def changed(plate: ForcePlate, **arrays: Array) -> ForcePlate:
    """A plate with other arrays."""
    return dataclasses.replace(plate, **arrays)
