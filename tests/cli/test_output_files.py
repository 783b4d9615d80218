"""Files that commands write: never one that they read, and a note where an earlier one is replaced."""

from __future__ import annotations

import os

import pytest

from exo_pin.cli import main
from exo_pin.formats import load_gait, save_gait
from exo_pin.gait import normative_gait


@pytest.fixture
def walk(tmp_path):
    path = tmp_path / "walk.csv"
    save_gait(normative_gait("free"), path)
    return path


def linked(walk, kind):
    """The walk under another name."""
    other = walk.with_name("other.csv")
    if kind == "symlink":
        other.symlink_to(walk)
    elif kind == "hard link":
        os.link(walk, other)
    else:
        (walk.parent / "below").mkdir()
        other = walk.parent / "below" / ".." / walk.name
    return other


@pytest.mark.parametrize("kind", ["symlink", "hard link", "other spelling"])
@pytest.mark.parametrize(
    "words",
    [
        ["convert", "{in}", "{out}"],
        ["convert", "{out}", "{in}"],
        ["edit", "{in}", "{out}", "--slower", "2"],
        ["edit", "free", "{out}", "--blend", "{in}=0.3"],
        ["edit", "free", "{in}", "--transition", "{out}=3"],
        ["fk", "{in}", "-o", "{out}"],
        ["film", "{in}", "-o", "{out}"],
        ["picture", "{in}", "-o", "{out}"],
        ["cycles", "{in}", "--output={out}"],
        ["replay", "{in}", "--html", "{out}"],
        ["report", "{in}", "-o", "{out}"],
        ["urdf", "--body", "{in}", "-o{out}"],
    ],
    ids=lambda words: " ".join(words[:2]),
)
def test_no_command_writes_over_a_file_that_it_reads(walk, capsys, kind, words):
    names, before = {"{in}": str(walk), "{out}": str(linked(walk, kind))}, walk.read_bytes()
    for mark, name in names.items():
        words = [word.replace(mark, name) for word in words]
    assert main(words) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "is read by this command" in line
    assert walk.read_bytes() == before


def test_an_earlier_file_is_replaced_with_a_note(walk, capsys):
    copy = walk.with_name("copy.csv")
    assert main(["convert", str(walk), str(copy)]) == 0
    assert "replaced" not in capsys.readouterr().err
    assert main(["convert", "slow", str(copy)]) == 0
    notes = [line for line in capsys.readouterr().err.splitlines() if "replaced" in line]
    assert notes == [f"note: {copy}: an earlier file of this name was replaced"]
    assert load_gait(copy).duration == pytest.approx(normative_gait("slow").duration)


def test_nothing_is_said_of_a_file_that_stays_and_of_what_is_no_file(walk, capsys):
    assert main(["convert", str(walk.with_name("none.csv")), str(walk)]) == 2
    assert "replaced" not in capsys.readouterr().err
    assert main(["urdf", "-o", os.devnull]) == 0
    assert "replaced" not in capsys.readouterr().err
