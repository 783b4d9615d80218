"""The programs of docs/to_a_controller.md run, and its commands exist."""

import re
from pathlib import Path

import pytest

from exo_pin.cli import COMMANDS, main

PAGE = (Path(__file__).parents[2] / "docs" / "to_a_controller.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["loop", "simulation", "live"])
def test_its_programs_run(name, capsys):
    (program,) = re.findall(rf"<!-- {name} -->\n```python\n(.*?)```", PAGE, re.DOTALL)
    exec(compile(program, name, "exec"), {"__name__": "page"})
    printed = capsys.readouterr().out
    assert "out of reach" not in printed
    assert name != "simulation" or printed.startswith("walks")


def test_the_length_that_it_names_is_written(tmp_path, capsys):
    for words in re.findall(r"`exo-pin ([^`]*)`", PAGE):
        assert words.split()[0] in COMMANDS
    assert main(["edit", "free", str(tmp_path / "walk.csv"), "--duration", "20", "--ramp", "3", "3"]) == 0
    assert main(["info", str(tmp_path / "walk.csv")]) == 0
    assert "20.000 s" in capsys.readouterr().out
