"""Plug-ins: devices, controllers, robots and file formats of other packages, by their entry points."""

from __future__ import annotations

from collections.abc import Iterable
from importlib.metadata import EntryPoint, entry_points
from typing import Any, Literal, TypeVar

from exo_pin.errors import DescriptionError, same_name, shortened

Group = Literal["exo_pin.devices", "exo_pin.controllers", "exo_pin.targets", "exo_pin.formats"]
Kind = TypeVar("Kind")


def plugin_names(group: Group) -> tuple[str, ...]:
    """Names that other packages add to a group; nothing of them is loaded.

    Args:
        group: The group of entry points.
    """
    return tuple(sorted({entry.name for entry in entry_points(group=group)}))


def plugin(group: Group, name: str, kind: type[Kind]) -> Kind | None:
    """What another package adds under a name, loaded; None: no package adds that name.

    Args:
        group: The group of entry points.
        name: What is looked up; capitals, blanks, `-` and `_` do not matter.
        kind: What it has to be.

    Raises:
        DescriptionError: It cannot be loaded, or is of another kind; the message names the package.
    """
    found = list(entry_points(group=group))
    same = same_name(name, [entry.name for entry in found])
    for entry in found:
        if entry.name == same:
            return _loaded(entry, kind)
    return None


def plugins(group: Group, kind: type[Kind]) -> Iterable[Kind]:
    """All that other packages add to a group, loaded; errors as of `plugin`.

    Args:
        group: The group of entry points.
        kind: What each has to be.
    """
    return [_loaded(entry, kind) for entry in entry_points(group=group)]


def _loaded(entry: EntryPoint, kind: type[Kind]) -> Kind:
    package = entry.dist.name if entry.dist else "a package"
    try:
        loaded: Any = entry.load()
    except Exception as error:  # whatever a stranger's module does when it is imported
        why = shortened(f"{type(error).__name__}: {error}")
        raise DescriptionError(f"plug-in {entry.name!r} of {package} cannot be loaded: {why}") from error
    if not isinstance(loaded, kind):
        wanted = " or ".join(one.__name__ for one in (kind if isinstance(kind, tuple) else (kind,)))
        raise DescriptionError(
            f"plug-in {entry.name!r} of {package} is no {wanted} but {type(loaded).__name__}"
        )
    return loaded
