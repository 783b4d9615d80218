"""Mean cycles of Vicon Clinical Manager and its successors (.gcd): angles in per cent of a gait cycle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES, joint
from exo_pin.anatomy.names import EventKind, Movement, Side
from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.files import read_lines
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.tables.metadata import Metadata, to_gait
from exo_pin.formats.tables.numeric_table import refuse_length
from exo_pin.formats.trial_file import TrialFile
from exo_pin.gait import Event, Gait
from exo_pin.safe import plain_numbers

_CURVES: Mapping[Movement, str] = MappingProxyType(
    {
        "hip_flexion": "HipFlexExt",
        "hip_adduction": "HipAbAdduct",
        "hip_rotation": "HipRotation",
        "knee_flexion": "KneeFlexExt",
        "ankle_dorsiflexion": "DorsiPlanFlex",
    }
)
"""Movement -> its curve, without `Left` or `Right`. They are Plug-in Gait's LHipAngles X, Y, Z, LKneeAngles X
and LAnkleAngles X under other names, with the same signs, which are this package's (as the Shriners Gait
Model writes them); ankle Y, inversion, is not in the format."""

_FEWEST, _MOST = 11, 10_001
"""Points of a cycle; 51 (every 2 %) is usual."""

_LONGEST = 20.0
"""Of a stride [s]."""

_EVEN = 0.1
"""Largest difference of the two sides' stride times, in parts, in one mean cycle."""


@dataclass(frozen=True, eq=False)
class GaitCycleFile(TrialFile):
    """A .gcd file.

    Attributes:
        variables: Name -> `(k,)` numbers: one, or a curve from 0 to 100 % of the side's own cycle.
    """

    variables: Mapping[str, Array]

    def gait(self, options: ReadOptions) -> Gait:
        """One cycle that repeats, timed by the file's own stride time, cadence or speed.

        The right foot's cycle begins at its strike in the left one's. A small step from the last point to the
        first is spread over the cycle.

        Raises:
            FormatError: A curve misses, the curves differ in size, or nothing states the time.
        """
        why = "its curves have names and signs of their own, in degrees"
        options.refuse(self.path, "preset", "mapping", "units", why=why)
        self._refuse_one_side()
        curves = {joint(side, m): self._curve(side, m) for side in SIDES for m in _CURVES}
        sizes = {len(values) for values in curves.values()}
        if len(sizes) > 1:
            raise FormatError(
                self.path, f"its curves have {min(sizes)} to {max(sizes)} points; expected as many each"
            )
        period, how = self._period()
        phase, remarks = self._phase()
        n = sizes.pop() - 1
        closed = {
            name: values - np.linspace(0, values[-1] - values[0], n + 1) for name, values in curves.items()
        }
        step = max(abs(float(values[-1] - values[0])) for values in curves.values())
        if step > 0.5:
            remarks.append(f"the cycle's end is up to {step:.1f} deg off its start: spread over the cycle")
        remarks.append("the format has no ankle inversion: held at 0")
        q = np.zeros((n, len(JOINTS)))
        for name, values in closed.items():
            shift = phase if name.startswith("right") else 0.0
            q[:, JOINTS.index(name)] = np.radians(_shifted(values, shift))
        events = self._events(period, phase)
        source = f"{self.path.name}: mean cycle of {n + 1} points, {period:.3g} s {how}"
        metadata = Metadata(events, periodic=True, source=source, remarks=tuple(remarks))
        return to_gait(self.path, period * np.arange(n) / n, q, None, metadata)

    def _refuse_one_side(self) -> None:
        """The other leg of a person is not this one's mirror image, so nothing stands in for it."""
        held = [
            side
            for side in SIDES
            if any(f"{side.title()}{name}" in self.variables for name in _CURVES.values())
        ]
        if len(held) == 1:
            other = "left" if held == ["right"] else "right"
            why = f"holds the {held[0]} side alone, and a walk needs both legs"
            wanted = f"expected the curves of the {other} side too, in the same file"
            raise FormatError(self.path, f"{why}; {wanted}, or the recorded trial")

    def _curve(self, side: Side, movement: Movement) -> Array:
        """`(k,)` [deg]."""
        name = f"{side.title()}{_CURVES[movement]}"
        values = self.variables.get(name, np.zeros(0))
        if not _FEWEST <= len(values) <= _MOST:
            held = f"{len(values)} points" if len(values) else "not there"
            expected = f"expected !{name} with {_FEWEST} to {_MOST} points, left and right"
            raise FormatError(self.path, f"{name} is {held}; {expected}")
        if np.abs(values).max() > 180:
            raise FormatError(self.path, f"{name} is {np.abs(values).max():g}: more than half a turn")
        return values

    def _number(self, name: str) -> float | None:
        values = self.variables.get(name, np.zeros(0))
        return float(values[0]) if len(values) == 1 else None

    def _period(self) -> tuple[float, str]:
        """Stride time [s] and where it comes from."""
        for kind in ("stride time", "cadence", "stride length and speed"):
            found = [t for side in SIDES if (t := self._stride_time(side, kind)) and 0 < t <= _LONGEST]
            if found and max(found) <= (1 + _EVEN) * min(found):
                return float(np.mean(found)), f"by its {kind}"
        why = "a mean cycle in per cent; no StrideTime, Cadence or StrideLength with Speed says how long"
        raise FormatError(self.path, f"{why}; give the recorded trial")

    def _stride_time(self, side: Side, kind: str) -> float | None:
        """Of one side [s], by its time, its cadence [steps/min] or length and speed in units of one kind."""
        side_name = side.title()
        if kind == "stride time":
            return self._number(f"{side_name}StrideTime")
        if kind == "cadence":
            cadence = self._number(f"{side_name}Cadence_StepsPerMin") or self._number(f"{side_name}Cadence")
            return 120 / cadence if cadence and 20 <= cadence <= 300 else None
        length, speed = (self._number(f"{side_name}{name}") for name in ("StrideLength", "Speed"))
        return length / speed if length and speed else None

    def _phase(self) -> tuple[float, list[str]]:
        """When the right foot strikes in the left foot's cycle (0 to 1), and what had to be assumed."""
        left, right = (self._number(f"{side.title()}OppositeFootContact") for side in SIDES)
        if left is not None and 0 < left < 100:
            return left / 100, []
        if right is not None and 0 < right < 100:
            return 1 - right / 100, []
        return 0.5, ["no OppositeFootContact in the file: the right foot strikes at 50 % of the left cycle"]

    def _events(self, period: float, phase: float) -> tuple[Event, ...]:
        """Strikes at the start of each side's cycle, toe-offs where the file states them."""
        out = list[Event]()
        for side, start in zip(SIDES, (0.0, phase), strict=True):
            times: dict[EventKind, float] = {"heel_strike": start}
            off = self._number(f"{side.title()}FootOff")
            if off is not None and 0 < off < 100:
                times["toe_off"] = start + off / 100
            out += [Event(period * (t % 1.0), kind, side, "gait cycle data") for kind, t in times.items()]
        return tuple(out)


