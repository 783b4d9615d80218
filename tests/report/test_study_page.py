"""The page of a study: every section, every name escaped, shaded tables and strips of dots."""

import dataclasses
import math
from xml.etree import ElementTree

import pytest

from exo_pin import report, study
from exo_pin.compare import Conditions

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
