"""The viewer: a walk in the browser, live or as one offline page.

`scene(robot, gait)` makes the picture as a value, `html(scene)` a self-contained page of it, and
`serve(scene)` shows the same page from a server on this machine; `view(robot, gait)` is for notebooks,
`draw(vis, robot)` for a window of the meshcat package that is open already.
Imports happen when a name is first used, so a server can start before Pinocchio is loaded.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from exo_pin.viewer.live.server import Server, serve
    from exo_pin.viewer.meshcat_window import MeshcatRobot, draw
    from exo_pin.viewer.page.packing import bundle, html
    from exo_pin.viewer.scenes.compiler import exoskeleton_scene, robot_scene
    from exo_pin.viewer.scenes.kinetics import Kinetics
    from exo_pin.viewer.scenes.scene import Scene
    from exo_pin.viewer.scenes.staging import SceneOptions
    from exo_pin.viewer.views import View, retargeted, scene, view

__all__ = [
    "Kinetics",
    "MeshcatRobot",
    "Scene",
    "SceneOptions",
    "Server",
    "View",
    "bundle",
    "draw",
    "exoskeleton_scene",
    "html",
    "retargeted",
    "robot_scene",
    "scene",
    "serve",
    "view",
]

_HOMES = {
    "Kinetics": "scenes.kinetics",
    "MeshcatRobot": "meshcat_window",
    "Scene": "scenes.scene",
    "SceneOptions": "scenes.staging",
    "Server": "live.server",
    "View": "views",
    "bundle": "page.packing",
    "draw": "meshcat_window",
    "exoskeleton_scene": "scenes.compiler",
    "html": "page.packing",
    "retargeted": "views",
    "robot_scene": "scenes.compiler",
    "scene": "views",
    "serve": "live.server",
    "view": "views",
}
"""Name -> module that it is imported from when it is first used."""


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
