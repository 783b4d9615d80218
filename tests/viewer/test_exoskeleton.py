from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from exo_pin import viewer
from exo_pin.gait import Gait, normative_gait
from exo_pin.ground import aligned
from exo_pin.kinematics import poses
from exo_pin.robot import load_robot

FLOAT32 = 1e-6  # the page gets seven digits


def test_a_recording_beside_a_cycle_is_not_bent_to_close(gait):
    half = Gait(np.arange(60) * 0.01, gait.q[:60])
    fitted, fastest = aligned(gait, half), np.abs(half.dq).max()
    assert np.abs(fitted.dq).max() < 1.1 * fastest  # its end and its beginning are far apart
    notes = viewer.scene(load_robot(), gait, compare=half).facts.notes
    assert any("waits at its end" in note for note in notes)


def test_a_ghost_has_its_own_chain_and_switch(gait):
    scene = viewer.scene(load_robot(), gait, compare=normative_gait("slow"), compare_title="slow")
    ghost = next(chain for chain in scene.facts.chains if chain.name == "ghost")
    assert scene.arrays["ghost_q"].shape == scene.arrays["q"].shape
    assert not np.allclose(scene.arrays["ghost_q"], scene.arrays["q"])
    assert "Ghost: slow" in [group.title for group in scene.facts.groups]
    assert scene.facts.compared == "slow"
    assert scene.facts.reference == ""
    exo = scene.facts.chains[0]
    assert set(ghost.links) == set(exo.links)
    assert not set(ghost.links.values()) & set(exo.links.values())


def test_the_second_walks_curves_are_dotted_beside_the_dashed_reference(gait):
    slow = normative_gait("slow")
    scene = viewer.scene(load_robot(), gait, compare=slow, reference=gait, reference_title="measured")
    assert (scene.facts.reference, scene.facts.compared) == ("measured", "compared")
    angles, speeds, pelvis = scene.facts.plots
    assert (pelvis.reference, pelvis.compared) == ("", "pelvis_compared")
    assert scene.arrays[angles.compared] == pytest.approx(aligned(gait, slow).q, abs=FLOAT32)
    assert scene.arrays[angles.reference] == pytest.approx(gait.q, abs=FLOAT32)
    assert scene.arrays[speeds.compared].shape == scene.arrays[speeds.values].shape


def test_toes_bend_as_far_as_the_ground_demands_and_no_further():
    robot = load_robot(device="planar9")
    gait = normative_gait()
    scene = viewer.scene(robot, gait)
    (chain,) = [chain for chain in scene.facts.chains if chain.name == "exo"]
    base = np.array([pin.XYZQUATToSE3(row.astype(float)).homogeneous for row in scene.arrays["base"]])
    q = np.tile(robot.neutral, (len(gait), 1))
    for k, joint in enumerate(chain.joints):
        q[:, robot.column(joint.name)] = scene.arrays["q"][:, k]
    leg = robot.body.leg("left")
    length = leg.foot_length - leg.heel - leg.ball
    tip = np.array([length, 0.0, 0.0, 1.0])
    bent = {toe: q[:, robot.column(toe)] for toe in ("left_toe_dorsiflexion", "right_toe_dorsiflexion")}
    assert all(angle.min() == 0 and 0.3 < angle.max() <= np.radians(60) + 1e-6 for angle in bent.values())
    straight = q.copy()
    for toe in bent:
        straight[:, robot.column(toe)] = 0
    for side in ("left", "right"):
        link = f"{side}_toe_plate"
        low = (poses(robot, q, [link], base=base)[:, 0] @ tip)[:, 2]
        rigid = (poses(robot, straight, [link], base=base)[:, 0] @ tip)[:, 2]
        assert low.min() > rigid.min() + 0.03
