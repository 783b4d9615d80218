"""docs/robots.md is held to what it says: its table, its recipe, its commands."""

import re
import shlex
from pathlib import Path

import pytest

from exo_pin.cli import main
from exo_pin.retarget import load
from exo_pin.retarget.target_robots import UNFIT
from exo_pin.retarget.target_table import visuals

PAGE = (Path(__file__).parents[2] / "docs" / "robots.md").read_text("utf-8")


def test_the_table_is_the_one_that_the_command_prints(capsys):
    assert main(["retarget", "--table"]) == 0
    printed = capsys.readouterr().out
    written = PAGE.partition("<!-- table -->\n")[2].partition("<!-- end -->")[0]
    assert written == printed, "renew it with `exo-pin retarget --table`"


def test_the_recipe_works_as_it_is_written(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("my_robot.urdf").write_text(load("simple_humanoid").robot.path.read_text("utf-8"), "utf-8")
    recipe = PAGE.partition("## Adding your own robot")[2]
    (record,) = re.findall(r"```toml\n(.*?)```", recipe, re.DOTALL)
    Path("my_robot.toml").write_text(re.sub(r"(?m)^ {3}", "", record), "utf-8")
    alone, *recorded = [
        shlex.split(line)[1:]
        for block in re.findall(r"```sh\n(.*?)```", recipe, re.DOTALL)
        for line in block.split("\n")
        if line.strip()
    ]
    assert main(alone) == 1  # the permuted limits of the file: feet are missed, and it says so
    assert Path("joints.csv").exists()
    for words in recorded:
        assert main(words) == 0
    assert "My robot" in capsys.readouterr().out
    assert Path("my_robot.html").stat().st_size < 2e6


def test_robots_that_cannot_walk_are_named_with_their_reason():
    for name in UNFIT:
        assert name.capitalize() in PAGE


@pytest.mark.parametrize(
    ("visual", "said"),
    [
        ("", "capsules"),
        ('<visual><geometry><box size="1 1 1"/></geometry></visual>', "primitives"),
        ('<visual><geometry><mesh filename="package://a/b.STL"/></geometry></visual>', "1 stl"),
    ],
)
def test_visuals_are_counted_by_kind_of_file(visual, said):
    assert visuals(f'<robot name="r"><link name="a">{visual}</link></robot>') == said
