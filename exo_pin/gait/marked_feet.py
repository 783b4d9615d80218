"""Paths of the markers on the feet: where heels and toes were seen."""

from __future__ import annotations

from dataclasses import dataclass

from exo_pin.arrays import Array


@dataclass(frozen=True, eq=False)
class FootMarkers:
    """Paths of heel and toe markers in the world, z up.

    Attributes:
        time: `(n,)` [s].
        heels: `(n, 2, 3)` left and right [m]; NaN where it was not seen.
        toes: The same of the toes; NaN where the trial has none.
        heel_names: Names of the heel markers in the trial.
        toe_names: Names of the toe markers; empty where it has none on both feet.
    """

    time: Array
    heels: Array
    toes: Array
    heel_names: tuple[str, ...]
    toe_names: tuple[str, ...]
