"""Patient files: a patient of one's own in TOML, in ten lines."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from exo_pin.anatomy import JOINTS, MOVEMENTS, SIDES
from exo_pin.arrays import Array
from exo_pin.control.patient import PATIENTS, Patient, with_activity
from exo_pin.errors import DescriptionError, ExoPinError, FormatError, UnknownNameError, known_name
from exo_pin.safe import toml_file

_TABLES = {"activity": "activity", "stiffness_nm_rad": "stiffness", "damping_nms_rad": "damping"}
_TABLES["spasticity_nms_rad"] = "spasticity"
_NUMBERS = {"delay_s": "delay", "spastic_threshold_rad_s": "spastic_threshold"}
_ENTRIES = ("name", "passive", *_NUMBERS, *_TABLES)


def find_patient(patient: str | Path | Patient) -> Patient:
    """A preset by name, a file, or the record itself.

    Raises:
        UnknownNameError: There is no such preset (a file's name ends in .toml).
        FormatError: The file is not accepted.
    """
    if isinstance(patient, Patient):
        return patient
    if str(patient).lower().endswith(".toml"):
        return load_patient(patient)
    return PATIENTS[known_name("patient", str(patient), PATIENTS)]()


def load_patient(path: str | Path) -> Patient:
    """Read a patient's file.

    Every entry may be left out; what is left out is a healthy person's: `name`, `passive` (true or false),
    `delay_s`, `spastic_threshold_rad_s`, and the tables `activity`, `stiffness_nm_rad`,
    `damping_nms_rad`, `spasticity_nms_rad`. A table's rows are a side, a movement or a joint and its number;
    a joint goes before a movement, a movement before a side.

    Raises:
        FormatError: The file is no TOML, or a name or number in it is not accepted.
    """
    values = toml_file.read(path)
    try:
        return _patient(values, Path(path).stem)
    except ExoPinError as error:
        raise FormatError(path, str(error)) from None


def _patient(values: dict[str, Any], stem: str) -> Patient:
    for name in values:
        if name not in _ENTRIES:
            raise UnknownNameError("entry of a patient's file", name, _ENTRIES)
    start = {"activity": np.ones(len(JOINTS))}
    nothing = np.zeros(len(JOINTS))
    fields: dict[str, Any] = {
        field: _joints(name, values[name], start.get(field, nothing))
        for name, field in _TABLES.items()
        if name in values
    }
    fields |= {field: _number(name, values[name]) for name, field in _NUMBERS.items() if name in values}
    passive = values.get("passive", True)
    if not isinstance(passive, bool):
        raise DescriptionError(f"passive is {passive!r}; true or false is accepted")
    return with_activity(_text(values, "name", stem), passive=passive, **(start | fields))


def _text(values: Mapping[str, Any], name: str, default: str) -> str:
    text = values.get(name, default)
    if not isinstance(text, str):
        raise DescriptionError(f"{name} is {text!r}; a text is accepted")
    return text


def _number(name: str, value: object) -> float:
    if type(value) not in (int, float):
        raise DescriptionError(f"{name} is {value!r}; a number is accepted")
    return float(value)  # type: ignore[arg-type]  # int or float, seen above


def _joints(name: str, table: object, start: Array) -> Array:
    """One number a joint: those of the preset, then of sides, of movements, of joints."""
    if not isinstance(table, dict):
        raise DescriptionError(f"{name} is {table!r}; a table of sides, movements or joints is accepted")
    out = np.array(start)
    rows = (*SIDES, *MOVEMENTS, *JOINTS)  # in this order: what comes later goes before
    places = {row: [k for k, joint in enumerate(JOINTS) if _belongs(joint, row)] for row in rows}
    for row in table:
        if row not in places:
            raise UnknownNameError(f"row of {name}", row, places)
    for row, columns in places.items():
        if row in table:
            out[columns] = _number(f"{name}.{row}", table[row])
    return out


def _belongs(joint: str, row: str) -> bool:
    """Whether a joint is meant by its name, its side or its movement."""
    return joint == row or joint.startswith(f"{row}_") or joint.endswith(f"_{row}")
