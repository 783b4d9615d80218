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

import contextlib
import difflib
import math
from collections.abc import Iterable, Iterator
from pathlib import Path

__all__ = [
    "ConvergenceError",
    "DescriptionError",
    "ExoPinError",
    "FormatError",
    "GaitError",
    "LimitError",
    "UnknownNameError",
    "hint",
    "known_name",
    "naming_file",
    "same_name",
]


LONGEST_MESSAGE = 300
"""Characters of an error's message on the command line."""

_LONGEST_LIST = 180  # characters of the known names in a message
_LONGEST_NAME = 60
_LONGEST_PATH = 120
_LONGEST_WHY = 290


def shortened(text: str, most: int = LONGEST_MESSAGE) -> str:
    """A text on one line of printable characters, cut to a length."""
    line = " ".join("".join(mark if mark.isprintable() else " " for mark in text).split())
    return line if len(line) <= most else f"{line[: most - 4]} ..."


def same_name(name: str, known: Iterable[str]) -> str | None:
    """The known name that differs in capitals, hyphens or spaces at most; None if there is not one alone."""
    names = tuple(known)
    if not isinstance(name, str):
        return None
    if name in names:
        return name
    found = [other for other in names if _spelled(other) == _spelled(name)]
    return found[0] if len(found) == 1 else None


def known_name(kind: str, name: str, known: Iterable[str]) -> str:
    """The known name that is meant, as `same_name` finds it.

    Args:
        kind: What is looked up, for the message.
        name: What was given.
        known: The names that exist.

    Raises:
        UnknownNameError: It is none of them.
    """
    names = tuple(known)
    found = same_name(name, names)
    if found is None:
        raise UnknownNameError(kind, name, names)
    return found


def hint(name: str, known: Iterable[str]) -> str:
    """What a name that does not exist was meant to be, as a sentence: the closest ones, or all."""
    names, name = tuple(known), name[:_LONGEST_NAME]
    spelled = {_spelled(other): other for other in reversed(names)}
    close = difflib.get_close_matches(_spelled(name), spelled, n=3)
    nearness = [difflib.SequenceMatcher(None, _spelled(name), other).ratio() for other in close]
    best = [spelled[other] for other, near in zip(close, nearness, strict=True) if near == max(nearness)]
    if best:
        return f"did you mean {shortened(' or '.join(map(repr, sorted(best))), _LONGEST_LIST)}?"
    return f"known: {shortened(', '.join(names), _LONGEST_LIST)}"


def _spelled(name: str) -> str:
    """A name without what people type differently: capitals, hyphens, spaces."""
    return "_".join(name.casefold().replace("-", " ").replace("_", " ").split())


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
        name = str(name)  # what is no text is no known name either
        self.kind, self.name, self.known = kind, name, tuple(known)
        super().__init__(f"unknown {kind} {shortened(name, _LONGEST_NAME)!r}; {hint(name, self.known)}")


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
        self.path, self.why, self.line = Path(path), _without_middle(why), line
        shown = str(path) if len(str(path)) <= _LONGEST_PATH else f"... {str(path)[-_LONGEST_PATH:]}"
        place = f"{shown}:{line}" if line is not None else shown
        super().__init__(f"{place}: {self.why}")


def _without_middle(why: str) -> str:
    """A reason that repeats a long text of the file: its beginning and its end, where the cure stands."""
    if len(why) <= _LONGEST_WHY:
        return why
    return f"{why[: _LONGEST_WHY // 3]} ... {why[-_LONGEST_WHY // 2 :]}"


@contextlib.contextmanager
def naming_file(path: str | Path, *, line: int | None = None) -> Iterator[None]:
    """Raise what is wrong with the data of a file as a `FormatError`, which names the file.

    Args:
        path: The file.
        line: Where the data stand, or None where the whole file is meant.

    Raises:
        FormatError: The block raises a `GaitError`.
    """
    try:
        yield
    except FormatError:
        raise
    except GaitError as error:
        raise FormatError(path, str(error), line=line) from error


class DamagedMeshError(ValueError):
    """A mesh cannot be used, with a reason; the reader of mesh files adds the file in a `FormatError`."""


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
