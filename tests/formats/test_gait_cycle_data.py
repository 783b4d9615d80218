"""Mean cycles (.gcd): timed by the file's own numbers, the feet in step; without a time they are no walk."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.errors import FormatError
from exo_pin.formats import load_gait
from exo_pin.gait import normative_gait

INVERSIONS = [5, 11]
EXACT = 1e-12  # [rad]: half a cycle of 50 points is 25 of them, so nothing is interpolated


@pytest.fixture
def walk():
    return normative_gait("free", samples=50)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "mean.gcd"


@pytest.mark.parametrize("deviation", [False, True])
def test_the_cycle_comes_back_with_both_feet_in_step(lab, path, walk, deviation):
    path.write_text(lab.gcd(walk, 1.1, deviation=deviation))
    back = load_gait(path)
    kept = np.setdiff1d(np.arange(12), INVERSIONS)
    np.testing.assert_allclose(back.q[:, kept], walk.q[:, kept], atol=EXACT)
    np.testing.assert_array_equal(back.q[:, INVERSIONS], 0)
    assert (back.periodic, back.duration) == (True, pytest.approx(1.1))
    assert [(round(e.time / 1.1, 9), e.kind, e.side) for e in back.events] == [
        (0.0, "heel_strike", "left"), (0.12, "toe_off", "right"),
        (0.5, "heel_strike", "right"), (0.62, "toe_off", "left"),
    ]  # fmt: skip
    assert "inversion" in back.remarks[-1]


@pytest.mark.parametrize(
    ("scalars", "seconds"),
    [
        ("!LeftCadence\n100\n", 1.2),
        ("!LeftCadence_StepsPerMin\n100\n!LeftCadence\n0.83\n", 1.2),
        ("!LeftStrideLength\n1200\n!LeftSpeed\n1000\n", 1.2),
        ("!LeftStrideTime\n1.0\n!RightStrideTime\n1.04\n!LeftCadence\n60\n", 1.02),
    ],
)
def test_the_files_own_numbers_time_it(lab, path, walk, scalars, seconds):
    path.write_text(lab.gcd(walk, scalars=False) + scalars)
    back = load_gait(path)
    assert back.duration == pytest.approx(seconds)
    assert "strikes at 50 %" in back.remarks[0]


@pytest.mark.parametrize("scalars", ["", "!LeftCadence\n0.9\n", "!LeftStrideTime\n1\n!RightStrideTime\n2\n"])
def test_without_a_time_it_is_refused(lab, path, walk, scalars):
    path.write_text(lab.gcd(walk, scalars=False) + scalars)
    with pytest.raises(FormatError, match=r"mean cycle in per cent.* how long"):
        load_gait(path)


def test_a_cycle_that_does_not_close_is_closed_and_that_is_said(lab, path, walk):
    lines = lab.gcd(walk).splitlines()
    at = lines.index("!LeftKneeFlexExt") + 51
    lines[at] = str(float(lines[at]) + 2)
    path.write_text("\n".join(lines))
    back = load_gait(path)
    assert "2.0 deg off its start" in back.remarks[0]
    assert np.abs(back.q - load_gait(_whole(lab, path, walk)).q).max() < np.radians(2)


def _whole(lab, path, walk):
    path.write_text(lab.gcd(walk))
    return path


@pytest.mark.parametrize(
    ("old", "new", "match"),
    [
        ("!RightHipRotation", "!RightHipTurn", "RightHipRotation is not there"),
        ("!LeftHipFlexExt\n", "!LeftHipFlexExt\n1\n", "51 to 52 points"),
        ("!LeftHipFlexExt\n", "!LeftHipFlexExt\n1e308\n", "finite"),
        ("!LeftHipFlexExt\n", "!LeftHipFlexExt\nx\n", "no number"),
        ("!LeftHipFlexExt\n", "!LeftHipFlexExt\n1_0\n", "no number"),
        ("!LeftHipFlexExt\n", "!LeftHipFlexExt\n999 ", "half a turn"),
        ("!LeftHipRotation", "!LeftHipFlexExt", "occurs twice"),
    ],
)
def test_damaged_cycles_are_refused(lab, path, walk, old, new, match):
    path.write_text(lab.gcd(walk).replace(old, new))
    with pytest.raises(FormatError, match=match):
        load_gait(path)


@pytest.mark.parametrize(("left_out", "kept"), [("Left", "right"), ("Right", "left")])
def test_one_side_alone_is_refused_by_name(lab, path, walk, left_out, kept):
    path.write_text(lab.gcd(walk).replace(f"!{left_out}", "!Other"))
    path.write_text("\n".join(_unique(path.read_text())))
    with pytest.raises(
        FormatError, match=f"holds the {kept} side alone.*curves of the {left_out.lower()} side"
    ):
        load_gait(path)


def _unique(text):
    """Lines with numbered variables, so that no name occurs twice."""
    return [f"{line}{k}" if line.startswith("!Other") else line for k, line in enumerate(text.splitlines())]


def test_a_file_without_variables_is_named(path):
    path.write_text("hello\n")
    with pytest.raises(FormatError, match="gait cycle data"):
        load_gait(path)
