"""The installation, examined: packages and their versions, browser, ffmpeg, figure, cache, port."""

from __future__ import annotations

import platform
import re
import shutil
import socket
import sys
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path
from typing import Literal, NamedTuple

from exo_pin import cache
from exo_pin.cli import missing

State = Literal["ok", "differs", "optional", "wrong"]
"""`differs`: from the tested version; `optional`: missing or taken, the rest works; `wrong`: mend it."""

_PIN = re.compile(r"([\w.-]+)==([\w.]+)")
_FLOOR = re.compile(r"([\w.-]+)\s*>=\s*([\w.]+)")


class Finding(NamedTuple):
    """One thing that was looked at.

    Attributes:
        name: Of a package, or of what it is.
        state: How it is.
        found: Version, path ... in words.
        cure: What to do; empty where all is well.
    """

    name: str
    state: State
    found: str
    cure: str = ""


def findings(port: int = 7000) -> list[Finding]:
    """Everything that is examined, in the order in which a reader mends it.

    Args:
        port: Of the live page.
    """
    pins, floors = _locked(), _floors()
    packages = [
        _package(name, pins.get(_plain(name), ()), floors.get(_plain(name))) for name in missing.PACKAGES
    ]
    return [_python(), *packages, _figure(), _browser(), _ffmpeg(), _cache(), _port(port)]


def _plain(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def _locked() -> dict[str, tuple[str, ...]]:
    """Package -> its versions in the lock: two where another Python has another one."""
    package = Path(__file__).resolve().parents[1]
    for path in (package / "constraints.txt", package.parent / "constraints.txt"):
        if path.is_file():
            pins: dict[str, tuple[str, ...]] = {}
            for line in path.read_text("utf-8").splitlines():
                if pin := _PIN.match(line):
                    pins[_plain(pin[1])] = (*pins.get(_plain(pin[1]), ()), pin[2])
            return pins
    return {}


def _floors() -> dict[str, str]:
    """Package -> lowest version that this package's own metadata allow."""
    try:
        lines = requires("exo_pin") or []
    except PackageNotFoundError:  # run from its folder, without being installed
        return {}
    found = [_FLOOR.match(line) for line in lines if "extra ==" not in line]
    return {_plain(floor[1]): floor[2] for floor in found if floor}


def _numbers(text: str) -> tuple[int, ...]:
    """A version for comparison: its leading numbers, without zeros at the end."""
    parts = [int(part) for part in re.findall(r"\d+", re.split(r"[a-z+]", text)[0])]
    while parts and not parts[-1]:
        parts.pop()
    return tuple(parts)


def _python() -> Finding:
    return Finding("Python", "ok", f"{platform.python_version()} on {platform.system()} {platform.machine()}")


def _package(name: str, pins: tuple[str, ...], floor: str | None) -> Finding:
    """A package against its lowest version and against the lock."""
    package = missing.PACKAGES[name]
    try:
        found = version(name)
    except PackageNotFoundError:
        found = ""
    if not (missing.is_installed(package.module) if package.module else found):
        lost = f"not installed; without it: no {package.lost}"
        return Finding(name, "wrong" if package.needed else "optional", lost, missing.cure(name))
    if not found:
        return Finding(name, "ok", "installed, without a version")
    if floor and _numbers(found) < _numbers(floor):
        return Finding(
            name, "wrong", f"{found}, and {floor} or newer is needed", f"pip install -U '{name}>={floor}'"
        )
    if pins and found not in pins:
        words = f"{found}; tested with {' or '.join(pins)}"
        return Finding(name, "differs", words, "if it misbehaves: scripts/test installs the tested versions")
    return Finding(name, "ok", found)


def _figure() -> Finding:
    from exo_pin import examples

    path = examples.located("human_description/robots/human.urdf")
    if path is None:
        return Finding("wearer's figure", "optional", "not found", missing.cure("example-robot-data"))
    return Finding("wearer's figure", "ok", str(path))


def _browser() -> Finding:
    from exo_pin.viewer.film.guarded_browser import find

    path = find()
    if path is None:
        lost = "no Chromium found; picture, film and the figures of reproduce need it"
        return Finding("browser", "optional", lost, "apt install chromium, or its path in EXO_PIN_CHROMIUM")
    return Finding("browser", "ok", path)


def _ffmpeg() -> Finding:
    path = shutil.which("ffmpeg")
    if path is None:
        return Finding("ffmpeg", "optional", "not found; MP4 films need it", "apt install ffmpeg")
    return Finding("ffmpeg", "ok", path)


def _cache() -> Finding:
    home = cache.folder()
    if home is None:
        return Finding("cache", "ok", "switched off")
    why = cache.refusal(home)
    if why:
        return Finding("cache", "wrong", f"{home} is not used: {why}", "name another folder by EXO_PIN_CACHE")
    return Finding("cache", "ok", f"{home}, private" if home.is_dir() else f"{home}, made when needed")


def _port(port: int) -> Finding:
    """Whether the live page's port is free; the server takes the next one otherwise."""
    with socket.socket() as probe:
        if sys.platform != "win32":
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("127.0.0.1", port))
        except OSError as error:
            words = f"{port}: {error.strerror or error}; replay takes the next free one"
            return Finding("port", "optional", words, "exo-pin replay --port 0 takes any free one")
    return Finding("port", "ok", f"{port} is free")
