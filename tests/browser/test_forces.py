"""Forces in a browser: arrows at the feet, arcs around the joints."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin import viewer
from exo_pin.dynamics import torques

SINGLE = 1e-4  # [m] of an arrow: float32
SHORTEST = 0.03  # [m] a shorter arrow is not drawn
STEP = np.radians(3.1)  # an arc grows by steps of 3 degrees


@pytest.fixture(scope="module")
def found(robot, gait):
    return torques(robot, gait)


@pytest.fixture(scope="module")
def address(robot, gait, found, saved):
    kinetics = viewer.Kinetics.of_dynamics(found)
    return saved(viewer.scene(robot, gait, kinetics=kinetics, wearer=False))


ARROW = """(k => {{ const {{ group, shaft, head }} = exo.forces.arrows[k];
  const tip = new MeshCat.THREE.Vector3(0, head.position.y + 0.07 * head.scale.y, 0);
  tip.applyQuaternion(group.quaternion);
  return {{ shown: group.visible, tip: tip.toArray(), at: group.position.toArray() }};
}})({})"""

ARC = """(k => {{ const {{ group, head, radius, axis, column }} = exo.forces.arcs[k];
  const flip = group.children[0];
  flip.updateMatrix();
  const pose = new MeshCat.THREE.Matrix4().makeRotationFromQuaternion(group.quaternion).multiply(flip.matrix);
  const place = (x, y) => new MeshCat.THREE.Vector3(x, y, 0).applyMatrix4(pose);
  const [from, to] = [place(radius, 0), place(head.position.x, head.position.y)];
  return {{ shown: group.visible, from: from.toArray(), to: to.toArray(), axis, column }};
}})({})"""


def test_an_arrow_is_as_long_as_its_force_and_points_its_way(opened, gait, found):
    for k in (10, 30, 55):
        opened.evaluate(f"exo.seek({gait.time[k]}); exo.apply()")
        for foot in (0, 1):
            arrow = opened.evaluate(ARROW.format(foot))
            wanted = 0.6 * found.ground.force[k, foot] / found.weight_force
            assert arrow["shown"] == (np.linalg.norm(wanted) > SHORTEST)
            if arrow["shown"]:
                assert np.abs(np.array(arrow["tip"]) - wanted).max() < SINGLE
                assert arrow["at"][2] == 0.0


def test_an_arc_turns_as_its_torque_does_about_the_joints_axis(opened, gait, found):
    peak, seen = np.nanmax(np.abs(found.torque)), set()
    for k in (10, 30, 55, 80):
        opened.evaluate(f"exo.seek({gait.time[k]}); exo.apply()")
        for joint in range(12):
            arc = opened.evaluate(ARC.format(joint))
            torque = found.torque[k, arc["column"]]
            angle = np.radians(300) * abs(torque) / peak
            if arc["shown"] and angle < np.radians(170):
                start, end = np.array(arc["from"]), np.array(arc["to"])
                turn = np.cross(start, end) @ np.array(arc["axis"])
                assert np.arctan2(turn, start @ end) == pytest.approx(np.sign(torque) * angle, abs=STEP)
                seen.add(np.sign(torque))
    assert seen == {-1.0, 1.0}


def test_the_legend_says_that_the_ground_reaction_is_predicted(opened):
    assert "ground reaction, predicted" in opened.evaluate("document.getElementById('legend').innerText")
    assert "N" in opened.evaluate("document.querySelector('#keys span').title")


def test_forces_are_hidden_while_the_exoskeleton_is_posed_by_hand(opened):
    opened.evaluate("exo.seek(0.3); exo.apply(); exo.poseByHand(exo.chains[0].q)")
    assert opened.evaluate("exo.forces.arrows.every(({ group }) => !group.visible)")
    opened.evaluate("exo.apply()")
    assert opened.evaluate("exo.forces.arrows.some(({ group }) => group.visible)")


def test_the_numbers_of_a_tab_can_be_taken_away(opened, gait, found):
    opened.evaluate("exo.plots.choose(4)")
    table = opened.evaluate("tableText(tableOf(exo.plots), ',')").splitlines()
    heads = table[0].split(",")
    assert heads[:3] == ["time_s", "left_hip_flexion [N m]", "right_hip_flexion [N m]"]
    assert len(table) == 1 + len(gait)
    values = np.array([[float(x) for x in row.split(",")] for row in table[1:]])
    knee = heads.index("right_knee_flexion [N m]")
    assert np.abs(values[:, knee] - found.torque[:, 9]).max() < 0.01  # [N m] as rounded in the page
    drawn = opened.evaluate(
        "new DOMParser().parseFromString(plotsSvg(exo.plots), 'image/svg+xml').documentElement.tagName"
    )
    assert drawn == "svg"


def test_a_pose_by_buttons_keeps_the_limits_and_leads_back_to_the_walk(opened):
    opened.evaluate("exo.seek(0.2); exo.apply(); exo.plots.choose(exo.plots.groups.length)")
    walk = opened.evaluate("exo.chains[0].q")
    for name in ("Zero", "Centre", "Random"):
        opened.evaluate(
            f"[...document.querySelectorAll('#poses button')].find(b => b.textContent === '{name}').click()"
        )
        q = opened.evaluate("exo.chains[0].joints.map(({ limits }, k) => [exo.chains[0].q[k], ...limits])")
        assert all(low - 1e-9 <= x <= high + 1e-9 for x, low, high in q)
        assert opened.evaluate("exo.byHand")
    opened.evaluate("document.querySelector('#poses button').click()")
    assert opened.evaluate("exo.chains[0].q") == pytest.approx(walk)
