"""The pages of comparisons and studies in a real browser: no message, no request, and they fit a phone."""

from __future__ import annotations

from dataclasses import replace

import pytest

from exo_pin import report, study
from exo_pin.compare import Conditions, compare, compare_joints
from exo_pin.gait import normative_gait

PHONE, WALL = 360, 2560  # [px]
DEVICES = ("exo12", "lopes8", "hk4")


def comparison():
    gait = normative_gait().resampled(20)
    compared = compare(gait, DEVICES, conditions=Conditions("device"))
    speeds = {"free": compared, "very_fast": compared}
    return report.comparison(compared, name="a walk " * 20, speeds=speeds, worth=compare_joints(gait))


def study_page():
    rows = study.run(study.plan(("slow", "free"), (1.75,), DEVICES, conditions=[Conditions()])).rows
    rows += tuple(replace(row, stature_m=1.9) for row in rows)
    return report.study(rows, failures={"a_recording_of_a_long_name_" * 5: "why " * 40})


@pytest.mark.parametrize("document", [comparison, study_page])
def test_the_page_is_quiet_and_fits_any_width(browser, tmp_path, document):
    path = tmp_path / "page.html"
    path.write_text(report.html(document()), "utf-8")
    for width in (PHONE, WALL):
        browser.resize(width, 800)
        browser.open(path.as_uri(), until="document.readyState === 'complete'")
        assert browser.evaluate("document.documentElement.scrollWidth") <= width
        assert browser.evaluate(
            "[...document.querySelectorAll('svg')].every(s => s.getBoundingClientRect().height > 30)"
        )
        assert browser.console == []
        assert browser.requests == [path.as_uri()]
