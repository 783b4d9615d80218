"""The walk of the command line with the verdict on it and a device's answer, each found once a command."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from exo_pin.cli import device_options, options, torque_options

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.dynamics import Dynamics
    from exo_pin.feasible import DeviceWalk
    from exo_pin.gait import Gait, Plausibility, Torques
    from exo_pin.robot import Robot


@dataclass(frozen=True, eq=False)
class AnsweredWalk:
    """The walk of the command line, the verdict on it, and the device's answer to it.

    Attributes:
        robot: The exoskeleton on the person's body.
        gait: The walk, with its events or those of its kinematics.
        events_note: Why there are no events; empty where there are.
        plausibility: The verdict on the walk as it was read.
        torques: Of the walk, if known.
        dynamics: Inverse dynamics of the walk, if its own torques are asked for.
        answer: The device's answer.
    """

    robot: Robot
    gait: Gait
    events_note: str
    plausibility: Plausibility
    torques: Torques | None
    dynamics: Dynamics | None
    answer: DeviceWalk

    @property
    def keeps_motion(self) -> bool:
        """Whether the device moves as the person does, so that its motion is found from the feet alone."""
        return not self.answer.device.locked and self.answer.conditions.pelvis == "recorded"

    @cached_property
    def shown_torques(self) -> Torques | None:
        """The torques, unless the walk that is shown has other times; then a note, and None."""
        return torque_options.of_shown(self.torques, self.gait, self.answer.gait)


def answered(args: argparse.Namespace, body: Body, gait: Gait) -> AnsweredWalk:
    """The device's answer to the walk of the command line.

    Args:
        args: The command line, with the arguments of `shown_walk.add`.
        body: Who walks.
        gait: The walk as read.
    """
    from exo_pin.robot import load_robot

    own = args.torques == torque_options.OWN
    dynamics = torque_options.computed(args, body, gait) if own else None
    torques = dynamics.to_torques() if dynamics else torque_options.given(args, body, gait)
    robot = load_robot(body, hip_order=args.hip_order)
    judged = options.judged(args, robot, gait)
    answer = device_options.answer(args, body, judged.gait, hip_order=args.hip_order)
    return AnsweredWalk(robot, judged.gait, judged.events_note, judged.verdict, torques, dynamics, answer)
