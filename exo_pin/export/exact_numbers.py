"""MJCF with numbers in full digits: MuJoCo writes six, which moves inertias by 3e-6."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any
from xml.etree.ElementTree import Element, indent, tostring

import numpy as np

from exo_pin.safe.xml_reader import parse_xml

_FIELDS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "body": ("pos", "quat"),
        "joint": ("axis", "range", "armature", "damping"),
        "geom": ("pos", "quat", "size", "friction", "solref"),
        "site": ("pos", "quat", "size"),
        "general": ("ctrlrange", "forcerange", "gainprm", "biasprm"),
        "key": ("qpos", "qvel", "ctrl"),
    }
)
"""Element -> its attributes in MJCF that hold numbers; the compiled model's fields have the same names."""

_INERTIAL: Mapping[str, str] = MappingProxyType(
    {"pos": "ipos", "quat": "iquat", "mass": "mass", "diaginertia": "inertia"}
)
"""Attribute of a body's `<inertial>` -> field of the compiled body."""

_ALWAYS = ("pos", "quat", "qpos")
"""Attributes that are written even where MuJoCo leaves them out for being their default to six digits."""


def exact_xml(spec: Any) -> str:
    """The MJCF of a MuJoCo model; reading it back gives the compiled model's numbers.

    Args:
        spec: An editable model (`mujoco.MjSpec`), every element of which has a name.
    """
    model = spec.compile()
    root = parse_xml(spec.to_xml(), Path(f"{spec.modelname}.xml"))
    for element in root.iter():
        name = element.get("name")
        if name is None or element.tag not in _FIELDS:
            continue
        compiled = _compiled(model, element.tag, name)
        _write(element, compiled, {field: field for field in _FIELDS[element.tag]})
        inertial = element.find("inertial")
        if inertial is not None:
            _write(inertial, compiled, _INERTIAL)
    indent(root)
    return tostring(root, encoding="unicode") + "\n"


def _compiled(model: Any, tag: str, name: str) -> Any:
    """An element of the compiled model by its kind and name."""
    find: Callable[[str], Any] = getattr(model, "actuator" if tag == "general" else tag)
    return find(name)


def _write(element: Element, compiled: Any, fields: Mapping[str, str]) -> None:
    for attribute, field in fields.items():
        text = element.get(attribute)
        if text is None and attribute not in _ALWAYS:
            continue
        values = np.ravel(getattr(compiled, field))
        kept = values if text is None else values[: len(text.split())]  # a sphere has one size of three
        element.set(attribute, " ".join(repr(float(x)) for x in kept))
