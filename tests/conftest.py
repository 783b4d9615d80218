"""Fixtures that every test file may use."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, settings

from exo_pin.gait import Gait, normative_gait
from exo_pin.robot import Robot, load_robot

SEED = 20260101

# Examples are no timed tests: on a busy machine one of them may take its time.
settings.register_profile("exo_pin", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("exo_pin")


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Tests keep nothing in the user's cache, and find nothing there."""
    os.environ["EXO_PIN_CACHE"] = str(tmp_path_factory.mktemp("cache"))


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(SEED)


@pytest.fixture(scope="session")
def robot() -> Robot:
    """The exoskeleton on the default body."""
    return load_robot()


@pytest.fixture(scope="session")
def gait() -> Gait:
    """The normal walk at free speed."""
    return normative_gait()


@pytest.fixture(scope="session")
def recording(gait: Gait) -> Gait:
    """Two and a half cycles that do not repeat, with the events of each."""
    walk = gait.repeated(3)
    keep = walk.time <= 2.5 * gait.duration
    events = [event for event in walk.events if event.time <= walk.time[keep][-1]]
    assert walk.base is not None
    return Gait(walk.time[keep], walk.q[keep], base=walk.base[keep], events=events, source="repeated")


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of recorded and published gait data that may stand beside the repository."""
    folder = Path(__file__).resolve().parents[2] / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("needs the gait data in ../shared/data, which a plain clone does not have")
    return folder


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Quick tests first: those that need a browser come last."""
    items.sort(key=lambda item: "browser" in item.path.parts)
