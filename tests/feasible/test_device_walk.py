"""One answer to a walk for every command: three grades, the smallest concession, the same numbers."""

import base64
import dataclasses
import gzip
import json
import re
import struct
from html import unescape

import numpy as np
import pytest

from exo_pin.anatomy import FEET, JOINTS, Body
from exo_pin.cli import main
from exo_pin.compare import Conditions, compare, dressed
from exo_pin.devices import DEVICES
from exo_pin.feasible import device_walk, feasible, pelvis_by_default
from exo_pin.formats import load_gait, save_gait
from exo_pin.gait import Gait, normative_gait
from exo_pin.ground import place_walk
from exo_pin.kinematics import poses, spatiotemporal, with_events
from exo_pin.robot import load_robot

KNEE = JOINTS.index("left_knee_flexion")
CASES = [("free", "lokomat"), ("very_fast", "lokomat"), ("slow", "h2")]


@pytest.fixture
def subject01(shared):
    return shared / "opensim_subject01_walk" / "subject01_walk1_ik.mot"


def _json(capsys, *words):
    code = main([*words, "--json"])
    return code, json.loads(capsys.readouterr().out)


def _told(capsys, *words):
    code = main([*words])
    return code, " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize(("walk", "device"), [*CASES, ("subject01", "lokomat"), ("subject01", "exo12")])
def test_feasible_and_check_give_one_verdict_with_the_same_numbers(walk, device, capsys, request):
    name = str(request.getfixturevalue("subject01")) if walk == "subject01" else walk
    code, first = _json(capsys, "feasible", name, "--device", device)
    other, second = _json(capsys, "check", name, "--device", device)
    assert code == other == (1 if first["verdict"] == "no" else 0)
    for key in (
        "verdict",
        "reason",
        "concession",
        "concessions",
        "pelvis",
        "sole_rms_mm",
        "sole_max_mm",
        "belt_m_s",
        "ok",
    ):
        assert first[key] == second[key], key


def test_a_walk_that_every_limit_allows_fits():
    found = device_walk(normative_gait(), "h2")
    assert (found.verdict, found.concession, found.gait) == ("fits", None, found.recorded)
    assert found.loss.rms == compare(normative_gait(), ["h2"]).best[0].rms


@pytest.mark.parametrize(("walk", "device"), [("free", "lokomat"), ("slow", "h2")])
def test_replay_and_report_show_that_verdict_with_the_same_numbers(walk, device, capsys, tmp_path):
    _, facts = _json(capsys, "feasible", walk, "--device", device)
    lost = f"by {facts['sole_rms_mm']:.1f} mm rms, {facts['sole_max_mm']:.1f} mm at most"
    grade = {"fits": "fits: ", "concession": "fits with a concession: ", "no": "does not fit: "}
    verdict = grade[facts["verdict"]] + facts["reason"]
    page, report = tmp_path / "walk.html", tmp_path / "report.html"
    for words in (["replay", walk, "--html", str(page)], ["report", walk, "--no-player", "-o", str(report)]):
        code, said = _told(capsys, *words, "--device", device)
        assert code == 0
        assert lost in said
        assert verdict in said
    shown = _page_facts(page)
    notes = " ".join(shown["notes"])
    assert lost in notes
    assert verdict in notes
    text = unescape(report.read_text(encoding="utf-8"))
    assert lost in text
    assert verdict in text
    if facts["belt_m_s"] is not None:
        assert shown["marks"]["belt"]["speed"] == pytest.approx(facts["belt_m_s"], abs=1e-6)
    assert not any(note.startswith("Warning: the belt") for note in shown["notes"])


def _page_facts(page):
    """The facts of an offline page: the first chunk of the bundle, the only gzip that starts with JSON."""
    for word in re.findall(r"H4sI[A-Za-z0-9+/=]+", page.read_text(encoding="utf-8")):
        data = gzip.decompress(base64.b64decode(word))
        (size,) = struct.unpack_from("<I", data)
        if data[4:5] == b"{":
            return json.loads(data[4 : 4 + size])
    raise AssertionError("no bundle in the page")


def test_a_belt_that_is_too_slow_costs_cadence_and_the_slower_walk_fits(capsys, tmp_path):
    found = device_walk(normative_gait(), "lokomat")
    factor = found.concession.how_much
    assert (found.concession.what, found.concession.unit) == ("cadence", "times")
    assert found.gait.duration == pytest.approx(normative_gait().duration / factor)
    assert device_walk(found.gait, "lokomat").verdict == "fits"
    out = tmp_path / "fit.csv"
    assert main(["edit", "free", str(out), "--fit", "lokomat"]) == 0
    assert f"cadence {factor:.2f}" in capsys.readouterr().err
    assert load_gait(out).duration == pytest.approx(found.gait.duration, rel=1e-6)


