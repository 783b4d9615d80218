"""Bipeds of any arrangement walk: joints before the legs, axes in any order and apart, halved knees."""

from __future__ import annotations

import json
from dataclasses import dataclass, field

import numpy as np
import pytest

from exo_pin import viewer
from exo_pin.cli import main
from exo_pin.errors import DescriptionError
from exo_pin.feasible import nearest
from exo_pin.gait import normative_gait
from exo_pin.kinematics import center_of_mass, poses
from exo_pin.retarget import Target, as_biped, retarget
from exo_pin.robot import load_urdf

GAIT = normative_gait().resampled(100)
LARGEST_STEP = 4.0  # degrees a sample at 100 samples; the person's knee turns 3.5
PLACED = 1e-4  # metres: what need not be said
SIZES = {"child": 0.45, "adult": 1.0, "giant": 1.6}
AXES = {"yaw": "0 0 1", "roll": "1 0 0", "pitch": "0 1 0"}
RANGES = {
    "hip_yaw": (-0.8, 0.8),
    "hip_roll": (-0.6, 0.6),
    "hip_pitch": (-2.0, 0.8),
    "knee": (0.0, 2.3),
    "ankle_pitch": (-1.0, 0.7),
    "ankle_roll": (-0.4, 0.4),
}


@dataclass(frozen=True)
class Arrangement:
    """What differs from a plain biped: trunk, hip yaw, roll, pitch, knee, ankle pitch, roll, links of 0.4 m.

    Attributes:
        before: Joints that carry both legs: name -> type and axis.
        hip: Order of the hip's axes.
        ankle: Order of the ankle's axes.
        apart: Offsets of joints from the one before, times the size [m].
        ranges: Limits of joints, of both legs [rad].
        kind: The type of the legs' joints.
        axis: Axes of joints that are not the usual.
        mimic: Whether the knee is made of two halves, the second following the first.
        link_is_joint: Whether links have the names of the joints that carry them.
        toes: Whether a toe hinge follows the foot.
        six: Whether its feet can have any attitude.
    """

    before: dict[str, tuple[str, str]] = field(default_factory=dict)
    hip: tuple[str, ...] = ("yaw", "roll", "pitch")
    ankle: tuple[str, ...] = ("pitch", "roll")
    apart: dict[str, tuple[float, float, float]] = field(default_factory=dict)
    ranges: dict[str, tuple[float, float]] = field(default_factory=dict)
    kind: str = "revolute"
    axis: dict[str, str] = field(default_factory=dict)
    mimic: bool = False
    link_is_joint: bool = False
    toes: bool = False
    six: bool = True

    def urdf(self, size: float) -> str:
        """The URDF of a biped so many times as large."""
        parts, parent = ['<link name="trunk"/>'], "trunk"
        for name, (kind, axis) in self.before.items():
            link = name + "_link" * (not self.link_is_joint)
            parts.append(self._joint(name, parent, link, (0, 0, 0), axis, (-1, 1), kind))
            parent = link
        for side, y in (("left", 0.1), ("right", -0.1)):
            parts.append(self._leg(side, y, size, parent))
        return f'<robot name="walker">{"".join(parts)}</robot>'

    def _leg(self, side: str, y: float, size: float, parent: str) -> str:
        names = [f"hip_{axis}" for axis in self.hip]
        names += ["knee", *(["knee_second"] if self.mimic else []), *(f"ankle_{axis}" for axis in self.ankle)]
        names += ["toes"] if self.toes else []
        parts = []
        for k, name in enumerate(names):
            shift = np.array(self._shift(name, k, y)) * size
            last = name == names[-1 - self.toes]
            link = f"{side}_foot" if last else f"{side}_{name}" + "_link" * (not self.link_is_joint)
            axis = self.axis.get(name, AXES.get(name.split("_")[-1], AXES["pitch"]))
            limits = self.ranges.get(name, RANGES.get(name, (-0.5, 1.2)))
            kind = "revolute" if name == "toes" else self.kind
            parts.append(self._joint(f"{side}_{name}", parent, link, shift, axis, limits, kind))
            parent = link
        return "".join(parts)

    def _shift(self, name: str, k: int, y: float) -> tuple[float, float, float]:
        if name in self.apart:
            x, across, z = self.apart[name]
            plain = self._plain(name, k, y)
            return plain[0] + x, plain[1] + np.sign(y) * across, plain[2] + z
        return self._plain(name, k, y)

    def _plain(self, name: str, k: int, y: float) -> tuple[float, float, float]:
        if k == 0:
            return 0.0, y, 0.0
        if name == "knee" or name == f"ankle_{self.ankle[0]}":
            return 0.0, 0.0, -0.4
        if name == "knee_second":
            return 0.0, 0.0, -0.02
        return (0.12, 0.0, -0.05) if name == "toes" else (0.0, 0.0, 0.0)

    def _joint(self, name, parent, child, shift, axis, limits, kind) -> str:
        place = " ".join(map(str, shift))
        limit = f'<limit lower="{limits[0]}" upper="{limits[1]}" effort="99" velocity="9"/>'
        follows = f'<mimic joint="{name.removesuffix("_second")}"/>' if name.endswith("_second") else ""
        return (
            f'<link name="{child}"/><joint name="{name}" type="{kind}"><parent link="{parent}"/>'
            f'<child link="{child}"/><origin xyz="{place}"/><axis xyz="{axis}"/>{limit}{follows}</joint>'
        )


