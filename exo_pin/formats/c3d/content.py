"""The content of a C3D file as plain arrays: the record that every reader of the format returns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from exo_pin.arrays import Array
from exo_pin.formats.c3d.parameters import C3dParameters


@dataclass(frozen=True, eq=False)
class C3dPlate:
    """One force plate, in the units of the file.

    Attributes:
        force: `(m, 3)` ground reaction force.
        point: `(m, 3)` centre of pressure.
        moment: `(m, 3)` free moment.
        units: Names of the units of force, moment and length.
    """

    force: Array
    point: Array
    moment: Array
    units: tuple[str, str, str]


@dataclass(frozen=True, eq=False)
class C3dEvents:
    """The events of a C3D file.

    Attributes:
        times: Whole minutes above seconds `(2, k)`, or another layout of `foot_contacts.event_seconds`.
        labels: Names of the events.
        contexts: `Left`, `Right` or `General`; may be fewer than the labels.
        in_header: Whether they stand in the file's header, as in the 1990s.
    """

    times: Array
    labels: tuple[str, ...]
    contexts: tuple[str, ...]
    in_header: bool = False


@dataclass(frozen=True, eq=False)
class C3dContent:
    """Points, model outputs, events and force plates of a C3D file, in its own units.

    Attributes:
        time: `(n,)` of the frames [s].
        columns: Name of a point or model output, without a subject's prefix -> its column in `points`.
        points: `(3, k, n)` points and model outputs; 0, 0, 0 where they are missing.
        angles: Names of model angles that the parameters list.
        outputs: Names of forces, moments, powers and scalars.
        length_unit: Unit of points, or None where the file does not state one.
        angle_unit: Unit of model angles, or None.
        vertical: Axis that is up on the screen, as the file writes it, or "".
        events: Events.
        analog_rate: Samples of the force plates per second.
        plates: Force plates.
        parameters: All parameters of the file, e.g. the person's measures in PROCESSING.
        analysis: The file's own results: name -> value and unit, e.g. `Walking Speed`.
        remarks: What reading left out, a sentence each.
    """

    time: Array
    columns: dict[str, int]
    points: NDArray[np.float64]
    angles: frozenset[str]
    outputs: frozenset[str]
    length_unit: str | None
    angle_unit: str | None
    vertical: str
    events: C3dEvents
    analog_rate: float
    plates: tuple[C3dPlate, ...]
    parameters: C3dParameters
    analysis: Mapping[str, tuple[float, str]]
    remarks: tuple[str, ...] = ()

    def output(self, name: str) -> Array:
        """`(n, 3)` of one model output, in its own unit; NaN where all three numbers are 0."""
        values = self.points[:, self.columns[name]].T
        return np.where((values == 0).all(axis=1, keepdims=True), np.nan, values)