def _shown_belt(gait):
    """The belt under the device's motion as the player places it: of the full robot, by its own poses."""
    motion = compare(gait, ["lokomat"], conditions=Conditions("device")).best[0].motion
    return place_walk(dressed(motion.robot), motion.gait, "still").support.belt_speed


def test_the_slower_walk_is_the_fastest_whose_shown_belt_the_treadmill_can_run():
    given, fastest = normative_gait(), 3.2 / 3.6
    found = device_walk(given, "lokomat")
    speed = float(spatiotemporal(load_robot(), given)["speed"].mean)
    factor = found.concession.how_much
    assert factor < np.floor(100 * fastest / speed) / 100, "the person's speed alone would allow more"
    assert found.belt == pytest.approx(_shown_belt(found.gait), abs=1e-9)
    assert found.belt <= fastest < _shown_belt(given.slowed(1 / (factor + 0.01)))
    assert found.belt_warning == ""


def test_a_walk_whose_person_is_slow_enough_is_slowed_where_the_devices_own_steps_are_too_long():
    given, fastest = normative_gait("slow").slowed(1 / 1.05), 3.2 / 3.6
    assert spatiotemporal(load_robot(), given)["speed"].mean < fastest < _shown_belt(given)
    assert all(fit.ok for fit in feasible(given, "lokomat").fits)
    found = device_walk(given, "lokomat")
    assert (found.verdict, found.concession.what) == ("concession", "cadence")
    assert "the device's own motion takes the belt to" in found.reason
    assert found.belt <= fastest


def test_a_walk_that_cannot_be_slowed_enough_has_a_warning():
    found = device_walk(normative_gait("very_fast"), "lokomat")
    assert found.verdict == "no"
    assert f"the belt runs at {found.belt:.2f} m/s here" in found.belt_warning


def test_edit_judges_the_fitted_walk_on_the_device_that_it_was_fitted_to(tmp_path, capsys):
    """The joints that H2 locks may turn faster than exo12's motors."""
    walk = normative_gait()
    q = walk.q.copy()
    k = JOINTS.index("left_hip_rotation")
    q[:, k] = 0.2 * np.sin(10 * np.pi * walk.time / walk.duration)
    path, fitted = tmp_path / "walk.npz", tmp_path / "fitted.csv"
    save_gait(dataclasses.replace(walk, q=q), path)
    assert main(["edit", str(path), str(fitted), "--fit", "h2"]) == 0
    assert "left_hip_rotation" not in capsys.readouterr().out
    assert main(["edit", str(path), str(tmp_path / "same.csv")]) == 1


def test_too_much_of_a_change_is_no_concession(capsys, tmp_path):
    found = device_walk(normative_gait("very_fast"), "lokomat")
    assert found.verdict == "no"
    assert "treadmill" in found.reason
    out = tmp_path / "none.csv"
    assert main(["edit", "very_fast", str(out), "--fit", "lokomat"]) == 1
    assert "treadmill" in capsys.readouterr().err
    assert not out.exists()


def _hyperextended(by):
    gait = normative_gait("very_slow")
    q = np.array(gait.q)
    q[:, KNEE] -= q[:, KNEE].min() + np.radians(by)
    return dataclasses.replace(gait, q=q)


def test_a_hyperextended_knee_is_held_at_its_stop_and_the_foot_moves():
    gait = _hyperextended(3.0)
    found = device_walk(gait)
    frames = gait.q[:, KNEE] < 0
    assert (found.verdict, found.concession.what, found.concession.unit) == (
        "concession",
        "knee held at its stop",
        "mm",
    )
    assert np.array_equal(found.gait.q[frames, KNEE], np.zeros(frames.sum()))
    kept = np.ones(12, dtype=bool)
    kept[KNEE] = False
    assert np.array_equal(found.gait.q[:, kept], gait.q[:, kept])
    robot = load_robot()
    before, after = (
        poses(robot, robot.from_gait(g), FEET, base=g.base)[:, 0, :3, 3] for g in (gait, found.gait)
    )
    moved = 1e3 * np.linalg.norm(after - before, axis=1)
    assert found.concession.how_much == pytest.approx(moved.max())
    assert f"left foot {moved.max():.1f} mm off in {frames.sum()} frames" in found.reason
    assert "right foot" not in found.reason


def test_events_of_the_kinematics_make_no_other_verdict_than_no_events(subject01):
    """A walk with held knees has other events by its kinematics: 1.09 instead of 1.10 m/s."""
    walk, body, belt = load_gait(subject01), Body.from_stature(1.8), (0.1, 0.9)
    device = dataclasses.replace(DEVICES["exo12"], name="slow_belt", treadmill=belt)
    without, known = (device_walk(gait, device, body) for gait in (walk, with_events(load_robot(body), walk)))
    assert "cadence" in without.reason
    assert without.facts() == known.facts()


