"""The person of a trial: by its markers, else by joint centres, the file's header and the model."""

from __future__ import annotations

from pathlib import Path

from exo_pin.anatomy import SIDES, Body
from exo_pin.anatomy.person import Measure, Person
from exo_pin.anatomy.sized_body import SizedBody, sized_body
from exo_pin.formats import TrialFile
from exo_pin.formats.opensim.osim_person import model_person
from exo_pin.markers.reconstruction import Reconstruction

_FITTED = tuple(f"{side}_{name}" for side in SIDES for name in ("thigh", "shank"))
"""Sizes that are always fitted to markers."""

_SCALED = ("hip_width", *(f"{side}_{name}" for side in SIDES for name in ("foot_length", "ankle_height")))
"""Sizes that markers give where they are there."""


def trial_person(file: TrialFile, walk: Reconstruction | None, model: Path | None = None) -> Person:
    """What is known of the person of a trial.

    Angles that were solved from markers belong to the lengths that the markers gave, so these win.

    Args:
        file: The trial.
        walk: The walk of its markers; None where it has joint angles of its own.
        model: The OpenSim model (.osim) that the trial belongs to.

    Raises:
        FormatError: The model cannot be read.
    """
    stated = file.person(model)
    if walk is None:
        return stated
    if model is not None:  # the walk was solved on the model's lengths
        return model_person(model).over(marker_person(walk)).over(stated)
    return marker_person(walk).over(stated)


def trial_body(file: TrialFile, walk: Reconstruction | None) -> SizedBody:
    """The body of a trial's person; arguments as of `trial_person`."""
    return sized_body(trial_person(file, walk))


def marker_person(walk: Reconstruction) -> Person:
    """The sizes that markers gave: legs, and what does not simply follow from the scaled body's stature."""
    body = walk.body
    average = Body.from_stature(body.stature, mass=body.mass, sex=body.sex)
    scaled = [name for name in _SCALED if getattr(body, name) != getattr(average, name)]
    said = f"fitted to the markers ({walk.marker_set})"
    return Person({name: Measure(getattr(body, name), "markers", said) for name in (*_FITTED, *scaled)})
