"""The page of a study: every section, every name escaped, shaded tables and strips of dots."""

import dataclasses
import math
import re
from xml.etree import ElementTree

import numpy as np
import pytest

from exo_pin import report, study
from exo_pin.compare import Conditions
from exo_pin.report.draw.heat import heat, strips
from exo_pin.report.draw.palette import coincident, line_styles

EVIL = '<script>alert("x")</script>'


@pytest.fixture(scope="module")
def rows():
    cases = study.plan(("slow", "free"), (1.6,), ("exo12", "hk4"), conditions=[Conditions()])
    return study.run(cases).rows


def grown(rows):
    """The same rows for more statures, pelvises and recordings, as a large study has them."""
    for row in rows:
        for stature in (1.6, 1.75):
            for pelvis in ("recorded", "device"):
                yield dataclasses.replace(row, stature_m=stature, pelvis=pelvis)
        for k in range(50):
            yield dataclasses.replace(row, gait=f"{k} {EVIL}", clearance_lost_mm=math.nan, doubts=EVIL)


def test_the_page_holds_every_section_and_escapes_every_name(rows):
    document = report.study(list(grown(rows)), failures={EVIL: EVIL}, when="today")
    titles = [section.title for section in document.sections]
    assert titles == [
        "Summary",
        "Against stature",
        "Against speed",
        "By phase of the cycle",
        "Step width and clearance",
        "Recordings",
        "Left out",
        "Conditions",
    ]
    page = report.html(document)
    assert EVIL not in page
    assert len({d.file for d in document.drawings}) == len(document.drawings)
    for drawing in document.drawings:
        ElementTree.fromstring(drawing.svg)
        assert "nan" not in drawing.svg
    assert "40 worst of 50" in page


def test_a_page_of_one_walk_or_of_recordings_alone_leaves_out_what_it_cannot_show(rows):
    one = [row for row in rows if row.gait == "slow"]
    assert "Against stature" not in {s.title for s in report.study(one).sections}
    recorded = [dataclasses.replace(row, gait="w.mot") for row in one]
    assert [s.title for s in report.study(recorded).sections] == ["Summary", "Recordings", "Conditions"]


def test_cells_are_darker_where_numbers_are_larger_and_signs_have_their_colour():
    drawing = heat("h", "t", ["a b", "c", "d", "e"], {"row": [0.0, 1.0, 2.0, -2.0]})
    fills = re.findall(r'fill="#([0-9a-f]{6})"/>', drawing.svg)
    rgb = [tuple(int(fill[k : k + 2], 16) for k in (0, 2, 4)) for fill in fills]
    assert rgb[0] == (255, 255, 255)
    assert sum(rgb[0]) > sum(rgb[1]) > sum(rgb[2])
    assert rgb[2][0] > rgb[2][2]
    assert rgb[3][0] < rgb[3][2]
    assert ">-<" in heat("h", "t", ["a"], {"r": [math.nan]}).svg


def test_strips_have_a_dot_for_each_number_within_the_picture():
    drawing = strips("s", "t", {"a": [1.0, 2.0, 9.0], "b": [5.0]})
    dots = [
        float(e.get("cx")) for e in ElementTree.fromstring(drawing.svg).iter() if e.tag.endswith("circle")
    ]
    assert len(dots) == 4
    assert dots[:3] == sorted(dots[:3])
    assert all(0 < x < 520 for x in dots)


def test_curves_on_each_other_are_one_and_styles_differ():
    nan = math.nan
    series = {"a": np.array([1.0, nan]), "b": np.array([1.001, nan]), "c": np.array([1.0, 2.0])}
    assert coincident(series, 0.01) == [("a", "b"), ("c",)]
    assert len(set(line_styles(map(str, range(9))).values())) == 9
