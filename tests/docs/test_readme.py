"""The code does what the README says: its commands, tables and numbers."""

import re
import shlex
from pathlib import Path

import pytest

from exo_pin import crosscheck
from exo_pin.anatomy import MOVEMENTS
from exo_pin.anatomy.anthropometry import LIMITS_DEG
from exo_pin.cli import COMMANDS
from exo_pin.gait import SPEEDS, normative_gait
from exo_pin.robot import load_robot

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", TEXT, flags=re.DOTALL)


def rows(heading):
    """Cells of the table rows under a heading."""
    part = TEXT.split(f"## {heading}")[1].split("\n## ")[0]
    lines = [line for line in part.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines[1:]]


def test_the_python_lines_run_as_they_stand(capsys):
    for block in blocks("python"):
        exec(block, {})
    position, angle = map(float, capsys.readouterr().out.split())
    assert position < 1e-12
    assert angle < 1e-6


def test_the_two_commands_exist():
    for line in blocks("sh")[0].splitlines():
        assert (ROOT / shlex.split(line)[0]).stat().st_mode & 0o111


def test_the_command_table_names_every_command_and_no_other():
    named = {cell.split()[1].strip("`") for cell, _ in rows("Commands")}
    assert named == set(COMMANDS)


def test_the_speeds_are_those_of_the_package():
    assert " ".join(SPEEDS) in TEXT


def test_the_sign_table_has_the_default_limits():
    table = {name.strip("`"): limits for name, _, limits in rows("Signs, units, frames")}
    assert list(table) == list(MOVEMENTS)
    for movement, (lower, upper) in LIMITS_DEG.items():
        assert table[movement] == f"{lower:g} .. {upper:g} deg"


def test_the_accuracy_table_holds():
    verdict = crosscheck.check(load_robot(), normative_gait()).facts()
    assert max(verdict["fk_max_difference"].values()) < 1e-15
    assert verdict["ik"]["max_position_error_m"] < 1e-14
    assert verdict["ik"]["max_rotation_error_rad"] < 1e-14
    assert verdict["ik"]["max_angle_error_deg"] < 1e-11
    assert verdict["ik"]["method_agreement_deg"] == pytest.approx(2e-6, abs=2e-6)
