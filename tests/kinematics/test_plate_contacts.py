"""Force plates and spatiotemporal numbers of whole walks."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from exo_pin.anatomy import SIDES, Body
from exo_pin.errors import FormatError, GaitError
from exo_pin.formats import ForcePlate, load_forces, load_gait, load_markers
from exo_pin.gait import Gait, force_plates, normative_gait
from exo_pin.kinematics import events, plate_events, poses, spatiotemporal, with_plates
from exo_pin.robot import load_robot

FRAMES = 0.033  # [s] two frames of 60 Hz: what kinematics may differ from force plates
PLATE = 0.003  # [s] two samples of the plate at 600 Hz
SUBJECT = "opensim_subject01_walk/subject01_walk1"
STATED = {  # the data's README: events from the plates at 20 N [s]
    ("heel_strike", "right"): [0.618, 1.853],
    ("toe_off", "right"): [0.165, 1.410],
    ("heel_strike", "left"): [1.247, 2.460],
    ("toe_off", "left"): [0.788, 2.018],
}


def times(found, kind, side):
    return [event.time for event in found if (event.kind, event.side) == (kind, side)]


def test_the_normal_walk_has_the_numbers_of_its_source(robot):
    walk = normative_gait("free")
    numbers = spatiotemporal(robot, walk)
    assert numbers["stride_time"].mean == pytest.approx(walk.duration)
    assert numbers["left_stance"].mean == pytest.approx(59, abs=2)  # Schwartz 2008: toe-off at 59 %
    assert 1.1 < numbers["speed"].mean < 1.4
    assert set(numbers) > {"cadence", "double_support", "step_width", "step_length_symmetry"}


def test_taller_legs_walk_further_by_their_length(robot):
    walk = normative_gait("free")
    tall = load_robot(Body.from_stature(1.95))
    ratio = tall.body.leg_length / robot.body.leg_length
    short_, long_ = (
        spatiotemporal(r, Gait(walk.time, walk.q, events=walk.events, periodic=True)) for r in (robot, tall)
    )
    assert long_["stride_length"].mean / short_["stride_length"].mean == pytest.approx(ratio, rel=0.02)


def plate_under(robot, walk, k, times_on):
    """A plate that one foot stands on in that span of time."""
    t = np.linspace(walk.time[0], walk.time[-1], 2000)
    foot = poses(robot, robot.from_gait(walk), base=walk.base)[:, k, :3, 3]
    point = np.stack([np.interp(t, walk.time, foot[:, axis]) for axis in range(3)], axis=1)
    force = np.zeros((len(t), 3))
    force[(t > times_on[0]) & (t < times_on[1]), 2] = 700
    return ForcePlate("force plate 1", t, force, point, np.zeros((len(t), 3)))


@pytest.mark.parametrize(("k", "side"), [(0, "left"), (1, "right")])
def test_a_force_belongs_to_the_foot_above_it(robot, k, side):
    walk = normative_gait("free")
    found = plate_events(robot, walk, [plate_under(robot, walk, k, (0.2, 0.6))])
    assert [(e.kind, e.side, e.source) for e in found] == [
        ("heel_strike", side, "force plate"),
        ("toe_off", side, "force plate"),
    ]
    assert [e.time for e in found] == pytest.approx([0.2, 0.6], abs=1e-3)


def test_a_force_that_is_nobodys_gives_no_event(robot):
    walk = normative_gait("free")
    plate = plate_under(robot, walk, 0, (0.2, 0.6))
    far = dataclasses.replace(plate, point=plate.point + np.array([0, 3, 0]))
    with pytest.raises(GaitError, match="no contact of a foot"):
        plate_events(robot, walk, [far])
    with pytest.raises(GaitError, match="does not move in the world"):
        plate_events(robot, Gait(walk.time, walk.q), [plate])


def test_samples_without_force_do_not_change_whose_contact_it_is(robot):
    """Where nothing presses, the centre of pressure is not a number."""
    walk = normative_gait("free")
    plate = plate_under(robot, walk, 1, (0.2, 0.6))
    point, force = plate.point.copy(), plate.force.copy()
    gap = (plate.time > 0.4) & (plate.time < 0.403)
    force[gap], point[force[:, 2] == 0] = 0, np.nan
    found = plate_events(robot, walk, [dataclasses.replace(plate, point=point, force=force)])
    assert {e.side for e in found} == {"right"}
    assert [e.time for e in found] == pytest.approx([0.2, 0.6], abs=1e-3)
    with pytest.raises(GaitError, match="no contact of a foot"):
        plate_events(robot, walk, [dataclasses.replace(plate, point=np.full_like(point, np.nan))])


def test_a_plate_that_two_feet_load_gives_no_event_and_that_is_stated(robot):
    walk = normative_gait("free").repeated(2)
    alone = plate_under(robot, walk, 0, (0.0, 0.6))
    first, second = plate_under(robot, walk, 1, (0.55, 1.2)), plate_under(robot, walk, 0, (1.2, 1.6))
    later = (first.time > 1.2)[:, None]
    moved = dataclasses.replace(first, force=first.force + second.force)
    for point in (np.where(later, second.point, first.point), np.broadcast_to(first.point[800], (2000, 3))):
        shared_plate = dataclasses.replace(moved, point=point)
        with pytest.raises(GaitError, match="both feet load it"):
            plate_events(robot, walk, [shared_plate])
        found = with_plates(robot, walk, [shared_plate, alone])
        assert len(found.remarks) == 1
        assert "both feet load it" in found.remarks[0]


def test_contacts_with_the_same_reason_share_one_remark(robot):
    walk = normative_gait("free").repeated(2)
    alone = plate_under(robot, walk, 0, (0.0, 0.6))
    far = [plate_under(robot, walk, 1, times) for times in ((0.55, 1.2), (1.5, 1.8))]
    far = [dataclasses.replace(plate, point=plate.point + np.array([0.0, 5.0, 0.0])) for plate in far]
    (remark,) = with_plates(robot, walk, [alone, *far]).remarks
    assert remark.count("no foot is there") == 1
    assert remark.count(" .. ") == 2


@pytest.mark.parametrize(("length", "counted"), [(0.01, 0), (0.04, 1), (0.3, 1)])
def test_a_contact_that_the_recording_cuts_off_has_its_strike_or_toe_off(length, counted):
    t = np.arange(0, 2, 1e-3)
    ends = force_plates.contacts(t, np.where(t > 2 - length, 500.0, 0.0))
    begins = force_plates.contacts(t, np.where(t < length, 500.0, 0.0))
    assert [(c.strike is not None, c.off) for c in ends] == [(True, None)] * counted
    assert [(c.strike, c.off is not None) for c in begins] == [(None, True)] * counted


def test_events_of_the_recording_agree_with_the_force_plates(shared):
    robot = load_robot(Body.from_stature(1.78, mass=72.6))
    gait = load_gait(shared / f"{SUBJECT}_ik_full_opensim46.mot")
    measured = plate_events(robot, gait, load_forces(shared / f"{SUBJECT}_grf.mot"))
    kinematic = events(robot, gait)
    for key, stated in STATED.items():
        ours = times(measured, *key)
        assert ours == pytest.approx(stated[: len(ours)], abs=PLATE)
        for t in ours:
            assert min(abs(t - x) for x in times(kinematic, *key)) <= FRAMES, key
    assert len(measured) == 8  # with the left strike at 2.460 s, whose contact the recording's end cuts off


def recorded(shared, name):
    """A walk without events, whose legs they are, and the force plates."""
    if name == "subject01":
        file = shared / f"{SUBJECT}_ik_full_opensim46.mot"
        return Body.from_stature(1.78), load_gait(file), load_forces(shared / f"{SUBJECT}_grf.mot")
    if name == "HC036A":
        file = shared / "c3d_pig_walk_HC036A/HC036A10_walk.c3d"
        gait = dataclasses.replace(load_gait(file), events=())
        return Body.from_stature(1.34), gait, load_forces(file)
    folder = shared.parent / "trials/lai_arnold_walk"
    gait = load_gait(folder / "walking1_ik.mot", model=folder / "scaled.osim")
    return Body.from_stature(1.75), gait, load_forces(folder / "walking1_forces.mot")


@pytest.mark.parametrize(("name", "contacts"), [("subject01", 8), ("HC036A", 4), ("Lai-Arnold", 4)])
def test_events_of_kinematics_lie_within_two_frames_of_the_plates(shared, name, contacts):
    body, gait, plates = recorded(shared, name)
    robot = load_robot(body)
    known, measured = events(robot, gait), plate_events(robot, gait, plates)
    assert len(measured) == contacts
    for event in measured:
        near = min(abs(event.time - t) for t in times(known, event.kind, event.side))
        assert near <= FRAMES, (name, event)


def test_events_of_the_childs_plates_agree_with_those_of_the_file(shared):
    path = shared / "c3d_pig_walk_HC036A/HC036A10_walk.c3d"
    gait, trial = load_gait(path), load_markers(path)
    found = plate_events(load_robot(Body.from_stature(1.34, mass=33)), gait, trial.plates)
    assert len(found) == 4
    for event in found:
        assert min(abs(event.time - t) for t in times(gait.events, event.kind, event.side)) < 0.011  # a frame


def test_plates_correct_the_events_that_they_saw_and_leave_the_others(shared):
    """Without its own events the child's trial gets four from the plates, the rest by kinematics."""
    path = shared / "c3d_pig_walk_HC036A/HC036A10_walk.c3d"
    stated, trial = load_gait(path), load_markers(path)
    robot = load_robot(Body.from_stature(1.34, mass=33))
    bare = dataclasses.replace(stated, events=())
    found = with_plates(robot, bare, trial.plates)
    measured = [e for e in found.events if e.source == force_plates.FORCE_PLATE]
    assert len(measured) == 4
    assert len(found.events) == len(events(robot, bare))  # corrected, none twice
    strides = [np.diff(times(w.events, "heel_strike", side)) for w in (found, stated) for side in SIDES]
    assert np.ravel(strides[:2]) == pytest.approx(np.ravel(strides[2:]), abs=0.03)  # plates beside kinematics
    for event in measured:
        near = [e for e in stated.events if (e.side, e.kind) == (event.side, event.kind)]
        assert min(abs(event.time - e.time) for e in near) < 0.011  # a frame


