"""The page: one HTML text from the files in page/, put together in a single pass."""

from __future__ import annotations

import base64
import gzip
import html as markup
import json
import re
from functools import cache
from importlib import resources
from importlib.util import find_spec
from pathlib import Path

from exo_pin import examples
from exo_pin.errors import ExoPinError

SCRIPTS = (
    "bundle.js",
    "clock.js",
    "motion.js",
    "chain.js",
    "cameras.js",
    "quality.js",
    "stage.js",
    "marks.js",
    "scale.js",
    "window.js",
    "backdrop.js",
    "plot.js",
    "plots.js",
    "toggles.js",
    "sliders.js",
    "reach.js",
    "handles.js",
    "record.js",
    "controls.js",
    "transport.js",
    "player.js",
    "main.js",
)
"""The page's scripts in the order in which they are joined."""


def page(title: str, bundle: bytes = b"", *, connect: str = "'none'") -> str:
    """The whole page as text.

    Args:
        title: Shown until the scene arrives; any characters.
        bundle: A packed scene to embed; empty for a page that a server feeds.
        connect: Where scripts may connect to (Content-Security-Policy `connect-src`).

    Returns:
        HTML that loads nothing else: style, scripts and meshcat's viewer are in it, and its own policy
        forbids every request except to `connect`.
    """
    parts = {
        "title": markup.escape(title),
        "policy": markup.escape(policy(connect)),
        "style": _file("style.css"),
        "script": "\n".join(["'use strict';", *map(_file, SCRIPTS)]),
        "licences": markup.escape(licences()),
        "engine": engine(),
        "bundle": base64.b64encode(bundle).decode(),
    }
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], _file("index.html"))


def policy(connect: str = "'none'") -> str:
    """The page's Content-Security-Policy: everything inline, nothing from elsewhere."""
    return (
        "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
        f"img-src data: blob:; media-src blob:; connect-src {connect}; base-uri 'none'; form-action 'none'"
    )


@cache
def engine() -> str:
    """The viewer of meshcat, from the installed package, compressed, as base64."""
    source = (_meshcat() / "dist" / "main.min.js").read_bytes()
    return base64.b64encode(gzip.compress(source, compresslevel=9, mtime=0)).decode()


@cache
def licences() -> str:
    """The licences of meshcat's viewer, of all that is bundled in it, and of the wearer's figure."""
    folder = _meshcat()
    texts = ["meshcat", (folder / "LICENSE").read_text("utf-8")]
    texts.append((folder / "dist" / "main.min.js.LICENSE.txt").read_text("utf-8"))
    listing = folder / "dist" / "main.min.js.THIRD_PARTY_LICENSES.json"
    texts.extend(
        f"{entry['name']} {entry['version']} ({entry['license']})\n{entry['licenseText']}"
        for entry in json.loads(listing.read_text("utf-8"))
    )
    texts += _figure_licence()
    return "\n\n".join(text.strip() for text in texts)


def _figure_licence() -> list[str]:
    """The licence of example-robot-data, whose figure of a person may be in the page."""
    texts = [path.read_text("utf-8") for path in examples.licences()]
    return ["example-robot-data (the wearer's figure, other robots)", *texts] if texts else []


def _meshcat() -> Path:
    spec = find_spec("meshcat")  # found without importing it
    if spec is None or not spec.submodule_search_locations:
        raise ExoPinError("meshcat is not installed; `pip install meshcat` brings it")
    return Path(spec.submodule_search_locations[0]) / "viewer"


@cache
def _file(name: str) -> str:
    return (resources.files("exo_pin.viewer.page") / name).read_text("utf-8")
