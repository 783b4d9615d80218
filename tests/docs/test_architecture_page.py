"""docs/architecture.md shows the floors, the errors and the tables that the code has."""

import importlib.util
import inspect
import re
import sys
from importlib.machinery import SourceFileLoader
from pathlib import Path

import pytest

from exo_pin import errors

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text("utf-8")


@pytest.fixture
def architecture(monkeypatch):
    """The script that writes the table."""
    monkeypatch.setattr(sys, "path", [str(ROOT / "scripts"), *sys.path])
    loader = SourceFileLoader("architecture", str(ROOT / "scripts" / "architecture"))
    spec = importlib.util.spec_from_loader("architecture", loader)
    assert spec
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    return module


def test_the_floors_are_those_that_the_imports_keep(architecture):
    written = PAGE.partition("<!-- floors -->\n")[2].partition("\n<!-- end -->")[0]
    assert written == architecture.floors_table(), "renew it with scripts/architecture"


def test_every_room_has_a_line_that_describes_it(architecture):
    rooms = {path.relative_to(architecture.PACKAGE).parts[0] for path in architecture.PACKAGE.rglob("*.py")}
    rows = re.findall(r"^\| \d+ \| `(\w+)/?` \| .+ \|$", architecture.floors_table(), flags=re.MULTILINE)
    assert {room.removesuffix(".py") for room in rooms} == set(rows)


def test_every_module_opens_with_a_sentence_on_one_line(architecture):
    contents = list(architecture.contents())
    assert len(contents) > 200
    for line in contents:
        name, _, sentence = line.partition(" ")
        assert sentence.strip().endswith((".", "?")), name


def test_the_tree_of_errors_is_the_one_in_the_code():
    drawn = set(re.findall(r"^[│├└─ ]*(\w+Error)\b", PAGE, flags=re.MULTILINE))
    known = {name for name, kind in vars(errors).items() if inspect.isclass(kind) and name.endswith("Error")}
    assert drawn == known