ARRANGEMENTS = {
    "plain": Arrangement(),
    "waist first": Arrangement(
        before={"waist_yaw": ("revolute", "0 0 1"), "waist_roll": ("revolute", "1 0 0")}
    ),
    "slides first": Arrangement(before={f"slide_{k}": ("prismatic", "1 0 0") for k in range(6)}),
    "a floating joint first": Arrangement(before={"root": ("floating", "1 0 0")}),
    "one name for link and joint": Arrangement(link_is_joint=True, before={"waist": ("revolute", "0 0 1")}),
    "ankle roll before pitch, straight inside the knee's limits": Arrangement(
        hip=("pitch", "roll", "yaw"),
        ankle=("roll", "pitch"),
        apart={"knee": (0.033, 0, 0), "ankle_roll": (-0.066, 0, 0)},
        ranges={"knee": (0.0, 2.6)},
    ),
    "hyperextending knee": Arrangement(ranges={"knee": (-0.5, 2.3)}),
    "hip axes apart, flexion last": Arrangement(
        apart={"hip_roll": (0, 0, -0.02), "hip_pitch": (0.01, 0, -0.06)}
    ),
    "hip axes apart, flexion first": Arrangement(
        hip=("pitch", "roll", "yaw"), apart={"hip_roll": (0.03, 0.05, -0.04), "hip_yaw": (-0.03, 0, -0.06)}
    ),
    "hip axes far apart": Arrangement(
        apart={"hip_roll": (0.04, 0, -0.03), "hip_pitch": (0, 0.06, -0.05)}, six=False
    ),
    "inclined hip axes": Arrangement(
        hip=("pitch", "roll", "yaw"), axis={"hip_roll": "0.94 0 0.342", "hip_yaw": "-0.342 0 0.94"}
    ),
    "hip yaw inclined by 45 degrees": Arrangement(axis={"hip_yaw": "0 0.7071 0.7071"}),
    "ankle axes apart": Arrangement(apart={"ankle_roll": (0.02, 0, -0.03)}),
    "mimic knee": Arrangement(mimic=True),
    "continuous joints": Arrangement(kind="continuous"),
    "toes": Arrangement(toes=True),
    "axes turned": Arrangement(
        axis={"knee": "0 -1 0", "hip_pitch": "0 -1 0", "hip_yaw": "0 0 -1"},
        ranges={"knee": (-2.3, 0.0), "hip_pitch": (-0.8, 2.0)},
    ),
    "yaw locked by its limits": Arrangement(ranges={"hip_yaw": (0.0, 0.0)}, six=False),
    "no ankle roll": Arrangement(ankle=("pitch",), six=False),
    "no hip yaw": Arrangement(hip=("roll", "pitch"), six=False),
    "narrow ankle": Arrangement(ranges={"ankle_roll": (-0.03, 0.03), "ankle_pitch": (-0.15, 0.2)}, six=False),
    "narrow hip": Arrangement(ranges={"hip_yaw": (-0.02, 0.02)}, six=False),
    "narrow hip roll": Arrangement(ranges={"hip_roll": (-0.03, 0.03)}, six=False),
    "stiff hip": Arrangement(ranges={"hip_pitch": (-0.25, 0.2)}, six=False),
    "knee that bends by 45 degrees": Arrangement(ranges={"knee": (0.0, 0.785)}, six=False),
    "knee that stays bent": Arrangement(ranges={"knee": (0.35, 2.3)}),
}


SIZED = [
    (name, size)
    for k, name in enumerate(ARRANGEMENTS)
    for j, size in enumerate(SIZES.values())
    if name == "plain" or (k + j) % len(SIZES) == 0
]
"""Every arrangement in one of the sizes, the plain one in all: each case takes seconds."""


