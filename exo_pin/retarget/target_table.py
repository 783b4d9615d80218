"""Table of all targets as Markdown: legs, hips, errors of the feet, use of the joint limits."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from pathlib import PurePath

from exo_pin.anatomy import Body
from exo_pin.gait import Gait
from exo_pin.retarget.retargeted import Retargeted
from exo_pin.retarget.target_robots import TARGETS, Target
from exo_pin.retarget.transfer import retarget
from exo_pin.robot import urdf_tree

_HEAD = (
    "robot",
    "leg joints",
    "hip, from the pelvis",
    "paths",
    "foot by foot: ankle, foot missed",
    "nearest to a limit",
    "largest speed / limit",
    "joint by joint: ankle off",
    "visuals",
    "licence of its files",
)


def markdown(gait: Gait, body: Body | None = None, targets: Iterable[Target] = TARGETS.values()) -> str:
    """A row for each robot in a walk.

    Args:
        gait: The walk.
        body: Whose walk it is; `Body.from_stature()` if left out.
        targets: The robots.

    Raises:
        DescriptionError: example-robot-data does not have one of them.
    """
    rows = [_HEAD, ("---",) * len(_HEAD)]
    rows += [_row(retarget(gait, target, body)) for target in targets]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def visuals(urdf: str) -> str:
    """Number and kinds of a URDF's visuals, e.g. `"28 dae"`."""
    root = urdf_tree.parsed(urdf)
    names = {str(mesh.get("filename")) for mesh in root.iterfind("link/visual/geometry/mesh")}
    kinds = Counter(PurePath(name).suffix.lower().removeprefix(".") for name in names)
    if root.find("link/visual") is None:
        return "capsules"
    return ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items())) or "primitives"


def _row(walk: Retargeted) -> tuple[str, ...]:
    shares = {name: round(use.used.use, 3) for name, use in walk.limit_use.items()}
    fastest, speed = max(
        ((name, round(use.speed.use, 3)) for name, use in walk.limit_use.items()), key=lambda pair: pair[1]
    )
    tightest = max(shares, key=lambda name: shares[name])
    position, rotation = 1e3 * walk.errors.largest_position, math.degrees(walk.errors.largest_rotation)
    return (
        f"`{walk.target.name}` {walk.target.title}",
        str(walk.biped.joints_per_leg),
        walk.biped.hip_order.replace("-", ", "),
        f"{sum(walk.scale) / 2:.2f}",
        f"{_small(position, 'mm')}, {_small(rotation, 'deg')}",
        f"`{tightest}` {100 * walk.limit_use[tightest].used.use:.0f} %",
        f"`{fastest}` {speed:.1f}" if speed else "-",
        f"{1e3 * walk.copied_errors.largest_position:.0f} mm",
        visuals(walk.robot.urdf),
        walk.target.licence,
    )


def _small(value: float, unit: str) -> str:
    return f"{value:.1f} {unit}" if value >= 0.05 else f"< 0.05 {unit}"
