"""`Run`: one simulated walk with its verdict and numbers."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cached_property
from math import isfinite
from typing import Any

from exo_pin.anatomy import FEET
from exo_pin.anatomy.names import Side
from exo_pin.html_summary import table
from exo_pin.simulation.energy import balance
from exo_pin.simulation.free_walk import FreeNumbers, free_numbers
from exo_pin.simulation.side_numbers import SideNumbers, by_side
from exo_pin.simulation.simulated_walk import SimulatedWalk
from exo_pin.simulation.walk_verdict import Numbers, Verdict, numbers, verdict
from exo_pin.simulation.witness import witness

_MUST_FALL = 5.0
"""Time with the ZMP outside the soles from which a fall is put down to the walk itself [%]."""


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Run(SimulatedWalk):
    """One simulated walk, N steps; fields as of `SimulatedWalk`."""

    def __repr__(self) -> str:
        return f"<Run {self.time[-1]:.2f} s, controller {self.controller}, {self.verdict.word}>"

    @cached_property
    def numbers(self) -> Numbers:
        """Tracking, contact, forces and torques on the cycles that count."""
        return numbers(self)

    @cached_property
    def by_side(self) -> dict[Side, SideNumbers]:
        """Tracking and effort of each leg."""
        return by_side(self)

    @cached_property
    def verdict(self) -> Verdict:
        """Whether it walks, stumbles, falls or diverges, and why."""
        found = verdict(self, self.numbers)
        if found.word == "falls" and self.support.free:
            return Verdict(found.word, found.why + _unplanned(self.free_numbers))
        return found

    @cached_property
    def energy_balance_percent(self) -> float:
        """Energy that the balance of the run misses, in percent of what the joints' torques turn over."""
        return balance(self.record, self.timestep)

    @cached_property
    def witness(self) -> float:
        """Difference of MuJoCo's accelerations from Pinocchio's of the same forces, relative."""
        return witness(self.robot, self.record, self.floor, self.timestep)

    def _repr_html_(self) -> str:
        """Verdict and main numbers, for notebooks."""
        return table(
            {
                "verdict": self.verdict.word,
                "why": self.verdict.why,
                "controller": self.controller,
                "patient": "nobody" if self.patient is None else self.patient.name,
                "tracking rms [deg]": self.numbers.tracking_rms_deg,
                "vertical force, mean [weight]": self.numbers.vertical_force_mean_bw,
                "motor share": self.numbers.motor_share,
            }
        )

    @cached_property
    def free_numbers(self) -> FreeNumbers:
        """Path, slip and ZMP of a run whose pelvis nothing holds."""
        return free_numbers(self)

    @property
    def stands(self) -> bool:
        """Whether it is upright to the end."""
        return self.verdict.word not in ("falls", "diverges")

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON; null where a run has no such number."""
        return {name: _with_nulls(value) for name, value in self._facts().items()}

    def _facts(self) -> dict[str, Any]:
        return {
            "verdict": self.verdict.word,
            "why": self.verdict.why,
            "time_end_s": float(self.time[-1]),
            **self.numbers.facts(),
            **self._free_facts(),
            "by_side": {side: numbers.facts() for side, numbers in self.by_side.items()},
            "energy_balance_percent": self.energy_balance_percent,
            "witness": self.witness,
            "real_time_factor": float(self.time[-1] / self.cpu_time) if self.cpu_time else None,
            "controller": self.controller,
            "patient": None if self.patient is None else self.patient.name,
            "support": self.support.name,
            "body_weight_support": self.body_weight_support,
            "body_weight_support_N": self.body_weight_support * self.weight,
            "feet": list(FEET),
        }

    def _free_facts(self) -> dict[str, Any]:
        """What a run with a free pelvis has besides."""
        return {"stands": self.stands, **asdict(self.free_numbers)} if self.support.free else {}


def _unplanned(found: FreeNumbers) -> str:
    """Why a walk cannot but fall, where its ZMP is outside the soles."""
    if found.zmp_outside_percent < _MUST_FALL:
        return ""
    far = f", by up to {-found.zmp_margin_min_mm:.0f} mm" if isfinite(found.zmp_margin_min_mm) else ""
    return (
        f"; the walk's own ZMP is outside its soles in {found.zmp_outside_percent:.0f} % of the time{far}: "
        "no floor alone can carry it"
    )


def _with_nulls(value: Any) -> Any:
    """Plain values with None for numbers that are not finite, which JSON does not have."""
    if isinstance(value, dict):
        return {name: _with_nulls(entry) for name, entry in value.items()}
    return None if isinstance(value, float) and not isfinite(value) else value
