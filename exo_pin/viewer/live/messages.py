"""What the live page says, read with distrust: a well-formed message becomes a value, all else None."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from exo_pin.viewer.scenes.scene import Facts

Said = Mapping[str, Any]

FAR = 5.0
"""A foot's target is at most this far from the root link along each axis [m]; beyond it is no foot's."""

POSE = 7
"""Numbers of a pose: x y z [m], quaternion x y z w."""

LARGEST_ID = 2**31


@dataclass(frozen=True)
class Wish:
    """Where a page wants the feet.

    Attributes:
        id: The page's own number of the question, to be returned with the answer.
        feet: Frame -> pose in the root link: x y z [m], unit quaternion x y z w.
        q: Joint values at present, in the order of the scene's first chain [rad, m].
    """

    id: int
    feet: Mapping[str, tuple[float, ...]]
    q: tuple[float, ...]


def read(message: str | bytes) -> Said | None:
    """The JSON object in a message, or None."""
    try:
        said = json.loads(message)
    except (ValueError, RecursionError):  # no JSON, or brackets without end
        return None
    return said if isinstance(said, dict) else None


def state(said: Said) -> dict[str, Any] | None:
    """The state of playback: `time` [s], `speed`, `view`, `playing`, `loop`."""
    if said.get("type") != "state":
        return None
    numbers = _numbers([said.get("time"), said.get("speed")], 2)
    if numbers is None or not 0.05 <= numbers[1] <= 10 or not isinstance(said.get("view"), str):
        return None
    flags = {name: said.get(name) is True for name in ("playing", "loop")}
    return {"time": numbers[0], "speed": numbers[1], "view": said["view"][:20], **flags}


def wish(said: Said, facts: Facts) -> Wish | None:
    """Where the page wants the feet of the scene with these facts."""
    feet, joints = {grip.link for grip in facts.grips}, len(facts.chains[0].joints)
    number, asked, q = said.get("id"), said.get("feet"), _numbers(said.get("q"), joints)
    if said.get("type") != "reach" or type(number) is not int or not 0 <= number < LARGEST_ID:
        return None
    if q is None or not isinstance(asked, dict) or not asked or not set(asked) <= feet:
        return None
    poses = {name: _pose(values) for name, values in asked.items()}
    known = {name: pose for name, pose in poses.items() if pose is not None}
    return Wish(number, known, q) if len(known) == len(poses) else None


def _pose(values: Any) -> tuple[float, ...] | None:
    numbers = _numbers(values, POSE)
    if numbers is None or max(map(abs, numbers[:3])) > FAR:
        return None
    length = math.hypot(*numbers[3:])
    if not 0.9 < length < 1.1:  # a unit quaternion but for rounding
        return None
    return (*numbers[:3], *(part / length for part in numbers[3:]))


def _numbers(values: Any, count: int) -> tuple[float, ...] | None:
    """So many finite numbers, or None; true and false are none."""
    if not isinstance(values, list) or len(values) != count:
        return None
    if not all(type(value) in (int, float) for value in values):
        return None
    try:
        numbers = tuple(float(value) for value in values)
    except OverflowError:  # JSON's integers have no end
        return None
    return numbers if all(map(math.isfinite, numbers)) else None
