"""Line styles of series that are compared: colours for a screen, dashes for grey paper as well."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.report.draw.chart import Curve

_COLOURS = (
    "#2975c7",
    "#d9822b",
    "#2e8b57",
    "#b3377e",
    "#6a4fb3",
    "#8a6d3b",
    "#17909a",
    "#c23b3b",
    "#6b7480",
)
_DASHES = (None, "7 3", "2 3", "8 3 2 3")


class LineStyle(NamedTuple):
    """Colour and dash of a line."""

    colour: str
    dash: str | None


def line_styles(names: Iterable[str]) -> dict[str, LineStyle]:
    """A style for each name, the same for the same names in the same order."""
    return {
        name: LineStyle(_COLOURS[k % len(_COLOURS)], _DASHES[k % len(_DASHES)])
        for k, name in enumerate(names)
    }


def curves(
    x: Array, series: Mapping[str, Array], styles: Mapping[str, LineStyle], *, same: float
) -> tuple[Curve, ...]:
    """A curve for each series; coincident series make one curve, under all their names.

    Args:
        x: `(n,)` where the values are.
        series: `(n,)` values by name.
        styles: By name.
        same: Largest difference of series that count as one.
    """
    return tuple(
        Curve(x, series[names[0]], styles[names[0]].colour, " = ".join(names), styles[names[0]].dash)
        for names in coincident(series, same)
    )


def coincident(series: Mapping[str, Array], same: float) -> list[tuple[str, ...]]:
    """Names of series that differ by no more than `same`, together; NaN is equal to NaN."""
    groups: list[list[str]] = []
    for name, values in series.items():
        for group in groups:
            if np.allclose(series[group[0]], values, rtol=0, atol=same, equal_nan=True):
                group.append(name)
                break
        else:
            groups.append([name])
    return [tuple(group) for group in groups]
