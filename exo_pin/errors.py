"""Errors: one tree, the facts as attributes, the next step in the message.

    ExoPinError
    ├── DescriptionError      a body, xacro or URDF cannot be built or read
    │   └── UnknownNameError  joint, frame, device ...: .kind .name .known
    ├── GaitError             the data of a walk are unusable
    │   └── FormatError       a file cannot be read: .path .line .why
    ├── LimitError            .joint .value .lower .upper
    └── ConvergenceError      .solution = the best try

Only the command line turns them into one line and an exit code.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable
from pathlib import Path

__all__ = [
    "ConvergenceError",
    "DescriptionError",
    "ExoPinError",
    "FormatError",
    "GaitError",
    "LimitError",
    "UnknownNameError",
]


_SHOWN = 45  # names in a message: all sizes of a body fit


class ExoPinError(Exception):
    """The root of every error that this package raises on purpose."""


class DescriptionError(ExoPinError):
    """A body, xacro or URDF description cannot be built or read."""


class UnknownNameError(DescriptionError):
    """A name that does not exist.

    Attributes:
        kind: What was looked up, e.g. `"joint"`.
        name: The name that was given.
        known: The names that exist.
    """

    def __init__(self, kind: str, name: str, known: Iterable[str]) -> None:
        self.kind, self.name, self.known = kind, name, tuple(known)
        close = difflib.get_close_matches(name, self.known, n=1)
        some = ", ".join(self.known[:_SHOWN]) + (" ..." if len(self.known) > _SHOWN else "")
        hint = f"did you mean {close[0]!r}?" if close else f"known: {some}"
        super().__init__(f"unknown {kind} {name!r}; {hint}")


class GaitError(ExoPinError):
    """The data of a walk are unusable: shape, time order, NaN, implausible angles."""


class FormatError(GaitError):
    """A file cannot be read or written.

    Attributes:
        path: The file.
        line: Line number counted from 1, or None where the whole file is meant.
        why: The reason, with what would be accepted.
    """

    def __init__(self, path: str | Path, why: str, *, line: int | None = None) -> None:
        self.path, self.why, self.line = Path(path), why, line
        place = f"{path}:{line}" if line is not None else f"{path}"
        super().__init__(f"{place}: {why}")


class LimitError(ExoPinError):
    """A joint value lies outside its limits.

    Attributes:
        joint: Name of the joint.
        value: The value [rad].
        lower: Lower limit [rad].
        upper: Upper limit [rad].
    """

    def __init__(self, joint: str, value: float, lower: float, upper: float, *, where: str = "") -> None:
        self.joint, self.value, self.lower, self.upper = joint, value, lower, upper
        degrees = [math.degrees(x) for x in (value, lower, upper)]
        super().__init__(
            "{}{} = {:.2f} deg is outside its limits {:.1f} .. {:.1f} deg".format(joint, where, *degrees)
        )


class ConvergenceError(ExoPinError):
    """Inverse kinematics did not reach its target.

    Attributes:
        solution: The best try (`exo_pin.ik.Solution`).
    """

    def __init__(self, message: str, solution: object) -> None:
        self.solution = solution
        super().__init__(message)
