"""What another package adds by entry points: the example of docs/extending.md, on a path of its own."""

import re
import sys
import tomllib
from pathlib import Path

import pytest

from exo_pin import load_gait, normative_gait
from exo_pin.cli import main
from exo_pin.control import find_controller
from exo_pin.devices import DEVICES, find
from exo_pin.errors import DescriptionError, FormatError, UnknownNameError
from exo_pin.retarget.biped import find as find_target

PAGE = (Path(__file__).parents[1] / "docs" / "extending.md").read_text(encoding="utf-8")


def example(name, language):
    (text,) = re.findall(rf"<!-- {name} -->\n```{language}\n(.*?)```", PAGE, re.DOTALL)
    return text


@pytest.fixture
def site(tmp_path, monkeypatch):
    """The example package as pip would install it."""
    groups = tomllib.loads(example("pyproject", "toml"))["project"]["entry-points"]
    lines = [
        line
        for group, entries in groups.items()
        for line in (f"[{group}]", *(f"{name} = {value}" for name, value in entries.items()))
    ]
    info = tmp_path / "my_exo-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: my-exo\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("\n".join(lines) + "\n")
    (tmp_path / "my_exo.py").write_text(example("module", "python"))
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "my_exo", raising=False)
    yield tmp_path
    sys.modules.pop("my_exo", None)


def test_its_names_are_found_as_ours_are(site, capsys):
    assert find("My-Exo").title == "My exoskeleton"
    assert find_controller("soft_knee")[0] == "soft_knee"
    assert find_target("my_robot").name == "my_robot"
    (site / "a.walkname").write_text("slow\n")
    assert load_gait(site / "a.walkname").source == normative_gait("slow").source
    assert main(["devices"]) == 0
    assert "my_exo" in capsys.readouterr().out
    assert main(["feasible", "slow", "--device", "my_exo", "--json"]) in (0, 1)


def test_without_the_package_its_names_are_unknown(tmp_path):
    for look in (find, find_controller, find_target):
        with pytest.raises(UnknownNameError):
            look("my_exo")
    (tmp_path / "a.walkname").write_text("slow\n")
    with pytest.raises(FormatError):
        load_gait(tmp_path / "a.walkname")


def test_one_that_cannot_be_loaded_is_named_with_its_package(site, capsys):
    (site / "my_exo.py").write_text("raise RuntimeError('not today')\n")
    with pytest.raises(DescriptionError, match=r"'my_exo' of my-exo .*not today"):
        find("my_exo")
    assert main(["devices"]) == 0
    printed = capsys.readouterr()
    assert all(name in printed.out for name in DEVICES)
    assert printed.err.count("note:") == 1


def test_one_of_another_kind_is_refused(site):
    (site / "my_exo.py").write_text("DEVICE = 3\n")
    with pytest.raises(DescriptionError, match="no Device but int"):
        find("my_exo")


def test_names_of_ours_come_first(site):
    entries = site / "my_exo-1.0.dist-info" / "entry_points.txt"
    entries.write_text("[exo_pin.devices]\nlokomat = my_exo:DEVICE\n")
    assert find("lokomat") is DEVICES["lokomat"]
