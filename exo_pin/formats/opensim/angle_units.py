"""Whether the angles of a file of OpenSim coordinates are in degrees: the user, the header, the numbers."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from exo_pin.errors import FormatError
from exo_pin.formats.opensim.coordinate_names import LEG_COORDINATES
from exo_pin.formats.tables.numeric_table import NumericTable
from exo_pin.formats.units import angle_unit

_HALF_TURN = np.pi
_TURN = 2 * np.pi
"""No joint of a leg turns that far [rad]; a walk in degrees always does."""

_MOVES = 0.2
"""A walk turns a joint by more from one end to the other [rad]; below, a wrong unit cannot be seen."""


def in_degrees(table: NumericTable, keys: Mapping[str, str], chosen: str | None) -> tuple[bool, list[str]]:
    """Whether angles are in degrees, and remarks on how that is known.

    The user's word wins over the header; numbers that no leg reaches in radians win over a header that
    states radians, or nothing. A header that states degrees above a leg that turns by no more than half a
    turn in radians would is refused: no walk is so small in degrees.

    Args:
        table: With plain names.
        keys: Of the header.
        chosen: Unit by the user.

    Raises:
        FormatError: Nothing states the unit, or the numbers contradict it.
        UnknownNameError: The user's unit does not exist.
    """
    name, largest, moves = _largest(table)
    reached = f"{name} reaches {largest:.3g}"
    stated = keys.get("indegrees", "").lower()
    header = f"the header says inDegrees={stated[:20]}" if stated else "the header has no inDegrees"
    if chosen:
        degrees = angle_unit(chosen) == "deg"
        if not degrees and largest > _HALF_TURN:
            raise FormatError(table.path, f"units are given as rad, but {reached}: degrees?")
        contradicts = stated in ("yes", "no") and degrees != (stated == "yes")
        said = [f"{header}; angles are read as {chosen}, as the units are given"] * contradicts
        few = degrees and moves and largest < _HALF_TURN
        return degrees, said + [
            f"angles are read as deg, as the units are given, but {reached}: radians?"
        ] * few
    if stated == "yes":
        if moves and largest < _HALF_TURN:
            raise FormatError(table.path, f"{header} (degrees), but {reached}: radians? Give the units")
        return True, []
    if largest > _TURN:
        return True, [f"{header}, but {reached}, which no leg does in radians: read as degrees"]
    if stated == "no":
        if largest > _HALF_TURN:
            raise FormatError(table.path, f"{header} (radians), but {reached}: degrees? Give the units")
        return False, []
    why = f"{header}; expected inDegrees=yes or inDegrees=no, or that you give the units (deg or rad)"
    raise FormatError(table.path, f"{why}; {reached}")


def _largest(table: NumericTable) -> tuple[str, float, bool]:
    """The leg coordinate with the largest number, that number without its sign, and whether a leg moves."""
    names = [name for name in LEG_COORDINATES if name in table.names]
    found = table.columns(names)
    values = np.where(np.isfinite(found), found, 0.0)
    peaks = np.abs(values).max(axis=0)
    k = int(peaks.argmax())
    return names[k], float(peaks[k]), bool((np.ptp(values, axis=0) > _MOVES).any())
