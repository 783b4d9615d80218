"""The scripts: lint and type checks see all of them, `structure` counts what it says, with Python alone."""

import importlib.util
import subprocess
import sys
import tomllib
from importlib.machinery import SourceFileLoader
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = sorted(
    path.relative_to(ROOT).as_posix()
    for path in (ROOT / "scripts").iterdir()
    if path.is_file() and path.suffix == "" and "python" in path.read_text("utf-8").partition("\n")[0]
)


@pytest.fixture
def structure(tmp_path, monkeypatch):
    """The script as a module, to measure a package of one's own."""
    loader = SourceFileLoader("structure", str(ROOT / "scripts" / "structure"))
    spec = importlib.util.spec_from_loader("structure", loader)
    assert spec
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    monkeypatch.setattr(module, "ROOT", tmp_path)
    return module


@pytest.fixture
def package(tmp_path):
    """Writes modules of a package and pages of its documentation."""

    def write(**texts):
        """A module for each keyword: `ik__a` is ik/a.py, `ik__init` the room's `__init__`."""
        for name, text in texts.items():
            place = name.replace("__", "/").replace("init", "__init__")
            path = tmp_path / "exo_pin" / f"{place}.py"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, "utf-8")

    return write


@pytest.mark.parametrize("script", SCRIPTS)
def test_lint_and_types_see_every_script(script):
    tool = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]
    assert script in tool["ruff"]["extend-include"]
    assert script in tool["mypy"]["files"]


def test_structure_and_architecture_need_nothing_but_python():
    for script, option in (("structure", "--help"), ("architecture", "--contents")):
        call = [sys.executable, "-S", str(ROOT / "scripts" / script), option]
        done = subprocess.run(call, capture_output=True, text=True, check=True, env={})
        assert done.stdout


def test_names_in_two_modules_are_counted_once_each(structure, package):
    package(a__same="LIMIT = 1\n_OWN = 2\n\n\nclass Thing: ...\n", b__same="LIMIT = 3\n_OWN = 4\n")
    package(b__other="class Thing: ...\n")
    found = structure.places()
    assert found["file names with two meanings"] == ["same: exo_pin.a.same, exo_pin.b.same"]
    assert found["public constants defined twice"] == ["LIMIT: exo_pin.a.same, exo_pin.b.same"]
    assert found["public classes defined twice"] == ["Thing: exo_pin.a.same, exo_pin.b.other"]


def test_cycles_chains_and_imports_of_the_front_door_are_found(structure, package):
    package(ik__a="from exo_pin.ik import b\n", ik__b="from exo_pin.ik import c\n", ik__c="import exo_pin\n")
    package(x="from exo_pin.y import one\n", y="if TYPE:\n    from exo_pin.x import two\n", init="")
    package(ik__init="from exo_pin.ik import a, b, c\n")
    found = structure.places()
    assert structure.floors(structure.inside("ik")) == 3
    assert sum(map(len, structure.inside("ik").values())) == 2
    assert found["import cycles (run time and typing)"] == ["exo_pin.x -> exo_pin.y -> exo_pin.x"]
    assert found["imports of the front door"] == ["exo_pin.ik.c"]


def test_every_kind_of_module_cache_is_found(structure, package):
    package(
        a="@lru_cache\ndef f(): ...\n\n\nKNOWN: dict = {}\nDATA = {1: 2}\nW = weakref.WeakKeyDictionary()\n"
    )
    assert len(structure.places()["caches of modules"]) == 3


def test_words_count_in_prose_and_not_in_names(structure, package, tmp_path):
    package(a='"""What was said."""\ntold = 1\n# told\nprint(f"a {told} b")\nprint(f"told {told}")\n')
    (tmp_path / "README.md").write_text("Nothing.\nThere is none.\n", "utf-8")
    (tmp_path / "CHANGELOG.md").write_text("It was said then.\n", "utf-8")
    places = [place.partition(": ")[0] for place in structure.prose(structure.RIDDLES)]
    assert places == ["exo_pin/a.py:1", "exo_pin/a.py:3", "exo_pin/a.py:5", "README.md:2"]


def test_lengths_leave_out_the_docstring(structure, package):
    package(a='def f(a, b, c):\n    """One.\n\n    Args:\n        a: A.\n    """\n    x = 1\n    return x\n')
    assert structure.body_lengths() == [(2, "exo_pin.a.f")]
    assert structure.many_parameters() == [("exo_pin.a.f", True)]
    assert structure.spread([(9, "x"), (3, "y"), (1, "z")]) == "3 / 9 / 9"
