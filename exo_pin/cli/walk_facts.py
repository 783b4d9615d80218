"""Cycles and spatiotemporal numbers of a walk beside those of healthy adults, for `info` and `cycles`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from exo_pin.anatomy import SIDES
from exo_pin.errors import GaitError

if TYPE_CHECKING:
    from exo_pin.gait import Gait, Norm, Number, Stride
    from exo_pin.robot import Robot


@dataclass(frozen=True, eq=False)
class WalkFacts:
    """What a walk's heel strikes and feet give.

    Attributes:
        events_by: Sources of its events.
        spans: Between two heel strikes of a foot, also those that are no strides.
        numbers: Spatiotemporal numbers by name.
        usual: Their ranges in healthy adults, where one is published.
        verdicts: Name -> `within`, `below` or `above` that range.
        citations: Sources of the ranges, in full.
        no_cycles: Why there are no numbers, or "".
    """

    events_by: tuple[str, ...]
    spans: tuple[Stride, ...] = ()
    numbers: Mapping[str, Number] = field(default_factory=dict)
    usual: Mapping[str, Norm] = field(default_factory=dict)
    verdicts: Mapping[str, str] = field(default_factory=dict)
    citations: Mapping[str, str] = field(default_factory=dict)
    no_cycles: str = ""

    @property
    def cycles(self) -> dict[str, int]:
        """Side -> strides; empty where there are no numbers."""
        if self.no_cycles:
            return {}
        return {side: sum(span.side == side and not span.why for span in self.spans) for side in SIDES}

    @property
    def left_out(self) -> tuple[Stride, ...]:
        """Spans that are no strides."""
        return tuple(span for span in self.spans if span.why)

    def print_left_out(self) -> None:
        """One line for each span that is no stride, with the reason."""
        for span in self.left_out:
            print(f"left out: {span.side} {span.start:.2f} .. {span.end:.2f} s: {span.why}")

    def to_json(self) -> dict[str, Any]:
        """As `info --json` and `cycles --json` print them."""
        return {
            "events_by": list(self.events_by),
            "cycles": self.cycles,
            "left_out": [
                {"side": x.side, "start_s": x.start, "end_s": x.end, "why": x.why} for x in self.left_out
            ],
            "spatiotemporal": {
                name: {
                    "mean": x.mean,
                    "sd": None if x.sd != x.sd else x.sd,
                    "n": x.n,
                    "unit": x.unit,
                    "normal": self.verdicts.get(name),
                    "usual": self.usual[name]._asdict() if name in self.usual else None,
                }
                for name, x in self.numbers.items()
            },
            "sources": dict(self.citations),
            "no_cycles": self.no_cycles,
        }


def walk_facts(robot: Robot, gait: Gait) -> WalkFacts:
    """The cycles and numbers of a walk, or why there are none."""
    from exo_pin.gait import against_normal, normal, strides
    from exo_pin.gait.reference_values import CITATIONS
    from exo_pin.kinematics import spatiotemporal

    events_by = tuple(sorted({event.source or "not stated" for event in gait.events}))
    try:
        numbers = spatiotemporal(robot, gait)
    except GaitError as error:
        return WalkFacts(events_by, no_cycles=str(error))
    legs = robot.body.leg_length if robot.body else float("nan")
    usual = normal(numbers, leg_length=legs)
    cited = {norm.source for norm in usual.values()}
    return WalkFacts(
        events_by,
        tuple(span for side in SIDES for span in strides(gait, side)),
        numbers,
        usual,
        against_normal(numbers, leg_length=legs),
        {key: citation for key, citation in CITATIONS.items() if key in cited},
    )
