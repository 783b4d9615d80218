"""The worst case of sizing as a map: peak torque of each joint by speed and body-weight support."""

from __future__ import annotations

from collections.abc import Sequence

from exo_pin.report.draw.drawing import Drawing
from exo_pin.report.draw.heat import heat
from exo_pin.sizing import WorstCase

_WIDTH = 1040.0


def worst_case_map(found: Sequence[WorstCase], device: str) -> Drawing:
    """Peak torques in percent of the record's effort, the largest over the bodies.

    Args:
        found: Of `sizing.worst_cases`.
        device: What the device is called.
    """
    cases = list(dict.fromkeys((case.speed, case.support) for case, _ in found[0].loads))
    columns = [f"{speed.replace('_', ' ')} {100 * support:.0f}%" for speed, support in cases]
    rows = {
        worst.movement.replace("_", " "): [_largest(worst, speed, support) for speed, support in cases]
        for worst in found
    }
    title = f"{device}: peak torque, % of its effort, largest over bodies; speed and weight carried"
    return heat("worst_case", title, columns, rows, width=_WIDTH, digits=0, top=150.0)


def _largest(worst: WorstCase, speed: str, support: float) -> float:
    torques = [
        load.peak_torque for case, load in worst.loads if (case.speed, case.support) == (speed, support)
    ]
    return 100.0 * max(torques) / worst.effort
