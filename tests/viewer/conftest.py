"""Fixtures of the viewer's tests."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from exo_pin import viewer
from exo_pin.gait import Gait
from exo_pin.robot import Robot


@pytest.fixture(scope="session")
def scene(robot: Robot, gait: Gait) -> viewer.Scene:
    """The normal walk on the exoskeleton."""
    return viewer.scene(robot, gait)


@pytest.fixture
def server(scene: viewer.Scene) -> Iterator[viewer.Server]:
    """A live viewer of that walk."""
    with viewer.serve(scene, port=0) as running:
        yield running