def test_stepping_on_a_plate_is_no_walk(robot):
    """No event is made where there is no gait."""
    walk = normative_gait("free").repeated(2)
    still = Gait(walk.time, 0 * walk.q, base=np.tile(walk.base[0], (len(walk), 1, 1)))
    plate = plate_under(robot, still, 0, (0.2, 0.6))
    assert plate_events(robot, still, [plate])
    assert with_plates(robot, still, [plate]).events == ()


def test_files_without_forces_are_refused(shared):
    for name in ("_ik.mot", "_id.sto"):
        with pytest.raises(FormatError, match="no ground reaction forces"):
            load_forces(shared / f"{SUBJECT}{name}")


@pytest.mark.parametrize(
    "style",
    [
        "ground_force_{w}{a}|ground_torque_{a}",
        "1_ground_force_{w}{a}|1_ground_torque_{a}",
        "ground_force_r_{w}{a}|ground_moment_r_m{a}",
    ],
)
def test_three_styles_of_names_are_understood(tmp_path, style):
    force, torque = style.split("|")
    names = [force.format(w=w, a=a) for w in "vp" for a in "xyz"] + [torque.format(a=a) for a in "xyz"]
    rows = [[t, *range(1, 10)] for t in (0.0, 0.1)]
    lines = ["grf", "nRows=2", "nColumns=10", "endheader", "\t".join(["time", *names])]
    path = tmp_path / "grf.mot"
    path.write_text("\n".join([*lines, *("\t".join(map(str, row)) for row in rows), ""]))
    (plate,) = load_forces(path)
    np.testing.assert_array_equal(plate.force[0], [1, -3, 2])  # y up becomes z up
    np.testing.assert_array_equal(plate.point[0], [4, -6, 5])
    np.testing.assert_array_equal(plate.moment[0], [7, -9, 8])
