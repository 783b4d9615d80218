"""Export: a scene as one offline HTML text that needs no server and no network."""

from __future__ import annotations

from exo_pin.viewer.page.bundle import bundle
from exo_pin.viewer.page.page import page
from exo_pin.viewer.scenes.scene import Scene


def html(scene: Scene) -> str:
    """The scene as a self-contained page: write it to a file and open it anywhere.

    Args:
        scene: What `viewer.scene` made.

    Returns:
        HTML. Everything is inside and compressed; the page's own policy forbids any request.
    """
    return page(scene.title, bundle(scene))
