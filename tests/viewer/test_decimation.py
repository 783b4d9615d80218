"""Long recordings in the page: fewer samples, and a true word on the error."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from exo_pin import viewer
from exo_pin.dynamics import torques
from exo_pin.gait import Gait
from exo_pin.viewer.scenes import compiler
from exo_pin.viewer.scenes.decimation import decimated

MOST = 120


@pytest.fixture(scope="module")
def recording(gait):
    walk = gait.repeated(5)
    return Gait(walk.time, walk.q, base=walk.base, events=walk.events, source="five cycles")


def test_the_error_that_is_said_is_the_largest_between_the_samples(recording):
    found = decimated(recording, MOST)
    assert len(found.gait) == MOST
    assert found.gait.time[-1] == recording.time[-1]
    assert found.gait.events == recording.events
    shown = [np.interp(recording.time, found.gait.time, column) for column in found.gait.q.T]
    error = np.degrees(np.abs(np.stack(shown, axis=1) - recording.q).max())
    assert float(re.search(r"at most ([\d.]+) degrees", found.note)[1]) == pytest.approx(error, abs=0.006)
    assert f"{MOST} of {len(recording)} samples" in found.note


def test_a_walk_that_fits_is_shown_as_it_is(recording, gait):
    assert decimated(recording).gait is recording
    assert decimated(gait, MOST // 2).gait is gait
    assert decimated(gait, MOST // 2).note == ""


def test_the_page_of_a_long_recording_says_so_and_keeps_its_forces(robot, recording, monkeypatch):
    monkeypatch.setattr(compiler, "decimated", lambda walk: decimated(walk, MOST))
    kinetics = viewer.Kinetics.of_dynamics(torques(robot, recording))
    scene = viewer.scene(robot, recording, reference=replace(recording), kinetics=kinetics, wearer=False)
    assert {len(rows) for rows in scene.arrays.values()} == {MOST}
    assert any("samples; between them" in note for note in scene.facts.notes)
