"""Cycles, spatiotemporal numbers and outliers of a walk as JSON and as text: what several commands print."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from exo_pin.gait import Cycles, Gait, Plausibility, StrideEstimate
    from exo_pin.kinematics import CurveOutlier, WalkNumbers

_OUTLIERS_PRINTED = 6  # JSON holds all


def numbers_to_json(gait: Gait, found: WalkNumbers) -> dict[str, Any]:
    """Cycles by side, spans left out and why, the spatiotemporal numbers; or why they are missing."""
    return {
        "manner": found.manner,
        "events_by": event_sources(gait),
        "cycles": found.cycles,
        "left_out": [
            {"side": x.side, "start_s": x.start, "end_s": x.end, "why": x.why} for x in found.left_out
        ],
        "spatiotemporal": {name: _number_to_json(name, found) for name in found.numbers},
        "sources": found.citations,
        "no_cycles": found.missing,
        "estimate": _estimate_to_json(found.estimate),
        "unknown": found.unknown,
    }


def _estimate_to_json(found: StrideEstimate | None) -> dict[str, Any] | None:
    """The stride that the numbers stand for, or null where a foot has a whole one."""
    if found is None:
        return None
    return {"side": found.side, "strike_s": found.strike, "stride_s": found.duration, "by": found.by}


def _number_to_json(name: str, found: WalkNumbers) -> dict[str, Any]:
    number, usual = found.numbers[name], found.usual.get(name)
    return {
        "mean": number.mean,
        "sd": None if math.isnan(number.sd) else number.sd,
        "n": number.n,
        "unit": number.unit,
        "measured_at": found.measured.get(name),
        "normal": found.verdicts.get(name),
        "usual": None if usual is None else usual._asdict(),
    }


def event_sources(gait: Gait) -> list[str]:
    """Where the events of a walk come from."""
    return sorted({event.source or "not stated" for event in gait.events})


def outliers_to_json(found: Sequence[CurveOutlier]) -> list[dict[str, Any]]:
    """Curve, time, deviation and unit of each."""
    return [{"curve": x.curve, "time_s": x.time, "off": x.off, "unit": x.unit} for x in found]


def count(cut: Cycles) -> str:
    """How many cycles of which foot, e.g. `3 cycles of the left foot`."""
    return f"{len(cut)} cycle{'s' * (len(cut) != 1)} of the {cut.side} foot"


def print_measured(found: WalkNumbers) -> None:
    """Where lengths, widths and speeds were measured, a line for each place."""
    for where in dict.fromkeys(found.measured.values()):
        names = ", ".join(name.replace("_", " ") for name, x in found.measured.items() if x == where)
        print(f"measured at the {where}: {names}")


def print_left_out(found: WalkNumbers) -> None:
    """Spans between heel strikes that are no strides, and why."""
    for x in found.left_out:
        print(f"left out: {x.side} {x.start:.2f} .. {x.end:.2f} s: {x.why}")


def manner_words(found: WalkNumbers) -> str:
    """That it is a run, and what is left out of it; empty for a walk."""
    if found.manner == "walk":
        return ""
    return "; ".join(filter(None, ("a run: both feet are in the air between contacts", found.unknown)))


def print_plausibility(found: Plausibility) -> None:
    """The verdict, and each reason against the walk on its own line."""
    print(found.word + ":" * bool(found.reasons))
    for reason in found.reasons:
        print(f"  {reason}")


def print_outliers(found: Sequence[CurveOutlier]) -> None:
    """One line for each of the largest."""
    ordered = sorted(found, key=lambda x: -abs(x.off))
    for x in ordered[:_OUTLIERS_PRINTED]:
        print(f"outlier: {x.curve} at {x.time:.3f} s is {x.off:+.1f} {x.unit} off its neighbours")
    if len(ordered) > _OUTLIERS_PRINTED:
        print(f"... and {len(ordered) - _OUTLIERS_PRINTED} outliers more (--json lists all)")
