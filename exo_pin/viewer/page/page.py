"""The page: one HTML text from the files in page/, put together in a single pass."""

from __future__ import annotations

import base64
import gzip
import hashlib
import html as markup
import json
import re
from dataclasses import dataclass
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
    "forces.js",
    "bars.js",
    "scale.js",
    "window.js",
    "backdrop.js",
    "plot.js",
    "plots.js",
    "svg_pen.js",
    "toggles.js",
    "sliders.js",
    "reach.js",
    "handles.js",
    "record.js",
    "take.js",
    "controls.js",
    "transport.js",
    "player.js",
    "main.js",
)
"""The page's scripts in the order in which they are joined."""


@dataclass(frozen=True)
class PageTemplate:
    """The parts that all pages share; they are read from files once a template.

    Attributes:
        shell: HTML with a placeholder `{{name}}` for every other part.
        style: CSS.
        script: JavaScript.
        engine: meshcat's viewer, compressed, as base64.
        licences: Text.
        hashes: Of both scripts, as the page's policy names them.
    """

    shell: str
    style: str
    script: str
    engine: str
    licences: str
    hashes: tuple[str, str]

    @classmethod
    def load(cls) -> PageTemplate:
        """Read the page's files and those of meshcat.

        Raises:
            ExoPinError: meshcat is not installed.
        """
        script = "\n".join(["'use strict';", *map(_file, SCRIPTS)])
        engine = _engine()
        packed = base64.b64encode(gzip.compress(engine, compresslevel=9, mtime=0)).decode()
        hashes = (_hash(script.encode()), _hash(engine))
        return cls(_file("index.html"), _file("style.css"), script, packed, _licences(), hashes)

    def page(self, title: str, bundle: bytes = b"", *, connect: str = "'none'") -> str:
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
            "policy": markup.escape(self.policy(connect)),
            "style": self.style,
            "script": self.script,
            "licences": markup.escape(self.licences),
            "engine": self.engine,
            "bundle": base64.b64encode(bundle).decode(),
        }
        return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], self.shell)

    def policy(self, connect: str = "'none'") -> str:
        """The page's Content-Security-Policy: its own two scripts, and nothing from elsewhere.

        Args:
            connect: Where scripts may connect to (`connect-src`).
        """
        return (
            f"default-src 'none'; script-src {' '.join(self.hashes)}; style-src 'unsafe-inline'; "
            f"img-src data: blob:; media-src blob:; connect-src {connect}; "
            "base-uri 'none'; form-action 'none'"
        )


def _engine() -> bytes:
    """The viewer of meshcat, from the installed package."""
    return (_meshcat() / "dist" / "main.min.js").read_bytes()


def _hash(script: bytes) -> str:
    """The source expression that allows one inline script (Content-Security-Policy level 2)."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(script).digest()).decode()}'"


def _licences() -> str:
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


def _file(name: str) -> str:
    return (resources.files("exo_pin.viewer.page") / name).read_text("utf-8")
