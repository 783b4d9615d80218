"""Other robots in the viewer: their feet on the belt, their meshes, curves and sliders."""

import numpy as np
import pinocchio as pin
import pytest

import exo_pin
from exo_pin import viewer
from exo_pin.cli import main
from exo_pin.gait import normative_gait
from exo_pin.kinematics import poses
from exo_pin.retarget import TARGETS, load, retarget
from exo_pin.robot import load_urdf
from exo_pin.viewer.live.foot_drag import reach_solver
from exo_pin.viewer.live.messages import ReachRequest
from exo_pin.viewer.meshes.urdf_meshes import ThinnedFiles
from exo_pin.viewer.scenes.appearance import robot_linkage
from exo_pin.viewer.scenes.humanoid import stage_robot
from exo_pin.viewer.scenes.joint_plots import groups
from exo_pin.viewer.scenes.soles import soles
from exo_pin.viewer.scenes.staging import SceneOptions

GAIT = normative_gait().resampled(40)
SINGLE = 1e-6  # [m]: float32 keeps seven digits
DEEPEST = 0.0031  # [m]: what the support allows a corner to sink, and rounding
LARGEST_PAGE = 3.5e6  # bytes of the offline page: the largest, TALOS's, has 2.7
BARE = ["simple_humanoid"]
NAMES = list(TARGETS)


@pytest.fixture(scope="module")
def stagings():
    return {name: stage_robot(retarget(GAIT, name), SceneOptions()) for name in NAMES}


def drawn(staging):
    return [command for command in staging.actors[0].commands if command["type"] == "set_object"]


@pytest.mark.parametrize("name", NAMES)
def test_its_feet_stand_on_the_belt_and_do_not_sink(stagings, name):
    walk = stagings[name].walk
    heights = walk.corners[..., 2]
    assert heights.min() > -DEEPEST
    lowest = heights.min(axis=1)
    assert lowest.max() < 0.02  # one foot is always at the ground
    assert walk.support.belt_speed > 0.3
    scaled = 0.5 * (walk.feet[:, 0, :3, 3] + walk.feet[:, 1, :3, 3])[:, 2]
    assert walk.base[:, 2, 3].mean() > scaled.mean()


@pytest.mark.parametrize("name", NAMES)
def test_a_sole_lies_level_under_its_ankle_with_the_heel_behind_and_the_inner_side_within(name):
    biped = load(name)
    tree, _ = robot_linkage(biped, "/x", None, ThinnedFiles())
    left, right = soles(biped, tree.shapes)
    for sole, leg, inwards in ((left, biped.legs[0], -1), (right, biped.legs[1], 1)):
        placed = leg.T @ sole.T  # standing, in the walker's axes
        assert placed[:3, :3] == pytest.approx(np.eye(3), abs=1e-9)
        assert placed[:2, 3] == pytest.approx(leg.ankle[:2], abs=1e-9)
        assert placed[2, 3] < leg.ankle[2] + 1e-9
        heel, front = sole.corners[:2], sole.corners[2:]
        assert heel[:, 0].max() < 0 < front[:, 0].min() <= sole.tip
        medial, lateral = sole.corners[[0, 2], 1], sole.corners[[1, 3], 1]
        assert (inwards * (medial - lateral) > 0).all()
        assert 0.02 <= sole.size[0] < 0.6 * leg.reach
    assert left.corners * (1, -1, 1) == pytest.approx(
        right.corners, abs=0.004
    )  # mirrored, but for the meshes


@pytest.mark.parametrize("name", NAMES)
def test_all_its_visuals_are_drawn_in_little_room(stagings, name):
    staging = stagings[name]
    assert not any("not drawn" in note for note in staging.notes)
    assert drawn(staging)
    size = sum(
        len(part["array"].data)
        for command in drawn(staging)
        for part in command["object"]["geometries"][0]["data"]["attributes"].values()
    )
    assert 1e4 < size < 5e6


def test_the_largest_offline_page_stays_reasonable():
    assert len(viewer.html(viewer.retargeted(retarget(GAIT, "talos")))) < LARGEST_PAGE


def test_collada_files_with_y_up_are_turned_where_that_fits_the_joints():
    """iCub's are made for tools that turn them: its shank's mesh then reaches to the ankle."""
    biped = load("icub")
    tree, meshes = robot_linkage(biped, "/x", None, ThinnedFiles())
    assert meshes.y_up
    assert meshes.turned
    T_shank, T_ankle = poses(biped.robot, biped.stand, ("l_lower_leg", "l_ankle_pitch"))
    ankle = np.linalg.inv(T_shank) @ T_ankle[:, 3]
    mesh = tree.shapes["l_lower_leg"].vertices
    assert (mesh.min(axis=0) - 0.02 < ankle[:3]).all()
    assert (ankle[:3] < mesh.max(axis=0) + 0.02).all()


@pytest.mark.parametrize("name", BARE)
def test_capsules_and_plates_stand_for_links_without_visuals(stagings, name):
    staging = stagings[name]
    paths = {command["path"] for command in drawn(staging)}
    chain = staging.actors[0].chain
    for leg in load(name).legs:
        assert f"{chain.links[leg.foot]}/plate" in paths
    assert sum(path.endswith("/look/0") for path in paths) >= 6  # both thighs, shanks and arms