def open_gcd(path: Path) -> GaitCycleFile:
    """Read a .gcd file: lines `!Name` and below each its numbers, the mean first and perhaps its deviation.

    Raises:
        FormatError: With file, line and reason.
    """
    lines = read_lines(path)
    refuse_length(path, len(lines))
    if not any(line.startswith("!") for line in lines):
        raise FormatError(path, "no line '!Name'; expected gait cycle data (.gcd)")
    variables, rows, known = dict[str, list[float]](), list[float](), False
    for number, line in enumerate(lines, 1):
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        if words[0][0] in "!$":
            rows, known = [], words[0][0] == "!"
            name = words[0][1:]
            if known and name in variables:
                raise FormatError(path, f"{name[:40]} occurs twice", line=number)
            if known:
                variables[name] = rows
        elif known:
            rows.append(_value(path, words, number))
    return GaitCycleFile(path, {name: np.array(values) for name, values in variables.items()})


def _value(path: Path, words: Sequence[str], line: int) -> float:
    """The mean, the first number of a line."""
    try:
        value = plain_numbers.number(words[0])
    except ValueError:
        raise FormatError(path, f"{words[0][:40]!r} is no number", line=line) from None
    if not abs(value) < 1e9:
        raise FormatError(path, f"{value:g}: expected a finite number", line=line)
    return value


def _shifted(values: Array, phase: float) -> Array:
    """`(n,)` of a closed cycle of n + 1 points, delayed by a part of it: C2 periodic cubic spline."""
    from scipy.interpolate import CubicSpline  # 0.3 s, needed here only

    n = len(values) - 1
    spline = CubicSpline(np.linspace(0, 1, n + 1), np.append(values[:-1], values[0]), bc_type="periodic")
    return np.asarray(spline((np.arange(n) / n - phase) % 1.0))
