"""Reports and reproduced figures: complete, equal to what other rooms compute, escaped, self-contained."""

from __future__ import annotations

import re
from dataclasses import replace
from html import unescape
from html.parser import HTMLParser
from xml.etree import ElementTree

import numpy as np
import pytest

from exo_pin import cli, crosscheck, report
from exo_pin.anatomy import JOINTS
from exo_pin.clinic import published_band
from exo_pin.demand import ACCELERATION_LIMIT, range_demands
from exo_pin.errors import DescriptionError
from exo_pin.feasible import device_walk
from exo_pin.gait import Gait, Torques, normative_gait, normative_sd
from exo_pin.gait.heading import turned
from exo_pin.kinematics import (
    center_of_mass,
    spatiotemporal,
    walk_numbers,
)
from exo_pin.report.document import blocks
from exo_pin.report.draw import skeleton
from exo_pin.report.sections import fact_tables
from exo_pin.robot import load_robot, load_urdf

EVIL = '<script>alert("x")</script>&'
VOID = {"meta", "link", "img", "br", "input"}
DRAWN = 0.03  # [px] numbers in drawings have two decimals
PRINTED = 5e-2  # [deg] tables show one decimal


@pytest.fixture(scope="module")
def document(robot, gait):
    info = report.ReportInfo(title=EVIL, who=EVIL, what="free", when="today", choices={EVIL: EVIL})
    return report.walk(robot, gait, info=info, player=f"<!DOCTYPE html><p title='{EVIL}'>player</p>")


@pytest.fixture(scope="module")
def page(document):
    return report.html(document)


@pytest.fixture(scope="module")
def paper(robot, gait, recording):
    return report.reproduction(robot, gait, recording=recording, recording_name=EVIL, when="today")