@pytest.mark.parametrize(("name", "size"), SIZED)
def test_no_joint_jumps_and_what_the_ankles_miss_is_said(name, size):
    made = ARRANGEMENTS[name]
    walk = retarget(GAIT, load_urdf(made.urdf(size)))
    assert [leg.foot for leg in walk.biped.legs] == ["left_foot", "right_foot"]
    q = np.degrees(walk.q[:, [walk.robot.column(joint) for joint in walk.joints]])
    assert np.abs(np.diff(q, axis=0, append=q[:1])).max() <= LARGEST_STEP
    walk.robot.check_limits(walk.q)
    said = " ".join(walk.notes)
    assert walk.errors.largest_position <= PLACED or "off its place" in said
    assert walk.errors.largest_rotation <= np.radians(0.05) or "attitude" in said
    if made.six:
        assert walk.samples_missed == 0
    _check_knees_are_in_front(walk)


def _check_knees_are_in_front(walk):
    """By forward kinematics: the knee lies in front of the line from hip to ankle, in every sample."""
    for leg in walk.biped.legs:
        frames = [
            leg.joints[leg.movements.index("hip_flexion")],
            leg.joints[leg.knee],
            leg.joints[leg.knee + 1],
        ]
        hip, knee, ankle = np.moveaxis(poses(walk.robot, walk.q, frames)[..., :3, 3], 1, 0)
        thigh, line = (points @ walk.biped.rotation for points in (knee - hip, ankle - hip))
        in_front = (thigh - line * (np.sum(thigh * line, axis=1) / np.sum(line**2, axis=1))[:, None])[:, 0]
        assert in_front.min() > 0


@pytest.mark.parametrize("name", ["{side}_arm{k}", "{side}_shoulder_{k}", "arm_{k}_{side}"])
def test_arms_that_hang_lower_than_the_feet_are_not_taken_for_legs(name):
    arms, axes = [], list(AXES.values())
    for side, y in (("left", 0.3), ("right", -0.3)):
        parent = "trunk"
        for k in range(7):
            joint, shift = name.format(side=side, k=k), (0, 0 if k else y, -0.35 if k else 0.4)
            places = parent, f"{joint}_l", shift
            arms.append(Arrangement()._joint(joint, *places, axes[k % 3], (-2, 2), "revolute"))
            parent = f"{joint}_l"
    plain = ARRANGEMENTS["plain"].urdf(1.0)
    robot = load_urdf(plain.replace("</robot>", "".join(arms) + "</robot>"))
    biped = as_biped(Target(robot.name, ""), robot)
    assert [leg.foot for leg in biped.legs] == ["left_foot", "right_foot"]


@pytest.mark.parametrize("name", ["waist first", "slides first", "one name for link and joint", "toes"])
def test_what_comes_before_the_legs_and_after_the_feet_stands_still(name):
    plain = retarget(GAIT, load_urdf(Arrangement().urdf(1.0)))
    walk = retarget(GAIT, load_urdf(ARRANGEMENTS[name].urdf(1.0)))
    assert walk.joints == plain.joints
    columns = [walk.robot.column(joint) for joint in walk.joints]
    assert walk.q[:, columns] == pytest.approx(plain.q, abs=1e-6)
    others = sorted(set(range(walk.robot.nq)) - set(columns))
    assert not walk.q[:, others].any()
    assert any("held as the robot stands" in note for note in walk.notes)


def test_flexion_decides_where_the_hip_is():
    """The legs' reach is thigh and shank, the knee bends as the person's, wherever other axes pass."""
    plain = retarget(GAIT, load_urdf(Arrangement().urdf(1.0)))
    for name in ("hip axes apart, flexion last", "hip axes apart, flexion first"):
        walk = retarget(GAIT, load_urdf(ARRANGEMENTS[name].urdf(1.0)))
        knees = [walk.robot.column(f"{side}_knee") for side in ("left", "right")]
        if name.endswith("last"):
            assert walk.biped.legs[0].reach == pytest.approx(0.8, abs=1e-4)
            assert walk.scale == pytest.approx(plain.scale, abs=1e-4)
        assert (
            np.degrees(np.abs(walk.q - walk.copied)[:, knees]).max() < 3.0
        )  # some mm of the offsets' cosine


