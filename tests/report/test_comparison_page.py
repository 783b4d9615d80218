"""The page of a comparison: everything that the comparison knows, escaped, self-contained, drawn whole."""

import dataclasses
import re
from html import unescape
from xml.etree import ElementTree

import numpy as np
import pytest

from exo_pin import report
from exo_pin.anatomy import JOINTS, MOVEMENTS
from exo_pin.cli import main
from exo_pin.compare import Conditions, compare, compare_joints, comparison_table
from exo_pin.devices import DEVICES, Device, both
from exo_pin.formats import save_gait
from exo_pin.gait import Gait, normative_gait
from exo_pin.report.document import blocks
from exo_pin.report.draw.cycle_axis import cycle_axis
from exo_pin.report.draw.device_drawings import joints, ranking, sticks

GAIT = normative_gait().resampled(20)
EVIL = '<script>alert("x")</script>&'
MINE = Device(name="mine", title=EVIL, joints=both("hip_flexion"), source=EVIL)


@pytest.fixture(scope="module")
def compared():
    return compare(GAIT, ["exo12", "lopes8", "lokomat", "hk4", MINE], conditions=Conditions("device"))


@pytest.fixture(scope="module")
def document(compared):
    found = compare_joints(GAIT.resampled(10))
    return report.comparison(
        compared, name=EVIL, speeds={EVIL: compared, "fast": compared}, worth=found, choices={EVIL: EVIL}
    )


def section(document, title):
    return next(s for s in document.sections if s.title == title)


def tables(document, title):
    return [block for block in section(document, title).blocks if isinstance(block, blocks.Table)]


def test_the_page_has_every_section(document):
    assert [s.title for s in document.sections] == [
        "Summary",
        "How they walk",
        "Feet: position and orientation",
        "Step width and clearance",
        "Joints",
        "Centre of mass",
        "At the five speeds",
        "Which joints are worth their motor",
        "Conditions",
    ]


def test_the_ranked_table_is_the_comparison_s(document, compared):
    assert tables(document, "Summary")[0].rows == comparison_table.rows(compared)


def test_errors_of_the_feet_are_those_of_the_losses(document, compared):
    for row, loss in zip(
        tables(document, "Feet: position and orientation")[0].rows, compared.best, strict=True
    ):
        spread = [1e3 * loss.sole_error, 1e3 * loss.position_error, np.degrees(loss.rotation_error)]
        expected = [f(x) for x in spread for f in (lambda v: np.sqrt(np.mean(v**2)), np.max)]
        assert [float(cell) for cell in row[1:]] == pytest.approx(expected, abs=0.0501)


def test_step_width_and_clearance_add_up(document):
    recorded, *rows = tables(document, "Step width and clearance")[0].rows
    for row in rows:
        width, lost, clearance, clearance_lost = map(float, row[1:])
        assert width + lost == pytest.approx(float(recorded[1]), abs=0.151)
        assert clearance + clearance_lost == pytest.approx(float(recorded[3]), abs=0.151)


def test_ranges_are_shown_for_driven_joints_and_limits_are_marked(document, compared):
    ranges, slides, *_ = tables(document, "Joints")
    used = {row[0]: dict(zip(MOVEMENTS, row[1:7], strict=True)) for row in ranges.rows}
    assert used["hk4"]["hip_adduction"] == "locked"
    for loss in compared.best:
        for movement, cell in used[loss.device.name].items():
            mine = [found for joint, found in loss.ranges.items() if joint.endswith(movement)]
            assert (cell == "locked") == (not mine)
            assert cell.endswith("*") == any(demand.samples_at_limit for demand in mine)
    assert {row[0] for row in slides.rows} == {"lopes8", "lokomat"}


def test_every_name_is_text_and_every_drawing_is_whole(document):
    page = report.html(document)
    assert EVIL not in page
    assert "<script" not in page
    assert unescape(page).count(EVIL) >= 4
    assert len({drawing.file for drawing in document.drawings}) == len(document.drawings)
    for drawing in document.drawings:
        ElementTree.fromstring(drawing.svg)
        assert not re.search(r"\bnan\b|\binf\b", drawing.svg)