class Reader(HTMLParser):
    """Collects elements, checks that they nest."""

    def __init__(self, text):
        super().__init__()
        self.open, self.seen = [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.seen.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.seen.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def elements(drawing, name):
    return list(ElementTree.fromstring(drawing).iter(f"{{http://www.w3.org/2000/svg}}{name}"))


def section(document, title):
    return next(s for s in document.sections if s.title == title)


def table(document, title, number=0):
    tables = [b for b in section(document, title).blocks if isinstance(b, blocks.Table)]
    return {row[0]: list(row[1:]) for row in tables[number].rows}


def test_the_report_has_every_section(document):
    assert [s.title for s in document.sections] == [
        "Who and what",
        "Four numbers",
        "Joint angles over the gait cycle",
        "The walk in 3-D",
        "Pelvis, knee and foot progression",
        "Gait Profile Score",
        "Spatiotemporal numbers",
        "Appendix: how far to trust the numbers",
        "Body",
        "Device",
        "Ranges and limit margins",
        "Velocities and accelerations",
        "Paths of the feet",
        "Centre of mass",
        "Feet on the ground",
        "Inverse kinematics",
        "Cross-checks",
        "Choices",
    ]


def test_ranges_are_those_of_the_cross_check(document, robot, gait):
    rows = table(document, "Ranges and limit margins")
    assert tuple(rows) == JOINTS
    for k, (joint, demand) in enumerate(range_demands(robot, robot.from_gait(gait)).items()):
        *numbers, outside = rows[joint]
        lower, upper = robot.lower[k], robot.upper[k]
        low, high, frames = demand.lowest, demand.highest, demand.samples_outside
        expected = np.degrees([low, high, high - low, lower, upper, min(low - lower, upper - high)])
        np.testing.assert_allclose([float(x) for x in numbers], expected, atol=PRINTED)
        assert outside == (str(frames) if frames else "-")


def test_rates_are_the_gaits_own_derivatives(document, robot, gait):
    rows = table(document, "Velocities and accelerations")
    for k, joint in enumerate(JOINTS):
        speed, degrees, has, used, change, hardest, share = (float(x) for x in rows[joint])
        peak = np.abs(gait.dq[:, k]).max()
        assert speed == pytest.approx(peak, abs=5e-3)
        assert degrees == pytest.approx(np.degrees(peak), abs=0.5)
        assert (has, hardest) == (robot.velocity[k], ACCELERATION_LIMIT)
        assert used == pytest.approx(100 * peak / robot.velocity[k], abs=0.5)
        assert change == pytest.approx(np.abs(gait.ddq[:, k]).max(), abs=PRINTED)
        assert share == pytest.approx(100 * change / hardest, abs=0.6)


def test_torques_are_shown_before_the_actuators_when_they_are_given(robot, gait, document):
    tau = np.full((30, 12), np.nan)
    time = np.linspace(0.2, 0.8, 30)
    tau[:, 3] = 200 * np.sin(8 * time)
    torques = Torques(time, tau, source=EVIL)
    shown = report.walk(robot, gait, torques=torques)
    (row,) = table(shown, "Torques").items()
    given = torques.at(gait.time)[:, 3]
    low, high, share, has, used, beyond = row[1]
    assert row[0] == "left_knee_flexion"
    assert float(low) == pytest.approx(np.nanmin(given), abs=PRINTED)
    assert float(high) == pytest.approx(np.nanmax(given), abs=PRINTED)
    assert float(share) == pytest.approx(np.nanmax(np.abs(given)) / robot.body.mass, abs=5e-3)
    assert float(has) == robot.effort[3]
    assert int(beyond) == (np.abs(given) > robot.effort[3]).sum()
    assert float(used) == pytest.approx(100 * np.nanmax(np.abs(given)) / robot.effort[3], abs=0.5)
    (figure,) = [b for b in section(shown, "Torques").blocks if isinstance(b, blocks.Figure)]
    assert [d.title for d in figure.drawings] == ["Knee flexion torque [N m]"]
    assert EVIL not in report.html(shown)
    assert "Torques" not in [s.title for s in document.sections]


def test_residuals_and_witnesses_are_those_of_the_cross_check(document, robot, gait):
    verdict = crosscheck.check(robot, gait)
    facts = verdict.facts()["ik"]
    rows = table(document, "Inverse kinematics")
    assert rows["frames"][0] == str(len(gait))
    assert rows["frames whose feet were reached"][0] == str(facts["converged"])
    assert rows["largest position error, within limits"] == [f"{facts['max_position_error_m']:.1e}", "m"]
    differences = [row[0] for row in table(document, "Cross-checks").values()]
    assert differences == [f"{value:.1e}" for value in verdict.fk.values()]


def test_spatiotemporal_numbers_are_those_of_the_kinematics(document, robot, gait):
    rows = table(document, "Spatiotemporal numbers")
    found = spatiotemporal(robot, gait)
    assert set(rows) == {name.replace("_", " ") for name in found}
    assert float(rows["speed"][0]) == pytest.approx(found["speed"].mean, abs=5e-4)
    assert all(row[3] == found[name.replace(" ", "_")].unit for name, row in rows.items())


def test_the_centre_of_mass_is_that_of_the_kinematics(document, robot, gait):
    position = center_of_mass(robot, robot.from_gait(gait), base=gait.base).position
    for k, (mean, excursion) in enumerate(table(document, "Centre of mass").values()):
        assert float(mean) == pytest.approx(position[:, k].mean(), abs=5e-4)
        assert float(excursion) == pytest.approx(1e3 * np.ptp(position[:, k]), abs=PRINTED)


def test_every_name_is_text_and_never_markup(page, document):
    seen = Reader(page).seen
    assert [tag for tag, _ in seen if tag == "script"] == []
    assert EVIL not in page
    assert page.count("&lt;script&gt;") >= 4
    assert "<script>" not in report.markdown(document)


def test_the_player_is_embedded_whole_and_fenced_off(page):
    (frame,) = [attributes for tag, attributes in Reader(page).seen if tag == "iframe"]
    assert frame["srcdoc"] == f"<!DOCTYPE html><p title='{EVIL}'>player</p>"
    assert "allow-same-origin" not in frame["sandbox"]


def test_a_still_takes_the_players_place_on_paper():
    document = blocks.Document("t", "", (blocks.Section("s", (blocks.Player("<p>", EVIL, b"png"),)),))
    (image,) = [a for tag, a in Reader(report.html(document)).seen if tag == "img"]
    assert image == {"class": "paper", "alt": EVIL, "src": "data:image/png;base64,cG5n"}


def test_nothing_is_loaded_from_elsewhere(page, paper):
    for text in (page, report.html(paper)):
        reader = Reader(text)
        assert reader.open == []
        policy = next(
            a["content"] for _, a in reader.seen if a.get("http-equiv") == "Content-Security-Policy"
        )
        assert "default-src 'none'" in policy
        assert not re.search(r"https?:", policy)
        for _, attributes in reader.seen:
            for name in ("src", "href", "xlink:href", "action"):
                assert attributes.get(name, "data:").startswith("data:")
        assert "url(http" not in text
        assert "@import" not in text


def test_equal_input_gives_equal_bytes(robot, gait, paper, recording):
    again = report.reproduction(robot, gait, recording=recording, recording_name=EVIL, when="today")
    assert report.html(again) == report.html(paper)
    assert report.markdown(again) == report.markdown(paper)


def test_every_drawing_is_well_formed_and_has_a_name_of_its_own(document, paper):
    for drawings in (document.drawings, paper.drawings):
        assert len({d.file for d in drawings}) == len(drawings)
        for drawing in drawings:
            root = ElementTree.fromstring(drawing.svg)
            assert root.tag == "{http://www.w3.org/2000/svg}svg"
            assert "nan" not in drawing.svg
            assert "inf" not in re.sub(r"[a-z]*inf[a-z]+|[a-z]+inf", "", drawing.svg)


def test_a_recording_without_events_says_so_and_still_gives_a_report(robot, recording):
    document = report.walk(robot, replace(recording, events=()), normal=None)
    text = unescape(report.html(document))
    assert "No events: contact is unknown." in text
    assert "no heel strikes" in text
    assert "Butterworth, order 4, zero lag, 6 Hz" in text


def test_the_filter_is_stated_when_it_is_off_or_refuses(robot, recording):
    assert "not filtered" in report.html(report.walk(robot, recording, cutoff=None))
    assert "the filter refused" in report.html(report.walk(robot, recording, cutoff=500.0))


def test_a_device_with_locked_joints_and_slides_has_a_report():
    robot = load_robot(device="lopes8")
    document = report.walk(robot, normative_gait())
    assert set(table(document, "Ranges and limit margins")) == set(robot.joints) & set(JOINTS)


def test_the_persons_walk_is_drawn_solid_and_the_devices_dashed(monkeypatch, tmp_path):
    """On one axis the dashed curve is above the solid one by what the angles are, at every percent."""
    made = []

    def kept(document):
        made.append(document)
        return ""

    monkeypatch.setattr(report, "html", kept)
    words = ["report", "slow", "--device", "lokomat", "--normal", "none", "--no-player", "--no-forces"]
    assert cli.main([*words, "-o", str(tmp_path / "page.html")]) == 0
    answer = device_walk(normative_gait("slow"), "lokomat")
    device, person = answer.loss.motion.gait, normative_gait("slow")
    drawings = section(made[0], "Joint angles over the gait cycle").blocks[0].drawings
    for movement in ("hip_flexion", "knee_flexion"):
        column = JOINTS.index(f"left_{movement}")
        dashed, solid = _drawn(next(d.svg for d in drawings if d.name == f"curve_{movement}"))
        assert len(dashed) == len(solid) == 2, "both legs of each"
        angles = [np.degrees(walk.q[:, column]) for walk in (device, person)]
        apart = angles[1] - angles[0]
        assert np.abs(apart).max() > 1.0, "else the curves do not tell whose they are"
        heights = [-curves[0][: len(apart), 1] for curves in (dashed, solid)]  # y is down; left leg first
        scale = np.ptp(heights[1]) / np.ptp(angles[1])  # [px/deg]
        np.testing.assert_allclose(heights[1] - heights[0], scale * apart, atol=DRAWN)


def test_a_report_with_its_player_prints_the_devices_answer_once(capsys, tmp_path):
    assert cli.main(["report", "free", "-o", str(tmp_path / "page.html")]) == 0
    answer = device_walk(normative_gait())
    printed = capsys.readouterr().out.splitlines()
    assert [printed.count(line) for line in (answer.sentence, answer.loss_sentence)] == [1, 1]


def _drawn(drawing):
    """The dashed and the solid curves of a chart, `(n, 2)` [px], without axes, limits and legend."""
    dashed, solid = [], []
    for path in elements(drawing, "path"):
        numbers = np.array(re.findall(r"-?\d+\.?\d*", path.get("d")), dtype=float)
        if len(numbers) > 100 and path.get("fill") == "none":
            kind = solid if path.get("stroke-dasharray") is None else dashed
            kind.append(numbers.reshape(-1, 2))
    return dashed, solid


def test_a_robot_without_a_body_is_refused(robot, gait):
    with pytest.raises(DescriptionError, match="load_robot"):
        report.walk(load_urdf(robot.urdf), gait)


def test_the_band_is_the_normal_walk_and_its_spread():
    knee = published_band("slow").curves["knee_flexion"]
    np.testing.assert_allclose(knee.mean[:-1], normative_gait("slow").q[:, 3])
    np.testing.assert_allclose(knee.sd[:-1], normative_sd("slow")[:, 3])


def test_a_walk_along_any_axis_of_the_laboratory_has_the_same_report(robot, gait, document):
    found = document, report.walk(robot, turned(gait, np.pi / 2), normal=None)
    for title in ("Paths of the feet", "Centre of mass"):
        drawings = [
            [
                d.svg
                for b in section(document, title).blocks
                if isinstance(b, blocks.Figure)
                for d in b.drawings
            ]
            for document in found
        ]
        assert len(drawings[0]) >= 2
        for one, other in zip(*drawings, strict=True):
            lines = (" ".join(path.get("d") for path in elements(text, "path")) for text in (one, other))
            numbers = [np.array(re.findall(r"-?\d+\.?\d*", line), dtype=float) for line in lines]
            np.testing.assert_allclose(*numbers, atol=DRAWN)


def test_ten_poses_are_those_of_a_cycle_where_there_is_one(robot, recording):
    assert "one gait cycle" in skeleton.poses_chart(robot, recording)[0].title
    short = replace(
        recording, events=[e for e in recording.events if e.time < 0.4 * recording.duration / 2.5]
    )
    assert "without a whole cycle" in skeleton.poses_chart(robot, short)[0].title


def test_the_page_of_the_paper_says_what_is_computed(paper, robot, gait):
    assert [s.title.split(":")[0] for s in paper.sections[1:]] == [f"Fig. {k}" for k in range(1, 7)]
    rows = table(paper, "Fig. 6: recovered against given joint curves")
    recovery = crosscheck.recover_noisy(robot, gait, 1e-3)
    shown = rows["feet with 1 mm noise"]
    assert float(shown[3]) == pytest.approx(np.degrees(recovery.rms_by_movement()["knee_flexion"]), abs=5e-3)
    assert shown[8] == f"{int(recovery.track.converged.sum())} of {len(gait)}"
    text = unescape(report.html(paper))
    assert "no browser rendered the model in this run" in text
    assert "could not be found" in text


def test_markdown_names_the_files_of_all_drawings(paper):
    text = report.markdown(paper)
    for drawing in paper.drawings:
        assert f"({drawing.file})" in text


def test_the_commands_write_their_pages(tmp_path, capsys):
    folder = tmp_path / "figures"
    assert cli.main(["reproduce", "-o", str(folder), "--no-render"]) == 0
    names = {path.name for path in folder.iterdir()}
    assert {"reproduction.html", "reproduction.md", "fig1_frames.svg", "fig5_poses.svg"} <= names
    for file in re.findall(r"\]\((\S+)\)", (folder / "reproduction.md").read_text()):
        assert file in names
    page = tmp_path / "r.html"
    assert cli.main(["report", "slow", "--who", EVIL, "--no-player", "-o", str(page)]) == 0
    assert "Gait report: slow" in page.read_text()
    assert EVIL not in page.read_text()


def test_the_commands_read_torques_and_tables_of_other_laboratories(tmp_path, gait):
    torques = tmp_path / "torques.csv"
    torques.write_text("time_s,left_knee_flexion_torque_nm\n0,-20\n2,30\n")
    page = tmp_path / "r.html"
    assert cli.main(["report", "free", "--torques", str(torques), "--no-player", "-o", str(page)]) == 0
    assert "Torques against the actuators" in page.read_text()
    lab = tmp_path / "lab.csv"
    rows = np.column_stack([gait.time, np.degrees(gait.q)])
    header = ",".join(["t", *(f"c{k}" for k in range(12))])
    np.savetxt(lab, rows, delimiter=",", header=header, comments="")
    columns = [f"--map=c{k}={joint}" for k, joint in enumerate(JOINTS)]
    options = [str(lab), "--map=t=time", *columns, "--units", "deg"]
    assert cli.main(["reproduce", "-o", str(tmp_path), "--no-render", *options]) == 0
    assert "lab.csv" in (tmp_path / "reproduction.md").read_text()


def test_without_a_browser_the_model_is_a_line_drawing_and_that_is_said(tmp_path, capsys, monkeypatch):
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("EXO_PIN_CHROMIUM", raising=False)
    assert cli.main(["reproduce", "-o", str(tmp_path)]) == 0
    assert "no Chromium found" in capsys.readouterr().err
    assert (tmp_path / "fig3_model.svg").exists()
    assert "no browser rendered the model in this run" in (tmp_path / "reproduction.md").read_text()


def test_rendered_pictures_are_inside_the_page_and_files_beside_it(robot, gait):
    document = report.reproduction(robot, gait, rendered=report.RenderedPictures(model=b"one", poses=b"two"))
    files = {d.file: d.data for d in document.drawings}
    assert (files["fig3_model.png"], files["fig5_rendered.png"]) == (b"one", b"two")
    text = report.html(document)
    assert 'src="data:image/png;base64,b25l"' in text
    assert "no browser" not in text


def test_bad_requests_are_refused(tmp_path, capsys):
    assert cli.main(["report", "-o", str(tmp_path / "r.pdf")]) == 2
    assert cli.main(["report", "--filter", "nan", "-o", str(tmp_path / "r.html")]) == 2
    (tmp_path / "file").write_text("")
    assert cli.main(["reproduce", "--no-render", "-o", str(tmp_path / "file")]) == 2
    assert not list(tmp_path.glob("r.*"))
    assert "exo-pin: " in capsys.readouterr().err


def test_strides_on_a_turn_are_left_out_and_named(robot, gait):
    """The pelvis turns by a right angle in the second of four cycles."""
    long = gait.repeated(4)
    yaw = np.pi / 2 * np.clip(long.time / gait.duration - 1, 0, 1)
    c, s = np.cos(yaw), np.sin(yaw)
    R = np.stack(
        [np.stack([c, -s, 0 * c], 1), np.stack([s, c, 0 * c], 1), np.tile([0.0, 0, 1], (len(c), 1))], 1
    )
    base = long.base.copy()
    base[:, :3, :3] = R @ base[:, :3, :3]
    walk = Gait(long.time, long.q, base=base, events=long.events, source="with a turn")
    words = str(fact_tables.numbers(walk_numbers(robot, walk)))
    assert "turning, not walking straight on" in words
    assert "Left out" not in str(fact_tables.numbers(walk_numbers(robot, gait)))
