"""Trials over each other, a folder as an index, a band of recordings: the commands and their pages."""

import csv
import io
import math

import numpy as np
import pytest

from exo_pin import clinic, report
from exo_pin.cli import main
from exo_pin.formats import save_gait
from exo_pin.gait import Number, normative_gait
from exo_pin.report.document import blocks


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Two walks of three cycles, and a file that is none."""
    there = tmp_path_factory.mktemp("session")
    for speed in ("slow", "fast"):
        save_gait(normative_gait(speed).repeated(3), there / f"{speed}.csv")
    (there / "notes.csv").write_text("a,b\n1,2\n")
    return there


def rows_of(path):
    return list(csv.DictReader(io.StringIO(path.read_text())))


def test_two_trials_are_side_by_side_with_their_difference(tmp_path, folder, capsys):
    page, table = tmp_path / "two.html", tmp_path / "two.csv"
    files = [str(folder / "slow.csv"), str(folder / "fast.csv")]
    assert main(["report", *files, "-o", str(page), "--csv", str(table)]) == 0
    cells = {(row["section"], row["row"], row["column"]): row["value"] for row in rows_of(table)}
    at = ("Numbers side by side", "stride length")
    slow, fast = (float(cells[(*at, name)].split(" ")[0]) for name in ("slow.csv", "fast.csv"))
    assert float(cells[(*at, "difference fast.csv")]) == pytest.approx(fast - slow, abs=0.011)  # three digits
    assert ("Gait Profile Score", "knee flexion", "fast.csv left") in cells
    assert page.read_text().count("<svg ") == 21, "ten angles of both sides (no knee planes), and a key"


def test_a_folder_is_a_row_for_each_trial_and_a_reason_for_each_other_file(tmp_path, folder, capsys):
    page = tmp_path / "index.html"
    assert main(["report", str(folder), "-o", str(page)]) == 0
    text = page.read_text()
    for name in ("slow.csv", "fast.csv", "notes.csv", "Left out"):
        assert name in text
    assert main(["report", str(tmp_path), "-o", str(tmp_path / "none.html")]) == 2
    assert "trial files" in capsys.readouterr().err


def test_a_band_of_recordings_serves_a_report(tmp_path, folder, capsys):
    band, page = tmp_path / "ours.csv", tmp_path / "page.html"
    assert main(["normal", str(folder), "-o", str(band)]) == 0
    knee = clinic.load_band(band).curves["knee_flexion"]
    means = [clinic.published_band(speed).curves["knee_flexion"].mean for speed in ("slow", "fast")]
    np.testing.assert_allclose(np.degrees(knee.mean), np.degrees(np.mean(means, axis=0)), atol=0.2)
    assert knee.n == 2
    words = ["report", "slow", "--normal", str(band), "--no-player", "--no-forces", "-o", str(page)]
    assert main(words) == 0
    assert "2 recordings" in page.read_text()
    assert main(["normal", str(folder / "slow.csv"), "-o", str(band)]) == 2


@pytest.mark.parametrize(
    "words",
    [
        ["free", "--normal", "nobody", "-o", "x.html"],
        ["free", "--csv", "x.txt", "-o", "x.html"],
        ["free", "slow", "--simulate", "-o", "x.html"],
        ["free", "--patient", "plegic", "-o", "x.html"],
        ["free", "--bws", "1.5", "-o", "x.html"],
    ],
)
def test_options_that_do_not_fit_are_refused_before_any_work(words, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["report", *words]) == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_a_change_is_measured_against_the_spread_of_both():
    apart = clinic.change(Number(1.0, 0.3, 5, "m"), Number(1.6, 0.4, 5, "m"))
    assert apart.value == pytest.approx(0.6)
    assert apart.spread == pytest.approx(math.sqrt((0.09 + 0.16) / 2))
    assert math.isnan(clinic.change(Number(1.0, math.nan, 1, "m"), Number(1.6, 0.4, 5, "m")).in_spreads)


def test_numbers_of_a_page_are_a_table_without_formulas():
    table = blocks.Table(("what", "m"), [["a", "=1+1"], ["b", ""]])
    section = blocks.Section("s", (blocks.Columns((table,), ()), blocks.Tiles((("t", "5", None),))))
    lines = report.csv_of(blocks.Document("d", "", (section,))).splitlines()
    assert lines == ["section,row,column,value", "s,a,m,'=1+1", "s,t,,5"]
