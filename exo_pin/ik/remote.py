"""Targets on an accelerator: the closed form answers there; what it cannot answer is solved on the host."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any

import numpy as np

from exo_pin.arrays import beside, is_remote, to_host
from exo_pin.ik.leg.geometry import exact_geometry
from exo_pin.ik.result import Track
from exo_pin.ik.settings import Dls, Settings
from exo_pin.ik.targets import Points, Pose, Position, Target
from exo_pin.robot import Robot


def remote_array(targets: Mapping[str, Target]) -> Any | None:
    """The first of the targets' arrays that lives on an accelerator; None where all are on the host."""
    return next((array for array in map(_array, targets.values()) if is_remote(array)), None)


def stays_remote(robot: Robot, targets: Mapping[str, Target], settings: Settings) -> bool:
    """Whether every target goes through the closed form, so that whole arrays stay on the accelerator."""
    if isinstance(settings, Dls):
        return False
    full = [frame for frame, target in targets.items() if not isinstance(target, Position | Points)]
    legs = [robot.leg(frame) for frame in full]
    return len(full) == len(targets) and all(leg is not None and exact_geometry(leg) for leg in legs)


def on_host(targets: Mapping[str, Target]) -> dict[str, Target]:
    """The targets with their arrays copied to the host."""
    return {frame: _on_host(target) for frame, target in targets.items()}


def copied_back(answer: Track, like: Any) -> Track:
    """The answer of the host with its arrays where the targets came from."""
    values: dict[str, Any] = {field.name: getattr(answer, field.name) for field in fields(answer)}
    arrays = {name: beside(x, like) for name, x in values.items() if isinstance(x, np.ndarray)}
    return Track(**(values | arrays))


def _array(target: Target) -> Any:
    if isinstance(target, Pose):
        return target.T
    return target.p if isinstance(target, Position | Points) else target


def _on_host(target: Target) -> Target:
    array = to_host(_array(target))
    if isinstance(target, Pose):
        return replace(target, T=array)
    return replace(target, p=array) if isinstance(target, Position | Points) else array
