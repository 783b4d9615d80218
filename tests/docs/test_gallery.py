"""Every script of docs/gallery runs as it is, and prints numbers."""

import re
import runpy
from pathlib import Path

import pytest

SCRIPTS = sorted((Path(__file__).resolve().parents[2] / "docs" / "gallery").glob("*.py"))
NEEDS = {"own_controller": "mujoco"}


def test_there_are_ten():
    assert len(SCRIPTS) == 10


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_an_example_runs_and_prints_numbers(script, capsys):
    pytest.importorskip(NEEDS.get(script.stem, "numpy"))
    runpy.run_path(str(script), run_name="__main__")
    shown = capsys.readouterr().out
    assert len(re.findall(r"\d", shown)) > 1
    assert "nan" not in shown
