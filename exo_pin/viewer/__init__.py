"""The viewer: a walk in the browser, live or as one offline page.

`scene(robot, gait)` makes the picture as a value, `html(scene)` a self-contained page of it, and
`serve(scene)` shows the same page from a server on this machine; `view(robot, gait)` is for notebooks.
Imports happen when a name is first used, so a server can start before Pinocchio is loaded.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from exo_pin.viewer.live.server import Server, serve
    from exo_pin.viewer.notebook import View, view
    from exo_pin.viewer.page.export import html
    from exo_pin.viewer.scenes.compiler import retargeted, scene
    from exo_pin.viewer.scenes.scene import Scene

__all__ = ["Scene", "Server", "View", "html", "retargeted", "scene", "serve", "view"]

_HOMES = {
    "Scene": "scenes.scene",
    "Server": "live.server",
    "View": "notebook",
    "html": "page.export",
    "retargeted": "scenes.compiler",
    "scene": "scenes.compiler",
    "serve": "live.server",
    "view": "notebook",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
