"""An OpenSim model as marker set: its markers where the model has them, its lengths as the person's."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.anthropometry import LENGTHS
from exo_pin.arrays import Array
from exo_pin.formats.opensim.osim_markers import model_markers
from exo_pin.markers.person_sizes import Pair, Sizes
from exo_pin.markers.spots import MarkerSet, Spot

_RIGID = 0.001
"""Spread of a model's markers [m]: they stay where the model has them."""


def model_set(path: str | Path) -> MarkerSet:
    """The marker set of a model that was scaled to the person.

    Raises:
        FormatError: The file cannot be read, or has no markers on the legs.
    """
    model = model_markers(path)
    sizes = _sizes([model.centres[side] for side in SIDES])
    spots = {}
    for marker in model.markers:
        x, y, z = (marker.place / sizes.length(marker.segment, marker.side)).tolist()
        spots[marker.name] = Spot(marker.segment, marker.side, (x, y, z), _RIGID)
    name = model.path.name
    return MarkerSet(name, f"the markers of {name}", name, "harrington", spots, sizes=sizes)


def _sizes(centres: list[Array]) -> Sizes:
    """Sizes by `(3, 3)` hip, knee and ankle of left and right [m]; the feet follow from the legs' length."""
    thigh, shank = ([c[k + 1] - c[k] for c in centres] for k in (0, 1))
    leg = float(np.mean([np.linalg.norm(c[1] - c[0]) + np.linalg.norm(c[2] - c[1]) for c in centres]))
    foot = LENGTHS["foot_length"] * leg / (LENGTHS["thigh"] + LENGTHS["shank"])
    return Sizes(
        hip_width=float(centres[0][0, 1] - centres[1][0, 1]),
        thigh=_pair(-thigh[0][2], -thigh[1][2]),
        shank=_pair(-shank[0][2], -shank[1][2]),
        foot=_pair(foot, foot),
        foot_measured=False,
        knee_aside=(_pair(*thigh[0][:2]), _pair(*thigh[1][:2])),
        ankle_aside=(_pair(*shank[0][:2]), _pair(*shank[1][:2])),
    )


def _pair(a: float, b: float) -> Pair:
    return float(a), float(b)
