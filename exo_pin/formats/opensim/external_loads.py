"""Files for OpenSim's inverse dynamics tool: forces on the feet, external loads, the tool's setup."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from exo_pin.anatomy.names import Side
from exo_pin.files import write_text
from exo_pin.formats.opensim.pelvis_axes import FROM_OPENSIM
from exo_pin.formats.opensim.storage import write_storage
from exo_pin.formats.tables.metadata import Metadata, comment_lines
from exo_pin.gait.trial import ForcePlate

_FOOT_BODY = "calcn_{}"
"""The body of a foot in gait2354, gait2392, Rajagopal 2016 and their descendants."""

_COLUMNS = {"force": "ground_force_{}_v", "point": "ground_force_{}_p", "moment": "ground_torque_{}_"}
"""Field of a plate -> column without its axis."""


def write_foot_forces(feet: Mapping[Side, ForcePlate], path: Path, *, source: str) -> None:
    """Write the ground's force, centre of pressure and free moment of each foot, in OpenSim's axes.

    Args:
        feet: Side -> forces on that foot; both have the same times. OpenSim knows no gaps (it stops reading
            at a NaN, and extrapolates), so that every number is finite.
        path: The file, .mot.
        source: Where the numbers come from, in words.

    Raises:
        FormatError: The file cannot be written.
    """
    names, parts = ["time"], [next(iter(feet.values())).time[:, None]]
    for side, plate in feet.items():
        for field, column in _COLUMNS.items():
            names += [column.format(side[0]) + axis for axis in "xyz"]
            parts.append(getattr(plate, field) @ FROM_OPENSIM)
    remarks = [
        "Written by exo_pin: forces of the ground on the feet; N, m, N m; x forward, y up, z right.",
        *comment_lines(Metadata(source=source)),
    ]
    write_storage(path, path.name, remarks, names, np.hstack(parts), degrees=False)


def write_external_loads(path: Path, forces: Path, sides: tuple[Side, ...]) -> None:
    """Write OpenSim's `ExternalLoads`: which columns of a force file act on which foot.

    Args:
        path: The file, .xml.
        forces: A file of `write_foot_forces`, named relative to the folder of `path`.
        sides: The feet in it.

    Raises:
        FormatError: The file cannot be written.
    """
    loads = ET.Element("ExternalLoads", name=path.stem)
    objects = ET.SubElement(loads, "objects")
    for side in sides:
        force = ET.SubElement(objects, "ExternalForce", name=f"{side}_foot")
        columns = {field: column.format(side[0]) for field, column in _COLUMNS.items()}
        _entries(
            force,
            applied_to_body=_FOOT_BODY.format(side[0]),
            force_expressed_in_body="ground",
            point_expressed_in_body="ground",
            force_identifier=columns["force"],
            point_identifier=columns["point"],
            torque_identifier=columns["moment"],
        )
    _entries(loads, datafile=_relative(forces, path))
    _write(loads, path)


def write_tool_setup(
    path: Path,
    *,
    loads: Path,
    coordinates: Path,
    model: Path | None,
    times: tuple[float, float],
    cutoff: float | None,
) -> None:
    """Write the setup of OpenSim's `InverseDynamicsTool`. Its results go beside it, named like it.

    Args:
        path: The file, .xml.
        loads: A file of `write_external_loads`.
        coordinates: The motion, .mot or .sto.
        model: The model, .osim; None: the user names one.
        times: First and last time at which the forces are known [s].
        cutoff: Low-pass of the coordinates [Hz]; None: no filter.

    Raises:
        FormatError: The file cannot be written.
    """
    tool = ET.Element("InverseDynamicsTool", name=path.stem)
    _entries(
        tool,
        results_directory=".",
        model_file="" if model is None else _relative(model, path),
        time_range=f"{times[0]!r} {times[1]!r}",
        forces_to_exclude="Muscles",
        external_loads_file=_relative(loads, path),
        coordinates_file=_relative(coordinates, path),
        lowpass_cutoff_frequency_for_coordinates=repr(-1.0 if cutoff is None else cutoff),
        output_gen_force_file=f"{path.stem}_result.sto",
    )
    _write(tool, path)


def _entries(element: ET.Element, **values: str) -> None:
    for name, value in values.items():
        ET.SubElement(element, name).text = value


def _relative(file: Path, to: Path) -> str:
    """The name of a file for another one; OpenSim looks for it from that one's folder."""
    return os.path.relpath(os.path.realpath(file), os.path.realpath(to.parent))


def _write(element: ET.Element, path: Path) -> None:
    document = ET.Element("OpenSimDocument", Version="40000")
    document.append(element)
    ET.indent(document)
    text = ET.tostring(document, encoding="unicode")
    write_text(path, f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n')
