"""Wrong values for an argument, made from a right one: what no public function may take in silence."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

_HUGE = 10**400  # beyond every float
_MANY = 10**9  # samples: more than any machine of a laboratory holds


class Wrong(NamedTuple):
    """A wrong value: what it is, and whether it may be understood after all (then no NaN may come of it)."""

    what: str
    value: Any
    bearable: bool = False


def of_number(right: float) -> Iterator[Wrong]:
    """Numbers that are not finite or not real, and values that are no number."""
    for what in ("nan", "inf", "-inf"):
        yield Wrong(what, float(what))
    yield Wrong("complex", complex(right, 1.0))
    yield Wrong("complex without imaginary part", np.complex128(right))
    yield Wrong("text", "x")
    yield Wrong("number as text", "1")
    yield Wrong("list", [right, right])
    yield Wrong("array", np.array([right, right]))
    yield Wrong("object", object())
    yield Wrong("masked", np.ma.masked)
    yield Wrong("beyond floats", _HUGE)
    yield Wrong("huge", 1e308, bearable=True)
    yield Wrong("negative", -1.0, bearable=True)
    yield Wrong("zero", 0.0, bearable=True)
    yield Wrong("truth value", True, bearable=True)


def of_count(right: int) -> Iterator[Wrong]:
    """What is no whole number, and counts that are too small or too large."""
    for wrong in of_number(right):
        if wrong.what not in ("huge", "negative", "zero", "beyond floats"):
            yield wrong
    yield Wrong("half", right + 0.5)
    yield Wrong("beyond floats", _HUGE, bearable=True)
    yield Wrong("huge", _MANY, bearable=True)
    yield Wrong("negative", -1, bearable=True)
    yield Wrong("zero", 0, bearable=True)


def of_array(right: Any, *, rows: bool = True) -> Iterator[Wrong]:
    """Arrays of other shapes and kinds, and with one number that is none."""
    good = np.asarray(right)
    for what in ("nan", "inf", "-inf"):
        spoiled = np.array(good, dtype=float)
        spoiled.flat[-1] = float(what)
        yield Wrong(what, spoiled)
    yield Wrong("complex", good + 1j)
    yield Wrong("list of complex", (good + 0j).tolist())
    yield Wrong("objects", np.full(good.shape, None, dtype=object))
    yield Wrong("texts", good.astype(str))
    yield Wrong("text", "x")
    yield Wrong("dictionary", {})
    yield Wrong("ragged", [[1.0, 2.0], [3.0]])
    yield Wrong("masked", np.ma.masked_array(good, mask=np.arange(good.size).reshape(good.shape) == 0))
    yield Wrong("one axis more", good[..., None])
    if good.ndim:
        yield Wrong("one number less", good[..., :-1])
        yield Wrong("one axis less", good[0])
        yield Wrong("integer", 3)
        yield Wrong("empty", good[:0], bearable=True)
    if good.ndim and rows:
        yield Wrong("one row less", good[:-1])


def of_name(right: str) -> Iterator[Wrong]:
    """Names that do not exist, and values that are no name."""
    yield Wrong("unknown", "no such name")
    yield Wrong("empty text", "")
    yield Wrong("number", 3)
    yield Wrong("nan", float("nan"))
    yield Wrong("list", [right])
    yield Wrong("bytes", right.encode())


def of_names(right: Any) -> Iterator[Wrong]:
    """Sequences of wrong names, and values that are no sequence."""
    first = next(iter(right))
    yield Wrong("text", str(first))
    yield Wrong("number", 3)
    yield Wrong("numbers", [3])
    yield Wrong("unknown", ["no such name"])
    yield Wrong("bytes", [b"left_foot"])
    yield Wrong("empty", [], bearable=True)


def of_path(right: Any) -> Iterator[Wrong]:
    """Paths that lead to nothing usable."""
    yield Wrong("missing", "no/such/folder/file.csv")
    yield Wrong("folder", "/")
    yield Wrong("NUL", "walk\0.csv")


def of_mapping(right: Mapping[str, Any]) -> Iterator[Wrong]:
    """Mappings with a wrong name or a wrong value, and values that are no mapping."""
    name, value = next(iter(right.items()))
    yield Wrong("number", 3)
    yield Wrong("list", [1])
    yield Wrong("unknown name", {"no such name": value})
    yield Wrong("number as name", {3: value})
    for wrong in (*_values(value), Wrong("None", None)):
        yield Wrong(f"{name}: {wrong.what}", {**right, name: wrong.value}, wrong.bearable)


def _values(value: Any) -> Iterator[Wrong]:
    if isinstance(value, np.ndarray):
        return of_array(value)
    if isinstance(value, float | int):
        return of_number(value)
    return iter([Wrong("nan", float("nan")), Wrong("object", object())])


KINDS = {
    "array": of_array,
    "count": of_count,
    "mapping": of_mapping,
    "name": of_name,
    "names": of_names,
    "number": of_number,
    "path": of_path,
}
