"""What the user says of a file that the file does not say itself: preset, mapping of columns, units."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from exo_pin.errors import FormatError

UNITS = ("deg", "rad")
"""Units of angles."""


class Reading(NamedTuple):
    """How a file is to be read; empty where the file tells.

    Attributes:
        preset: Name of a sign convention, one of `PRESETS`.
        mapping: The file's column -> our joint or `time`.
        units: `"deg"` or `"rad"`.
        model: The OpenSim model (.osim) that a file of coordinates belongs to.
        pelvis_order: The order of the pelvis's turns, where there is no model: names of `pelvis.TURNS`.
    """

    preset: str | None = None
    mapping: Mapping[str, str] = MappingProxyType({})
    units: str | None = None
    model: Path | None = None
    pelvis_order: tuple[str, ...] | None = None

    def refuse(self, path: Path, *names: str, why: str) -> None:
        """Raise `FormatError` if one of these was said although the format leaves no choice."""
        for name in names:
            if getattr(self, name):
                raise FormatError(path, f"{name} is not for this kind of file: {why}")