@pytest.mark.parametrize("name", NAMES)
def test_plots_and_sliders_are_those_of_its_leg_joints_with_their_limits(stagings, name):
    staging, biped = stagings[name], load(name)
    per_leg = len(biped.legs[0].joints)
    for tab, lower, upper in zip(
        groups(staging.tabs), (biped.robot.lower, -biped.robot.velocity), (biped.robot.upper, None),
        strict=True,
    ):  # fmt: skip
        assert len(tab.plots) == per_leg
        for plot in tab.plots:
            assert [series.side for series in plot.series] == ["left", "right"]
            for series in plot.series:
                k = biped.robot.joints.index(biped.joints[series.column])
                assert series.lower == pytest.approx(max(lower[k], -1e6))
                if upper is not None:
                    assert series.upper == pytest.approx(upper[k])
    sliders = [joint for joint in staging.actors[0].chain.joints if joint.limits is not None]
    assert {joint.name for joint in sliders} == set(biped.joints)
    assert {joint.side for joint in sliders} == {"left", "right"}


def test_plots_say_what_a_joint_is_in_a_person(stagings):
    titles = [plot.title for plot in groups(stagings["talos"].tabs)[0].plots]
    assert titles[:4] == ["Leg 1 (hip rotation)", "Leg 2 (hip adduction)", "Leg 3 (hip flexion)",
                          "Leg 4 (knee flexion)"]  # fmt: skip


def test_notes_say_what_is_missed_whose_meshes_they_are_and_how_deep_long_feet_dip(stagings):
    notes = {name: " ".join(staging.notes) for name, staging in stagings.items()}
    assert "Apache-2.0" in notes["talos"]
    assert "BSD" not in notes["simple_humanoid"]  # nothing of its files is shown
    assert "below the ground" in notes["romeo"]
    assert "degrees at most" in notes["bolt"]


def test_a_robot_from_load_urdf_is_shown_as_it_is():
    robot = load_urdf(load("bolt").robot.path)
    scene = viewer.scene(robot, GAIT, title="my robot")
    (chain,) = scene.facts.chains
    assert {"FL_FOOT", "FR_FOOT"} <= set(chain.links)
    assert scene.facts.title == "my robot"
    assert "exo_pin" in exo_pin.view(robot, GAIT)._repr_html_()
    assert not any("not shown" in note for note in scene.facts.notes)
    bare = viewer.scene(load_urdf(robot.path.read_text()), GAIT)  # a text has no folder to look for meshes
    assert any("not drawn" in note for note in bare.facts.notes)
    assert any(path.endswith("/look") for group in bare.facts.groups for path in group.paths)


def test_curves_that_another_robot_cannot_show_are_not_left_out_in_silence():
    scene = viewer.scene(load_urdf(load("bolt").robot.path), GAIT, reference=GAIT)
    assert any("Reference curves" in note and "not shown" in note for note in scene.facts.notes)


def test_a_second_walk_is_a_ghost_of_the_same_robot():
    scene = viewer.retargeted(retarget(GAIT, "bolt"), compare=normative_gait("fast"), compare_title="fast")
    first, ghost = scene.facts.chains
    assert ghost.name == "ghost"
    assert scene.arrays["ghost_q"].shape == scene.arrays["q"].shape
    assert np.abs(scene.arrays["ghost_q"] - scene.arrays["q"]).max() > 0.02
    assert "Ghost: fast" in [group.title for group in scene.facts.groups]
    assert first.links.keys() == ghost.links.keys()


@pytest.mark.parametrize("name", ["talos", "g1"])
def test_its_feet_can_be_dragged(stagings, name):
    staging = stagings[name]
    chain = staging.actors[0].chain
    names = [joint.name for joint in chain.joints]
    q = staging.robot.q(dict(zip(names, staging.actors[0].arrays["q"][7], strict=True)))
    feet = {handle.link: poses(staging.robot, q, [handle.link])[0] for handle in staging.handles}
    start = [q[staging.robot.column(joint)] for joint in names]
    targets = {link: tuple(pin.SE3ToXYZQUAT(pin.SE3(T))) for link, T in feet.items()}
    answer = reach_solver(staging.robot, names)(ReachRequest(1, targets, tuple(start)))
    assert answer.misses == dict.fromkeys(feet, (0.0, 0.0))
    assert staging.handles[0].side == "left"


def test_point_feet_have_no_handles(stagings):
    assert stagings["bolt"].handles == ()


def test_replay_writes_a_page_of_a_robot_of_one_s_own(tmp_path, capsys):
    path, page = tmp_path / "mine.urdf", tmp_path / "mine.html"
    path.write_text(load("bolt").robot.path.read_text())
    assert main(["replay", "slow", "--robot", str(path), "--html", str(page)]) == 0
    assert "missed by" in capsys.readouterr().out
    assert page.stat().st_size < LARGEST_PAGE


@pytest.mark.parametrize("option", [["--device", "lokomat"], ["--hip-order", "yaw_roll_pitch"]])
def test_options_of_the_exoskeleton_do_not_go_with_a_robot(tmp_path, capsys, option):
    page = tmp_path / "x.html"
    assert main(["replay", "--robot", "bolt", *option, "--html", str(page)]) == 2
    assert option[0] in capsys.readouterr().err
    assert not page.exists()


def test_a_walk_along_another_axis_of_its_laboratory_is_turned_as_the_exoskeleton_s():
    travel = np.zeros((len(GAIT), 3))
    travel[:, 0] = 1.3 * GAIT.time
    base = GAIT.base.copy()
    base[:, :3, 3] += travel
    quarter = np.eye(4)
    quarter[:2, :2] = [[0, -1], [1, 0]]
    along = [
        viewer.retargeted(retarget(exo_pin.Gait(GAIT.time, GAIT.q, base=T @ base), "bolt")).arrays["base"]
        for T in (np.eye(4), quarter)
    ]
    assert along[1] == pytest.approx(along[0], abs=1e-4)