def test_sticks_of_a_device_that_loses_nothing_lie_on_the_recorded_ones():
    exact, lossy = (sticks(compare(GAIT, [name]).best[0]).svg for name in ("exo12", "hk4"))
    for drawing, same in ((exact, True), (lossy, False)):
        paths = re.findall(r'<path d="([^"]+)"[^>]*stroke="(#\w+)"', drawing)
        shadow = sorted(d for d, colour in paths if colour == "#bcc4cd")
        device = sorted(d for d, colour in paths if colour != "#bcc4cd")
        assert len(shadow) == len(device) == 12
        assert (shadow == device) == same


def test_sticks_are_seen_from_the_left_wherever_the_walk_leads():
    turned = np.array(GAIT.base)
    turned[:, :3] = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]]) @ turned[:, :3]
    drawings = [
        sticks(compare(dataclasses.replace(GAIT, base=b), ["hk4"]).best[0]) for b in (GAIT.base, turned)
    ]
    points = [np.array(re.findall(r"[ML]([\d.]+) ([\d.]+)", d.svg), dtype=float) for d in drawings]
    assert points[0] == pytest.approx(points[1], abs=0.1)  # [px]; numbers in a drawing have two decimals


def test_series_are_drawn_over_the_foot_s_own_cycle_as_the_mean_of_its_cycles():
    walk = GAIT.repeated(3)
    recording = Gait(walk.time, walk.q, base=walk.base, events=walk.events)
    for side, late in (("left", 0), ("right", GAIT.events[2].time / GAIT.duration)):
        one, mean = cycle_axis(GAIT, side), cycle_axis(recording, side)
        assert mean.label == f"% of the {side} foot's cycle, mean of 2"
        knee = one.series(GAIT.q[:, JOINTS.index("left_knee_flexion")])
        assert mean.series(recording.q[:, JOINTS.index("left_knee_flexion")]) == pytest.approx(knee, abs=1e-9)
        again = np.interp(late * GAIT.duration, GAIT.time, GAIT.q[:, JOINTS.index("left_knee_flexion")])
        assert knee[[0, -1]] == pytest.approx(again, abs=1e-9)
    short = cycle_axis(Gait(GAIT.time[:5], GAIT.q[:5]), "left")
    assert (short.label, len(short.x)) == ("time [s]", 5)


def test_bars_grow_with_the_loss(compared):
    bars = [e for e in ElementTree.fromstring(ranking(compared).svg).iter() if e.tag.endswith("rect")]
    widths = [float(bar.get("width")) for bar in bars]
    assert widths == sorted(widths)
    losses = np.array([loss.rms for loss in compared.best])
    assert widths[-1] / widths[-2] == pytest.approx(losses[-1] / losses[-2], rel=0.01)


def test_curves_of_equal_devices_are_one_with_both_names():
    knees = joints(compare(GAIT, ["lokomat", "hk4"]), "left")[MOVEMENTS.index("knee_flexion")]
    assert "lokomat = hk4" in unescape(knees.svg)
    adduction = joints(compare(GAIT, ["lokomat"]), "left")[MOVEMENTS.index("hip_adduction")]
    assert "lokomat" not in adduction.svg
    assert "recorded" in adduction.svg


def test_a_walk_without_events_still_has_a_page():
    bare = Gait(GAIT.time[:5], GAIT.q[:5])
    document = report.comparison(compare(bare, ["lokomat"]))
    assert "no heel strikes" in report.html(document)
    for drawing in document.drawings:
        assert "nan" not in drawing.svg


def test_the_command_writes_the_page(tmp_path, capsys):
    page, walk = tmp_path / "r.html", tmp_path / "walk.csv"
    save_gait(GAIT.resampled(10), walk)  # few samples: the choices of joints are 64 optimisations
    assert main(["compare", str(walk), "--devices", "exo12", "hk4", "-o", str(page)]) == 0
    text = page.read_text()
    assert "At the five speeds" in text
    assert "very<" in text  # the heading of a column
    assert "Which joints are worth their motor" in text
    assert main(["compare", "slow", "--devices", "exo12", "--quick", "-o", str(page)]) == 0
    assert "At the five speeds" not in page.read_text()
    assert set(DEVICES) & set(capsys.readouterr().out.split()) == {"exo12", "hk4"}