def test_both_halves_of_a_mimic_knee_bend_alike():
    walk = retarget(GAIT, load_urdf(ARRANGEMENTS["mimic knee"].urdf(1.0)))
    first, second = (walk.q[:, walk.robot.column(f"left_knee{end}")] for end in ("", "_second"))
    assert second == pytest.approx(first, abs=1e-12)
    assert np.degrees((first + second).max()) == pytest.approx(60, abs=3)
    assert "left_knee_second" not in walk.joints


def test_a_joint_that_follows_one_of_the_other_leg_is_held_with_it():
    text = Arrangement().urdf(1.0)
    own = text.index("</joint>", text.index('name="right_hip_yaw"'))
    walk = retarget(GAIT, load_urdf(text[:own] + '<mimic joint="left_hip_yaw"/>' + text[own:]))
    assert walk.biped.joints_per_leg == 5
    assert not walk.q[:, [walk.robot.column(f"{side}_hip_yaw") for side in ("left", "right")]].any()
    assert sum("hip_yaw" in note and "follows" in note for note in walk.notes) == 2
    assert walk.errors.largest_position <= PLACED


def test_a_lock_in_a_record_is_a_joint_whose_limits_coincide(tmp_path):
    (tmp_path / "mine.urdf").write_text(Arrangement().urdf(1.0), "utf-8")
    record = tmp_path / "mine.toml"
    record.write_text('urdf = "mine.urdf"\nlocked = ["left_hip_yaw", "right_hip_yaw"]\n', "utf-8")
    locked, coincide = (
        retarget(GAIT, record),
        retarget(GAIT, load_urdf(ARRANGEMENTS["yaw locked by its limits"].urdf(1.0))),
    )
    assert locked.joints == coincide.joints
    assert locked.q == pytest.approx(coincide.q, abs=1e-6)
    assert np.degrees(locked.errors.largest_rotation) == pytest.approx(4.15, abs=0.1)  # as a person's hip yaw


def test_knees_that_bend_forward_alone_are_a_bird_s_and_said_so():
    text = Arrangement(ranges={"knee": (-2.3, 0.1), "hip_pitch": (-2, 2), "ankle_pitch": (-2, 2)}).urdf(1.0)
    walk = retarget(GAIT, load_urdf(text))
    assert walk.errors.largest_position <= PLACED
    assert walk.q[:, walk.robot.column("left_knee")].max() < 0
    assert np.degrees(walk.largest_steps.max()) <= LARGEST_STEP
    assert any("bird" in note for note in walk.notes)


def test_one_knee_that_bends_the_other_way_is_refused_with_its_limits():
    text = Arrangement().urdf(1.0).replace('lower="0.0" upper="2.3"', 'lower="-2.3" upper="0.1"', 1)
    with pytest.raises(DescriptionError, match=r"left_knee.* 5\.7 deg backward only .*-131\.8 \.\. 5\.7"):
        retarget(GAIT, load_urdf(text))


def test_a_leg_of_more_parts_than_a_person_s_is_refused_until_a_joint_is_locked(tmp_path):
    """As a bird's: below the knee a long part, and another one below that."""
    text = Arrangement(toes=True, apart={"toes": (-0.2, 0, -0.25)}).urdf(1.0)
    (tmp_path / "mine.urdf").write_text(text, "utf-8")
    with pytest.raises(DescriptionError, match=r"left_ankle_pitch and left_toes .*locked"):
        retarget(GAIT, tmp_path / "mine.urdf")
    record = tmp_path / "mine.toml"
    record.write_text('urdf = "mine.urdf"\nlocked = ["left_toes", "right_toes"]\n', "utf-8")
    assert retarget(GAIT, record).samples_missed == 0


def test_arms_that_walk_are_named():
    text = Arrangement().urdf(1.0)
    for leg, arm in (("hip", "shoulder"), ("knee", "elbow"), ("ankle", "wrist"), ("foot", "hand")):
        text = text.replace(f"_{leg}", f"_{arm}")
    notes = retarget(GAIT, load_urdf(text)).notes
    assert any("left_shoulder_yaw" in note and "arm" in note for note in notes)
    assert not any("arm's" in note for note in retarget(GAIT, load_urdf(Arrangement().urdf(1.0))).notes)


def test_speeds_are_set_against_the_file_s_limits():
    text = Arrangement().urdf(1.0).replace('velocity="9"', 'velocity="2.5"')
    walk = retarget(GAIT, load_urdf(text))
    knee = walk.limit_use["left_knee"].speed
    assert knee.peak == pytest.approx(np.abs(GAIT.dq).max(), rel=0.02)  # the person's, on straight legs
    assert knee.use == pytest.approx(knee.peak / 2.5)
    (note,) = [note for note in walk.notes if "speed limits" in note]
    assert "left_knee" in note
    assert "left_hip_yaw" not in note
    plain = retarget(GAIT, load_urdf(Arrangement().urdf(1.0)))
    assert not any("speed limits" in note for note in plain.notes)


