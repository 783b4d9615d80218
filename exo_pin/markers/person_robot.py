"""The robot of a person: floating, with a person's joint ranges, its joints where the person's are."""

from __future__ import annotations

import dataclasses

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.human import EXTREME_RANGES
from exo_pin.markers.person_sizes import Sizes, body_of
from exo_pin.robot import Robot, load_robot


def person_robot(sizes: Sizes) -> Robot:
    """A robot of these sizes that floats, with a person's extreme joint ranges: no device limits a trial."""
    body = body_of(sizes, mass=None, sex="male")  # masses do not move a marker
    robot = load_robot(dataclasses.replace(body, limits=EXTREME_RANGES), base="floating")
    return resized(robot, sizes)


def resized(robot: Robot, sizes: Sizes) -> Robot:
    """The robot with other sizes: hips, knees and ankles are moved, masses stay behind.

    Building a robot anew takes 0.3 s, and calibration tries a dozen; it needs the places of the links only.
    """
    model = robot.model.copy()
    for k, side in enumerate(SIDES):
        outward = sizes.hip_width / 2 * (1 if side == "left" else -1)
        centres = {
            "hip_flexion": (0.0, outward, 0.0),
            "knee_flexion": (*sizes.knee_aside[k], -sizes.thigh[k]),
            "ankle_dorsiflexion": (*sizes.ankle_aside[k], -sizes.shank[k]),
        }
        for joint, centre in centres.items():
            at = model.jointPlacements[model.getJointId(f"{side}_{joint}")]
            at.translation = np.array(centre)
    return dataclasses.replace(robot, model=model, body=None)