def test_a_bent_knee_keeps_the_foot():
    gait = _hyperextended(3.0)
    found = device_walk(gait, knee="bend")
    assert all(concession.what != "knee held at its stop" for concession in found.concessions)
    bent = found.as_recorded.gait
    robot = load_robot()
    feet = [poses(robot, robot.from_gait(g), FEET, base=g.base) for g in (gait, bent)]
    assert feet[1] == pytest.approx(feet[0], abs=1e-8)
    assert bent.q[:, KNEE].min() >= -1e-9


def test_a_joint_far_out_of_range_says_which_where_and_how_far():
    gait = normative_gait()
    q = np.array(gait.q)
    hip = JOINTS.index("left_hip_adduction")
    q[:, hip] += np.radians(60.0)
    found = device_walk(dataclasses.replace(gait, q=q))
    assert found.verdict == "no"
    excess = np.degrees(q[:, hip].max()) - 30.0
    assert f"left_hip_adduction: outside its range (by {excess:.1f} deg)" in found.reason
    assert "stance" in found.reason
    assert found.gait is found.recorded


def test_too_large_a_movement_costs_amplitude():
    gait = normative_gait("slow")
    q = np.array(gait.q)
    mean = q[:, KNEE].mean() + np.radians(20.0)
    q[:, KNEE] = mean + 3.0 * (q[:, KNEE] - q[:, KNEE].mean())
    found = device_walk(Gait(gait.time, np.where(q < 0, 0, q), base=gait.base, periodic=True))
    assert found.verdict in ("concession", "no")
    if found.concession is not None:
        assert found.concession.how_much < 1
        assert not feasible(found.gait).failures


@pytest.mark.parametrize("name", DEVICES)
def test_a_stand_with_slides_holds_the_pelvis_itself(name):
    device = DEVICES[name]
    assert pelvis_by_default(device) == ("device" if device.slides else "recorded")
    assert device_walk(normative_gait("slow"), name).conditions == Conditions(pelvis_by_default(device))


def test_the_words_of_both_commands_hold_verdict_reason_and_loss(capsys):
    found = device_walk(normative_gait(), "lokomat")
    for command in ("feasible", "check"):
        code, said = _told(capsys, command, "free", "--device", "lokomat")
        assert code == 0
        assert found.sentence in said
        assert found.loss_sentence in said


@pytest.mark.parametrize(
    ("device", "person", "word"),
    [
        ("h2", {"mass": 110.0}, "mass 110.00 kg"),
        ("hk4", {"mass": 120.0}, "mass 120.00 kg"),
        ("hk4", {"stature": 1.95}, "stature 1.95 m"),
        ("h2", {"stature": 1.40}, "stature 1.40 m"),
    ],
)
def test_a_person_beyond_a_source_s_range_does_not_fit_and_the_size_is_named(device, person, word):
    from exo_pin.anatomy import Body

    found = device_walk(normative_gait(), device, Body.from_stature(**person))
    assert found.verdict == "no"
    assert word in found.reason
    inside = device_walk(normative_gait(), device, Body.from_stature(mass=99.0))
    assert not [fit for fit in inside.as_recorded.fits if not fit.ok]


def test_feasible_says_one_largest_cadence_and_why_there_is_none(capsys):
    code, said = _told(capsys, "feasible", "free", "--device", "lokomat", "--json")
    told = json.loads(said)
    assert (code, told["verdict"], told["concession"]["what"]) == (0, "concession", "cadence")
    assert told["largest_cadence_factor"] == told["concession"]["how_much"]
    code, said = _told(capsys, "feasible", "free", "--device", "hk4", "--stature", "1.95")
    assert code == 1
    assert "possible: no walk of this person" in said
    code, said = _told(capsys, "feasible", "very_fast", "--device", "lokomat")
    assert code == 1
    assert "times the cadence" in said
    assert "less than the 0.5 that counts as a concession" in said


def test_every_size_with_a_range_is_judged_and_uneven_legs_side_by_side():
    from exo_pin.anatomy import Body
    from exo_pin.devices import Device, both
    from exo_pin.feasible.device_fit import fits
    from exo_pin.robot import load_robot

    narrow = Device(
        name="narrow", joints=both("knee_flexion"), source="made up", thighs=(0.40, 0.43), shanks=(0.5, 0.6),
        hip_breadths=(0.1, 0.3), masses=(50.0, 60.0),
    )  # fmt: skip
    robot = load_robot(Body.from_stature(left_thigh=0.38), device=narrow)
    bad = {fit.of for fit in fits(robot, normative_gait()) if not fit.ok}
    assert bad == {"left thigh", "shank", "hip breadth", "mass"}


@pytest.mark.parametrize(("shorter", "remarked"), [(0.0, False), (0.003, False), (0.012, True)])
def test_a_leg_difference_is_remarked_on(shorter, remarked):
    from exo_pin.anatomy import Body

    body = Body.from_stature(right_shank=Body.from_stature().right_shank - shorter)
    words = " ".join(device_walk(normative_gait(), "exo12", body).as_recorded.conditions)
    assert ("legs differ by 12 mm" in words) is remarked
