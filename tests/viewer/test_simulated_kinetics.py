"""A simulated walk in the picture: forces, motors' load, support, and a second run beside it."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin import viewer
from exo_pin.cli.simulated_scene import scene
from exo_pin.devices import find
from exo_pin.gait import normative_gait
from exo_pin.robot import load_robot
from exo_pin.simulation import simulate

SINGLE = 1e-4  # [N, N m] float32


@pytest.fixture(scope="module")
def run(robot):
    return simulate(robot, normative_gait("slow"), patient="healthy", body_weight_support=0.3, cycles=1)


@pytest.fixture(scope="module")
def shown(run):
    return scene(run, "slow on exo12", other=run)


def test_the_page_shows_the_runs_own_forces(run, shown):
    rows = slice(None, None, run.steps_per_sample(100.0))
    assert np.abs(shown.arrays["left_ground_reaction"] - run.floor.force[rows, 0]).max() < SINGLE
    assert np.abs(shown.arrays["support"] - run.support_wrench[rows, :3]).max() < SINGLE
    assert shown.facts.forces.load == "load"
    load = np.abs(run.motor[rows]) / load_robot().effort.max()
    assert np.all(shown.arrays["load"] >= load - 1e-6)  # of a motor's own limit, which is at most the largest
    assert {"Forces", "Torques", "Load", "Power", "Error"} < {tab.title for tab in shown.facts.plots}


def test_arrows_of_a_run_start_under_the_feet_that_are_shown(run, shown):
    loaded = np.isfinite(shown.arrays["left_ground_reaction_at"][:, 0])
    assert loaded.any()
    drift = run.reference.belt_speed * shown.arrays["time"][loaded]
    point = run.floor.point[:: run.steps_per_sample(100.0), 0][loaded]
    apart = shown.arrays["left_ground_reaction_at"][loaded, 0] - (point[:, 0] - drift)
    assert np.abs(apart).max() < 2e-3  # [m] the sole's pitch times its height over the ground as placed


def test_a_second_run_walks_beside_the_first_with_a_person_and_a_treadmill(shown):
    facts = shown.facts
    assert [chain.name for chain in facts.chains] == ["exo", "ghost", "wearer", "ghost_wearer"]
    assert facts.beside.shown
    assert len(facts.marks.belt.paths) == 2
    assert {path for path, _ in facts.painted} <= {
        f"/exo_pin/ghost{p.removeprefix('/exo_pin/exo')}" for _, p in facts.painted
    }
    assert any("ghost" in key.title and "walks" in key.title for key in facts.keys)


@pytest.mark.parametrize(("device", "stands"), [("exo12", True), ("lokomat", True), ("h2", False)])
def test_a_device_with_a_stand_is_held_by_it(device, stands, gait):
    robot = load_robot(device=find(device))
    scene = viewer.scene(robot, gait, wearer=False)
    assert bool(scene.facts.bars) == stands
    assert any(group.title == "Balance support" for group in scene.facts.groups) == stands


def test_straps_are_drawn_where_weight_is_carried(shown, gait, robot):
    straps = [bar for bar in shown.facts.bars if "strap" in bar.path]
    assert len(straps) == 2
    assert not any("strap" in bar.path for bar in viewer.scene(robot, gait, wearer=False).facts.bars)
