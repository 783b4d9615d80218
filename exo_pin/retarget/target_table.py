"""The targets in one table: legs, hips, what is missed and how near the limits, as Markdown."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterable
from pathlib import PurePath

from exo_pin.anatomy import Body
from exo_pin.gait import Gait
from exo_pin.retarget.retargeted import Retargeted
from exo_pin.retarget.target_robots import TARGETS, Target
from exo_pin.retarget.transfer import retarget

HEAD = (
    "robot",
    "leg joints",
    "hip, from the pelvis",
    "paths",
    "foot by foot: ankle, foot missed",
    "nearest to a limit",
    "joint by joint: ankle off",
    "looks",
    "licence of its files",
)


def markdown(gait: Gait, body: Body | None = None, targets: Iterable[Target] = TARGETS.values()) -> str:
    """A row for each robot in this walk.

    Raises:
        DescriptionError: example-robot-data does not have one of them.
    """
    rows = [HEAD, ("---",) * len(HEAD)]
    rows += [_row(retarget(gait, target, body)) for target in targets]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def looks(urdf: str) -> str:
    """What a URDF's visuals are, e.g. `"28 dae"`."""
    root = ET.fromstring(urdf)
    names = {str(mesh.get("filename")) for mesh in root.iterfind("link/visual/geometry/mesh")}
    kinds = Counter(PurePath(name).suffix.lower().removeprefix(".") for name in names)
    if root.find("link/visual") is None:
        return "capsules"
    return ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items())) or "primitives"


def _row(walk: Retargeted) -> tuple[str, ...]:
    facts, use = walk.facts(), walk.limit_use()
    feet, joints = facts["foot_by_foot"], facts["joint_by_joint"]
    tightest = max(use, key=lambda name: round(use[name]["share"], 3))
    missed = f"{_small(feet['position_error_mm_max'], 'mm')}, {_small(feet['rotation_error_deg_max'], 'deg')}"
    return (
        f"`{walk.target.name}` {walk.target.title}",
        str(facts["joints_per_leg"]),
        facts["hip_order"].replace("-", ", "),
        f"{sum(walk.scale) / 2:.2f}",
        missed,
        f"`{tightest}` {100 * use[tightest]['share']:.0f} %",
        f"{joints['position_error_mm_max']:.0f} mm",
        looks(walk.robot.urdf),
        walk.target.licence,
    )


def _small(value: float, unit: str) -> str:
    return f"{value:.1f} {unit}" if value >= 0.05 else f"< 0.05 {unit}"
