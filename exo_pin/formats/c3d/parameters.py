"""The parameters of a C3D file: texts and numbers by group and name, whichever reader found them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from exo_pin.arrays import Array

_MOST_CONTINUATIONS = 40
"""Continuations of a parameter (LABELS2, LABELS3 ...) that are looked for."""


@dataclass(frozen=True, eq=False)
class C3dParameters:
    """Every parameter of a file under `GROUP:NAME` in capitals.

    Attributes:
        texts: Those that hold texts, without blanks around them.
        numbers: Those that hold numbers; the first dimension is the one that changes fastest in the file.
    """

    texts: Mapping[str, tuple[str, ...]]
    numbers: Mapping[str, Array]

    def all_texts(self, name: str) -> tuple[str, ...]:
        """The texts of a parameter and of its continuations, as POINT:LABELS has them beyond 255."""
        return tuple(text for key in _continued(name) for text in self.texts.get(key, ()))

    def text(self, name: str) -> str | None:
        """The first text of a parameter, or None if it has no text."""
        return next(iter(self.texts.get(name, ())), None)

    def all_numbers(self, name: str) -> Array:
        """The numbers of a parameter and, beside them, of its continuations; `(2, 0)`: there are none."""
        found = [np.atleast_2d(self.numbers[key]) for key in _continued(name) if key in self.numbers]
        same = [values for values in found if values.shape[0] == found[0].shape[0]]
        return np.concatenate(same, axis=1) if same else np.zeros((2, 0))

    def number(self, name: str) -> float | None:
        """The first number of a parameter, or None if it is missing or not finite."""
        values = self.numbers.get(name, np.zeros(0)).ravel(order="F")
        return float(values[0]) if values.size and np.isfinite(values[0]) else None


def from_json(text: str) -> C3dParameters:
    """The parameters as the child process writes them."""
    texts, numbers = dict[str, tuple[str, ...]](), dict[str, Array]()
    for name, value in json.loads(text).items():
        if isinstance(value, list):
            texts[name] = tuple(str(entry).strip() for entry in value)
        else:
            numbers[name] = np.array(value["numbers"], dtype=float).reshape(value["shape"])
    return C3dParameters(texts, numbers)


def _continued(name: str) -> list[str]:
    return [name, *(f"{name}{k}" for k in range(2, _MOST_CONTINUATIONS))]
