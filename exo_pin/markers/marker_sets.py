"""The marker sets that come with the package, by name."""

from __future__ import annotations

from pathlib import Path
from types import MappingProxyType

from exo_pin.errors import UnknownNameError
from exo_pin.markers.set_file import FOLDER, load_set
from exo_pin.markers.spots import MarkerSet

_ORDER = (
    *("plug-in-gait", "cgm2", "cmu", "helen-hayes", "ior", "leuven", "human-body-model"),
    *("opensim-gait2392", "opensim-rajagopal", "opencap", "stanford"),
)
"""Files in `sets/`; of two sets that match a trial alike the first one is taken."""

SETS = MappingProxyType({name: load_set(FOLDER / f"{name}.toml") for name in _ORDER})
"""Name -> marker set."""


def find_set(name: str) -> MarkerSet:
    """A set by one of its names, or by its TOML file.

    Raises:
        FormatError: The file is not accepted.
        UnknownNameError: There is no such set.
    """
    if not isinstance(name, str):
        raise UnknownNameError("marker set", name, SETS)
    if name.lower().endswith(".toml"):
        return load_set(Path(name))
    for entry in SETS.values():
        if name in (entry.name, *entry.known_as):
            return entry
    raise UnknownNameError("marker set", name, SETS)
