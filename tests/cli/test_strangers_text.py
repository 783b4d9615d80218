"""What files say is printed as plain, short text; numbers follow one rule; cells are no formulas."""

from __future__ import annotations

import csv
import time
import tracemalloc

import numpy as np
import pytest

from exo_pin.cli import clock, main
from exo_pin.cli.measures import metres
from exo_pin.errors import LONGEST_MESSAGE, FormatError, UnknownNameError
from exo_pin.files import read_text
from exo_pin.formats import load_gait, save_gait
from exo_pin.gait import normative_gait
from exo_pin.safe import toml_file
from exo_pin.safe.spreadsheet_cells import marked, table, unmarked


@pytest.mark.parametrize("character", ["\x1b", "\x07", "\x7f", "\x9b", "\u202e"])
def test_control_characters_are_refused_with_their_line(tmp_path, character):
    path = tmp_path / "walk.csv"
    path.write_text(f"# a\n# b {character}[31m\n", "utf-8")
    with pytest.raises(FormatError, match=r"walk.csv:2: holds the control character U\+") as refusal:
        read_text(path)
    assert str(refusal.value).isprintable()


def test_no_control_character_reaches_the_terminal(tmp_path, capfd):
    name = tmp_path / "\x1b]0;title\x07\x9b31m.csv"
    assert main(["info", str(name)]) == 2
    assert main(["info", "free\x1b[2J"]) == 2
    seen = "".join(capfd.readouterr())
    assert seen.replace("\n", "").isprintable()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (f"a.b = {'9' * 400}", "a.b is no finite number"),
        (f"a = {'9' * 5000}", "no TOML|is not TOML"),
        ("a = [1, nan]", "a is no finite number"),
        ('a = "\\u001b[31m"', r"a holds the control character U\+001B"),
        ('"\\u009b" = 1', r"a name in the file holds the control character U\+009B"),
        (f"a = {'[' * 5000}", "TOML|within each other"),
    ],
)
def test_toml_of_strangers_is_refused_with_the_place(tmp_path, text, said):
    path = tmp_path / "mine.toml"
    path.write_text(text, "utf-8")
    with pytest.raises(FormatError, match=said) as refusal:
        toml_file.read(path)
    assert str(refusal.value).isprintable()


@pytest.mark.parametrize(
    "words", ["left_thigh_link_mass:=0.4_1", "left_knee_flexion_upper:=\u0661", "stature:=1_7"]
)
def test_numbers_of_urdf_arguments_follow_the_rule_of_tables(capsys, words):
    assert main(["urdf", words]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_lengths_have_digits_of_ascii():
    with pytest.raises(Exception, match="is not in m"):
        metres("\u0661.\u0667")


def test_messages_are_short(capsys):
    assert len(str(UnknownNameError("joint", "a" * 5000, [f"joint_{k}" for k in range(1000)]))) < 300
    assert main(["info", "a" * 200 + "/" + "b" * 5000 + ".csv"]) == 2
    assert len(capsys.readouterr().err) < 320


@pytest.mark.parametrize("text", ["=1+1", "@x", "-x", "+x", "'=x", "''=x", "plain", "'quoted", ""])
def test_cells_that_a_spreadsheet_would_calculate_are_marked_and_come_back(text):
    assert not marked(text).startswith(("=", "+", "-", "@"))
    assert unmarked(marked(text)) == text


def test_numbers_stay_numbers():
    assert table([["-1.5", "=a,b"]]) == '-1.5,"\'=a,b"\n'


@pytest.mark.skipif(not hasattr(time, "tzset"), reason="the time zone of the process cannot be set")
def test_time_zones_that_do_not_exist_are_no_traceback(monkeypatch):
    monkeypatch.setenv("TZ", "XXX-167:59:59")
    time.tzset()
    try:
        assert clock.moment()
    finally:
        monkeypatch.undo()
        time.tzset()


BIDS = "sub-01_task-walk_tracksys-imu_motion.tsv"
LONG = "1" * (csv.field_size_limit() + 1)


@pytest.mark.parametrize("name", ["walk.csv", "walk.mot", "walk.trc", BIDS, "lab.csv"])
def test_a_cell_that_is_too_long_for_a_table_costs_a_short_line(tmp_path, capsys, name):
    path = tmp_path / name
    if name == "walk.trc":
        head = "PathFileType\t4\n100\t100\t1\t1\tmm\nFrame#\tTime\tA\n\tX1\tY1\tZ1\n"
        path.write_text(f"{head}\n1\t0\t{LONG}\n")
    elif name == "lab.csv":
        path.write_text(f"t,{LONG}\n0,{LONG}\n1,2\n")
    else:
        save_gait(normative_gait("free"), path)
        rows = path.read_text().splitlines(keepends=True)
        end = "\t" if "\t" in rows[-2] else ","
        path.write_text("".join([*rows[:-2], LONG + rows[-2][rows[-2].index(end) :], rows[-1]]))
    assert main(["info", str(path)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert len(line) <= LONGEST_MESSAGE + len("exo-pin: ")


@pytest.mark.parametrize("name", ["walk.csv", "walk.mot", "walk.npz", "walk.trc", "walk.c3d", "walk.json"])
def test_a_file_of_ten_million_rows_is_refused_before_it_is_read(tmp_path, name):
    path = tmp_path / name
    with path.open("wb") as file:
        file.write(b"time_s,left_hip_flexion_deg\n")
        file.truncate(10**7 * 13 * 8)  # a hole, which takes no place on the disk
    tracemalloc.start()
    try:
        with pytest.raises(FormatError, match="larger than 128 MiB; split or resample"):
            load_gait(path)
        assert tracemalloc.get_traced_memory()[1] < 10e6  # [bytes], imports included
    finally:
        tracemalloc.stop()


def test_an_archive_of_ten_million_frames_is_refused_by_its_directory(tmp_path):
    path = tmp_path / "walk.npz"
    frames = np.broadcast_to(np.zeros(1), (10**7, 4))  # 320 MB that pack into 0.3 MB
    np.savez_compressed(path, q=frames)
    tracemalloc.start()
    try:
        with pytest.raises(FormatError, match="more than 256 MiB unpacked"):
            load_gait(path)
        assert tracemalloc.get_traced_memory()[1] < 10e6  # [bytes]
    finally:
        tracemalloc.stop()
