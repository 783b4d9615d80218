"""The viewer in a notebook: an object whose display is the offline page in a frame."""

from __future__ import annotations

import html as markup
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from exo_pin.gait import Gait
from exo_pin.robot import Robot
from exo_pin.viewer.page.export import html
from exo_pin.viewer.scenes.compiler import scene


@dataclass(frozen=True, eq=False)
class View:
    """A walk that shows itself in a notebook.

    Attributes:
        page: The offline page.
        height: Of the frame [px].
    """

    page: str
    height: int

    def save(self, path: str | Path) -> None:
        """Write the page to a file that any browser opens."""
        Path(path).write_text(self.page, "utf-8")

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{markup.escape(self.page)}" sandbox="allow-scripts allow-downloads" '
            f'style="width:100%;height:{self.height}px;border:0" title="exo_pin"></iframe>'
        )


def view(robot: Robot, gait: Gait, *, height: int = 640, **options: Any) -> View:
    """Look at a walk in a notebook.

    Args:
        robot: The exoskeleton, or any robot with two legs from `load_urdf`.
        gait: The walk.
        height: Of the frame [px].
        **options: Further options of `viewer.scene`, e.g. `reference=` or `torques=`.
    """
    return View(html(scene(robot, gait, **options)), height)
