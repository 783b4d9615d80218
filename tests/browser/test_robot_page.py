"""Another robot's offline page: its links are where Pinocchio has them, with its own sliders and curves."""

import numpy as np
import pinocchio as pin
import pytest

from exo_pin import viewer
from exo_pin.gait import normative_gait
from exo_pin.kinematics import poses
from exo_pin.retarget import retarget

SINGLE = 1e-6  # [m]: the page computes from float32 angles and poses


@pytest.fixture(scope="module")
def walk():
    return retarget(normative_gait(), "simple_humanoid")


@pytest.fixture(scope="module")
def robot_scene(walk):
    return viewer.retargeted(walk)


@pytest.fixture(scope="module")
def robot_page(browser, robot_scene, saved):
    browser.resize(1000, 680)
    browser.open(saved(robot_scene))
    browser.evaluate("exo.seek(0)")
    return browser


def test_its_links_are_where_pinocchio_has_them_throughout_the_walk(robot_page, robot_scene, walk):
    names = robot_page.evaluate("Object.keys(exo.chains[0].links)")
    base = [pin.XYZQUATToSE3(row.astype(float)).homogeneous for row in robot_scene.arrays["base"]]
    expected = poses(walk.robot, walk.q, names, base=np.array(base))
    found = robot_page.evaluate(
        "[...exo.motion.time].map(t => (exo.seek(t), exo.apply(), Object.values(exo.chains[0].matrices())))"
    )
    T = np.array(found).reshape(len(walk.time), -1, 4, 4).swapaxes(2, 3)
    assert np.abs(T - expected).max() < 3 * SINGLE


def test_it_has_a_slider_and_a_curve_for_each_of_its_leg_joints(robot_page, walk):
    sliders = robot_page.evaluate("exo.sliders.rows.map(row => [row.label.className, row.label.textContent])")
    assert sorted(side for side, _ in sliders) == ["left"] * 6 + ["right"] * 6
    assert {text.split("KNEE")[0].strip() for _, text in sliders if "KNEE" in text} == {"LLEG", "RLEG"}
    titles = robot_page.evaluate("exo.plots.groups[0].plots.map(plot => plot.title)")
    assert len(titles) == len(walk.joints) / 2
    assert "LEG KNEE (knee flexion)" in titles


def test_its_foot_follows_the_hand_offline(robot_page):
    moved = robot_page.evaluate(
        "(() => { exo.seek(0); exo.apply(); const chain = exo.chains[0];"
        "const q = exo.motion.row(chain.spec.q, exo.motion.at(0));"
        "const inverse = chain.root.matrixWorld.clone().invert();"
        "const here = split(inverse.multiply(chain.links.l_ankle.matrixWorld));"
        "const pose = [...here.place.toArray(), ...here.turn.toArray()]; pose[2] += 0.05;"
        "return new Reach(chain).answer({ feet: { l_ankle: pose }, q: [...q] }).misses.l_ankle })()"
    )
    assert moved == [0, 0]
