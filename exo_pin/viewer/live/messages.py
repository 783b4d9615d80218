"""The live page's messages as records: a well-formed message becomes a value, any other None."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from exo_pin.viewer.scenes.scene import Facts

_FARTHEST_TARGET = 5.0
"""A foot's target is at most this far from the root link along each axis [m]."""

_POSE_LENGTH = 7
"""Numbers of a pose: x y z [m], quaternion x y z w."""

_LONGEST_MESSAGE = 16_384
"""Longer messages are not even parsed [characters]; a request of 100 joints has some 2000."""

_LARGEST_ID = 2**31


@dataclass(frozen=True)
class PlaybackState:
    """Where a page's playback is.

    Attributes:
        time: Of the walk [s].
        speed: 1 is as it happened.
        view: Name of the camera, or empty.
        playing: Whether it runs.
        loop: Whether it starts again at the end.
    """

    time: float
    speed: float
    view: str
    playing: bool
    loop: bool

    def to_json(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return asdict(self)


@dataclass(frozen=True)
class ReachRequest:
    """Where a page wants the feet: a question to inverse kinematics.

    Attributes:
        id: The page's own number of the request, to be returned with the answer.
        feet: Frame -> pose in the root link: x y z [m], unit quaternion x y z w.
        q: Joint values at present, in the order of the scene's first chain [rad, m].
    """

    id: int
    feet: Mapping[str, tuple[float, ...]]
    q: tuple[float, ...]


@dataclass(frozen=True)
class Reached:
    """The answer of inverse kinematics.

    Attributes:
        id: Number of the request.
        q: Joint values, in the order of the scene's first chain [rad, m].
        misses: Frame -> distance [m] and angle [rad] that remain, both 0 where the foot is at its target.
    """

    id: int
    q: tuple[float, ...]
    misses: Mapping[str, tuple[float, float]]

    def to_json(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {"type": "reached", "id": self.id, "q": self.q, "misses": dict(self.misses)}


def read(message: str | bytes) -> Mapping[str, Any] | None:
    """The JSON object in a message, or None."""
    if len(message) > _LONGEST_MESSAGE:
        return None
    try:
        content = json.loads(message)
    except (ValueError, RecursionError):  # no JSON, or brackets without end
        return None
    return content if isinstance(content, dict) else None


def playback_state(content: Mapping[str, Any]) -> PlaybackState | None:
    """The state of playback in a message of type `state`, or None."""
    if content.get("type") != "state":
        return None
    numbers, view = _numbers([content.get("time"), content.get("speed")], 2), content.get("view")
    if numbers is None or not 0.05 <= numbers[1] <= 10 or not isinstance(view, str):
        return None
    playing, loop = (content.get(name) is True for name in ("playing", "loop"))
    time, speed = numbers
    return PlaybackState(time, speed, view[:20], playing, loop)


def reach_request(content: Mapping[str, Any], facts: Facts) -> ReachRequest | None:
    """Where the page wants the feet of the scene with these facts, in a message of type `reach`, or None."""
    known, joints = {handle.link for handle in facts.handles}, len(facts.chains[0].joints)
    number, feet, q = content.get("id"), content.get("feet"), _numbers(content.get("q"), joints)
    if content.get("type") != "reach" or type(number) is not int or not 0 <= number < _LARGEST_ID:
        return None
    if q is None or not isinstance(feet, dict) or not feet or not set(feet) <= known:
        return None
    targets = {name: _pose(values) for name, values in feet.items()}
    valid = {name: pose for name, pose in targets.items() if pose is not None}
    return ReachRequest(number, valid, q) if len(valid) == len(targets) else None


def _pose(values: Any) -> tuple[float, ...] | None:
    numbers = _numbers(values, _POSE_LENGTH)
    if numbers is None or max(map(abs, numbers[:3])) > _FARTHEST_TARGET:
        return None
    length = math.hypot(*numbers[3:])
    if not 0.9 < length < 1.1:  # a unit quaternion but for rounding
        return None
    return (*numbers[:3], *(part / length for part in numbers[3:]))


def _numbers(values: Any, count: int) -> tuple[float, ...] | None:
    """So many finite numbers, or None; true and false are not numbers."""
    if not isinstance(values, list) or len(values) != count:
        return None
    if not all(type(value) in (int, float) for value in values):
        return None
    try:
        numbers = tuple(float(value) for value in values)
    except OverflowError:  # JSON's integers have no end
        return None
    return numbers if all(map(math.isfinite, numbers)) else None
