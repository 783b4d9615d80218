from __future__ import annotations

import numpy as np
import pytest

from exo_pin import viewer
from exo_pin.anatomy import SIDES, Body
from exo_pin.robot import load_robot
from exo_pin.viewer.scenes import person_figure

CENTIMETRE = 0.01


def drawn(scene, path):
    """Vertices of a part as drawn, in its node: `(v, 3)`."""
    scales = {
        c["path"]: np.reshape(c["matrix"], (4, 4)).T for c in scene.commands if c["type"] == "set_transform"
    }
    source = dict(scene.facts.twins).get(path, path)
    (command,) = [c for c in scene.commands if c["path"] == source and "object" in c]
    packed = command["object"]["geometries"][0]["data"]["attributes"]["position"]["array"]
    vertices = np.frombuffer(packed.data, "<f4").reshape(-1, 3)
    return vertices @ scales.get(path, np.eye(4))[:3, :3].T


def part(scene, link):
    return f"{scene.facts.chains[0].links[link]}/wearer"


@pytest.mark.parametrize("stature", [1.5, 1.75, 2.0])
def test_limbs_reach_from_joint_to_joint(gait, stature):
    body = Body.from_stature(stature)
    scene = viewer.scene(load_robot(body), gait)
    for side in SIDES:
        leg = body.leg(side)
        thigh, shank = (drawn(scene, part(scene, f"{side}_{name}")) for name in ("thigh", "shank"))
        assert thigh[:, 2].min() == pytest.approx(-leg.thigh, abs=0.06)
        assert shank[:, 2].min() == pytest.approx(-leg.shank, abs=0.06)
        assert np.abs(thigh[:, :2]).max() < 0.12


def test_feet_stand_on_the_plate_from_heel_to_toe(gait):
    body = Body.from_stature()
    scene = viewer.scene(load_robot(body), gait)
    for side in SIDES:
        leg, foot = body.leg(side), drawn(scene, part(scene, f"{side}_sole_plate"))
        assert foot[:, 0].min() == pytest.approx(-leg.heel, abs=CENTIMETRE)
        assert foot[:, 0].max() == pytest.approx(leg.foot_length - leg.heel, abs=CENTIMETRE)
        assert -leg.ankle_height < foot[:, 2].min() < -leg.ankle_height + 0.04


def test_the_head_is_where_the_stature_says(gait):
    body = Body.from_stature(1.9)
    scene = viewer.scene(load_robot(body), gait)
    (chain,) = [c for c in scene.facts.chains if c.name == "wearer"]
    crown = drawn(scene, f"{chain.root}/look")[:, 2].max()
    lumbar = 0.1 * (body.stature - body.leg_length) / 0.8315
    assert crown + lumbar == pytest.approx(body.stature - body.leg_length, abs=2 * CENTIMETRE)


def test_a_leg_of_another_size_is_drawn_in_its_own_size(gait):
    body = Body.from_stature(1.75, right_thigh=0.46, right_shank=0.40)
    scene = viewer.scene(load_robot(body), gait)
    left, right = (drawn(scene, part(scene, f"{side}_thigh"))[:, 2].min() for side in SIDES)
    assert right / left == pytest.approx(0.46 / body.left_thigh, rel=1e-3)


def test_left_and_right_are_mirror_images(gait):
    scene = viewer.scene(load_robot(), gait)
    left, right = (drawn(scene, part(scene, f"{side}_sole_plate")) for side in SIDES)
    assert right == pytest.approx(left * (1, -1, 1), abs=1e-6)


def test_arms_swing_with_the_opposite_leg(gait):
    scene = viewer.scene(load_robot(), gait)
    left_shoulder, right_hip = scene.arrays["wearer_q"][:, 0], gait.q[:, 6]
    assert np.corrcoef(left_shoulder, right_hip)[0, 1] > 0.999
    assert 0.1 < np.ptp(left_shoulder) < 0.9


def test_trunk_and_pelvis_stay_together(gait):
    scene = viewer.scene(load_robot(), gait)
    apart = np.linalg.norm(scene.arrays["wearer_base"][:, :3] - scene.arrays["base"][:, :3], axis=1)
    assert np.ptp(apart) < 1e-5
    assert apart.max() < 0.15


def test_nobody_is_drawn_where_nobody_is(gait):
    bare = Body.from_stature(wearer=False)
    for scene in (
        viewer.scene(load_robot(bare), gait),
        viewer.scene(load_robot(), gait, wearer=False),
    ):
        assert [chain.name for chain in scene.facts.chains] == ["exo"]
        assert not any("wearer" in command["path"] for command in scene.commands)


def test_the_figures_meshes_are_thin_and_in_one_piece():
    head = person_figure.part("head", (0.0056,) * 3)
    assert 100 < len(head.vertices) < 2000
    assert np.ptp(head.vertices, axis=0) == pytest.approx([0.18, 0.18, 0.235], abs=0.02)
    assert set(head.faces.ravel()) == set(range(len(head.vertices)))
