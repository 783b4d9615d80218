"""Options for reading a file: sign convention, column mapping, angle unit, OpenSim model."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Literal, NamedTuple

from exo_pin.anatomy.names import AngleUnit, PelvisRotation, SignPreset
from exo_pin.errors import FormatError


class ReadOptions(NamedTuple):
    """What the user adds to the content of a file, which decides where an option is None or empty.

    Attributes:
        preset: Name of a sign convention, one of `PRESETS`.
        mapping: The file's column -> joint or `time`.
        units: Unit of angles.
        model: The OpenSim model (.osim) that a file of coordinates belongs to.
        pelvis_order: Order of the pelvis's rotations where there is no model: names of
            `pelvis_axes.PELVIS_ROTATIONS`.
        columns: Of a table without a header line: what each column is, a joint or `time`; `-joint` turns the
            sign, `_` is a column that is not used.
        row_rate: Of a table without a column of seconds: rows per second [Hz].
    """

    preset: SignPreset | None = None
    mapping: Mapping[str, str] = MappingProxyType({})
    units: AngleUnit | None = None
    model: Path | None = None
    pelvis_order: tuple[PelvisRotation, ...] | None = None
    columns: tuple[str, ...] = ()
    row_rate: float | None = None

    def refuse(self, path: Path, *names: Literal["preset", "mapping", "units"], why: str) -> None:
        """Refuse options that a format leaves no choice for.

        Args:
            path: The file, for the message.
            names: Options that must be empty.
            why: What decides instead.

        Raises:
            FormatError: One of these options is given.
        """
        given = {"preset": self.preset, "mapping": self.mapping, "units": self.units}
        for name in names:
            if given[name]:
                raise FormatError(path, f"{name} is not for this kind of file: {why}")
