"""Drawings: numbers stand where they belong, limits and gaps are kept, text is escaped."""

import math
import re
from xml.etree import ElementTree

import numpy as np
import pytest

from exo_pin.report.draw import chart, chart_axis, svg
from exo_pin.report.draw.heat import heat, strips
from exo_pin.report.draw.palette import coincident, line_styles

EVIL = '<script>alert("x")</script>&'


def elements(drawing, name):
    return list(ElementTree.fromstring(drawing).iter(f"{{http://www.w3.org/2000/svg}}{name}"))


def test_a_curve_is_drawn_where_its_numbers_are():
    curve = chart.Curve([0, 10], [0, 5], "#123456")
    drawing = chart.draw(chart.Chart(title="t", curves=(curve,), x_range=(0, 10), y_range=(0, 10)))
    (path,) = [e for e in elements(drawing, "path") if e.get("stroke") == "#123456"]
    points = np.array(re.findall(r"[ML]([\d.]+) ([\d.]+)", path.get("d")), dtype=float)
    area = next(e for e in elements(drawing, "rect"))
    x, y, width, height = (float(area.get(name)) for name in ("x", "y", "width", "height"))
    np.testing.assert_allclose(points, [[x, y + height], [x + width, y + height / 2]], atol=0.01)


def test_a_limit_off_the_axis_is_named_in_the_legend_all_the_same():
    curve = chart.Curve([0, 1], [-1, 1], "#123456")

    def legend(*ends):
        levels = tuple(chart.Level(y, "#654321", "most", always_in_legend=True) for y in ends)
        drawing = chart.draw(chart.Chart(title="t", curves=(curve,), levels=levels, y_range=(-2, 2)))
        return [e.text for e in elements(drawing, "text") if "most" in (e.text or "")]

    assert legend(-1.5, 1.5) == ["most"]
    assert legend(-1.5, 9.0) == ["most"]
    assert legend(-9.0, 9.0) == ["most: off the axis"]


def test_a_long_recording_is_thinned_for_drawing_only():
    x = np.linspace(0, 1, 50_001)
    drawing = chart.draw(chart.Chart(title="long", curves=(chart.Curve(x, x, "#123456"),)))
    assert len(drawing) < 40_000


@pytest.mark.parametrize(("low", "high"), [(0, 1), (-7.3, 61.2), (1e-9, 3e-9), (-2e5, 9e5)])
def test_ticks_are_round_and_within(low, high):
    found = np.array(chart_axis.ticks(low, high))
    assert 3 <= len(found) <= 10
    assert low - 1e-9 * abs(low) <= found.min() <= found.max() <= high * (1 + 1e-9)
    step = np.diff(found)
    np.testing.assert_allclose(step, step[0])
    mantissa = step[0] / 10 ** np.floor(np.log10(step[0]) + 1e-9)
    assert np.isclose(mantissa, [1, 2, 5]).any()


def test_gaps_of_a_line_stay_gaps_and_numbers_are_short():
    assert svg.path([[0, 0], [1, 1], [np.nan, 0], [2, 2]]) == "M0 0L1 1M2 2"
    assert [svg.number(x) for x in (-0.001, 1 / 3, 100.0)] == ["0", "0.33", "100"]
    assert svg.text(0, 0, EVIL).count("<") == 2


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