@pytest.mark.parametrize("name", ["yaw locked by its limits", "continuous joints", "narrow ankle"])
def test_json_holds_no_value_that_is_not_json(name, tmp_path, capsys):
    path = tmp_path / "mine.urdf"
    path.write_text(ARRANGEMENTS[name].urdf(1.0).replace('velocity="9"', 'velocity="0"'), "utf-8")
    main(["retarget", "--robot", str(path), "--json"])
    facts = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    knee = facts["joints"]["left_knee"]
    assert knee["movement"] == "knee_flexion"
    assert knee["speed_limit_rad_per_s"] is None
    assert knee["speed_rad_per_s"] > 5
    assert facts["notes"]


def test_table_and_notes_reach_the_terminal(tmp_path, capsys):
    path = tmp_path / "mine.urdf"
    path.write_text(ARRANGEMENTS["waist first"].urdf(1.0), "utf-8")
    assert main(["retarget", "--robot", str(path)]) == 0
    said = capsys.readouterr()
    assert "note: held as the robot stands: waist_yaw, waist_roll" in said.err
    assert "speed" in said.out
    assert "knee flexion" in said.out


def test_more_limbs_than_two_are_told_apart_by_the_words_in_their_names():
    """Two arms that hang as low as the feet."""
    legs = Arrangement().urdf(1.0)
    arms = legs[legs.index("<link name=") + len('<link name="trunk"/>') : legs.index("</robot>")]
    for leg, arm in (("hip", "shoulder"), ("knee", "elbow"), ("ankle", "wrist"), ("foot", "hand")):
        arms = arms.replace(f"_{leg}", f"_{arm}")
    arms = arms.replace('xyz="0.0 0.1 0.0"', 'xyz="0.0 0.3 0.0"').replace(
        'xyz="0.0 -0.1 0.0"', 'xyz="0 -0.3 0"'
    )
    both = legs.replace("</robot>", arms + "</robot>")
    assert [leg.foot for leg in load_biped(both).legs] == ["left_foot", "right_foot"]


def load_biped(text):
    return retarget(GAIT.resampled(4), load_urdf(text)).biped


@pytest.mark.parametrize("up", ["y", "-z", "x"])
def test_any_axis_of_the_root_may_point_up(up):
    turns = {"y": "-1.5707963267948966 0 0", "-z": "3.141592653589793 0 0", "x": "0 1.5707963267948966 0"}
    text = (
        Arrangement()
        .urdf(1.0)
        .replace(
            '<link name="trunk"/>',
            '<link name="root"/><link name="trunk"/><joint name="mount" type="fixed"><parent link="root"/>'
            f'<child link="trunk"/><origin rpy="{turns[up]}"/></joint>',
        )
    )
    biped = load_biped(text)
    assert biped.legs[0].foot == "left_foot"
    assert biped.legs[0].hip[2] - biped.legs[0].ankle[2] == pytest.approx(0.8, abs=1e-6)


def test_a_robot_without_masses_walks_without_a_centre_of_mass():
    made = viewer.retargeted(retarget(GAIT, load_urdf(Arrangement().urdf(1.0))))
    assert "com" not in made.arrays
    assert "Centre of mass" not in [group.title for group in made.facts.groups]
    assert any("no masses" in note for note in made.facts.notes)


def test_what_needs_an_exoskeleton_refuses_another_robot_for_that_reason():
    robot = load_urdf(Arrangement().urdf(1.0))
    with pytest.raises(DescriptionError, match=r"no joint 'left_hip_flexion'.*retarget"):
        robot.from_gait(GAIT)
    with pytest.raises(DescriptionError, match="no link of its URDF has a mass"):
        center_of_mass(robot, np.zeros(robot.nq))
    with pytest.raises(DescriptionError, match="no device of this package"):
        nearest(robot, np.zeros((1, robot.nq)))


def test_legs_of_two_joints_are_refused_for_their_number():
    both = {"hip_yaw": (0.0, 0.0), "hip_roll": (0.0, 0.0)}
    robot = load_urdf(Arrangement(ankle=("roll",), ranges=both | {"ankle_roll": (0.0, 0.0)}).urdf(1.0))
    with pytest.raises(DescriptionError, match="3 moving joints or more"):
        as_biped(Target(robot.name, ""), robot)
