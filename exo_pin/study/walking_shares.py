"""The share of simulated runs that walks, by condition, with its interval."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from exo_pin.arguments import count
from exo_pin.study.simulated_plan import MOST_RUNS
from exo_pin.study.simulated_table import CONDITIONS, SimulatedRow, condition

_QUANTILE = 1.959964
"""Of the normal distribution, for an interval of 95 %."""


@dataclass(frozen=True)
class Share:
    """How many runs of one condition walk.

    Attributes:
        conditions: Column of the table -> value.
        runs: How many there are.
        verdicts: How many have which verdict.
        share: That walks.
        low: Lower end of its interval, 95 % (Wilson 1927).
        high: Upper end.
        tracking_rms_deg: Mean over the runs.
    """

    conditions: dict[str, Any]
    runs: int
    verdicts: dict[str, int]
    share: float
    low: float
    high: float
    tracking_rms_deg: float


def walking_shares(rows: Iterable[SimulatedRow]) -> list[Share]:
    """The share of each condition that walks, in the order of the rows."""
    groups: dict[tuple[object, ...], list[SimulatedRow]] = {}
    for row in rows:
        groups.setdefault(condition(row), []).append(row)
    found = []
    for key, some in groups.items():
        verdicts = Counter(row.verdict for row in some)
        low, high = wilson_interval(verdicts["walks"], len(some))
        share = verdicts["walks"] / len(some)
        error = sum(row.tracking_rms_deg for row in some) / len(some)
        named = dict(zip(CONDITIONS, key, strict=True))
        found.append(Share(named, len(some), dict(verdicts), share, low, high, error))
    return found


def wilson_interval(hits: int, runs: int) -> tuple[float, float]:
    """The interval of 95 % of a share (Wilson 1927, J Am Stat Assoc 22:209).

    Unlike the usual one it has a width where all runs or none succeed.

    Args:
        hits: Runs that succeed.
        runs: All of them, at least 1.
    """
    count("runs", runs, 1, MOST_RUNS)
    count("hits", hits, 0, runs)
    z, p = _QUANTILE, hits / runs
    middle = p + z * z / (2 * runs)
    half = z * math.sqrt(p * (1 - p) / runs + z * z / (4 * runs * runs))
    scale = 1 + z * z / runs
    return max((middle - half) / scale, 0.0), min((middle + half) / scale, 1.0)
