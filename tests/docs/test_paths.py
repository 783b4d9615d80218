"""Files, modules and names in the documentation exist."""

import importlib
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "SECURITY.md",
    *sorted((ROOT / "docs").glob("*.md")),
]
FILE = re.compile(r"(?<![\w/.])((?:exo_pin|tests|scripts|urdf|docs|\.ci)/[\w./-]*)")
each_page = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)


@each_page
def test_every_file_of_the_repository_that_a_page_names_exists(page):
    for path in FILE.findall(page.read_text("utf-8")):
        name = path.rstrip(".")  # the end of a sentence
        planned = re.sub(r"\bNAME\b.*", "", name)  # exo_pin/formats/NAME.py in a recipe: its folder
        assert (ROOT / planned).exists(), name


@each_page
def test_every_link_leads_to_a_file(page):
    for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text("utf-8")):
        if not link.startswith("http"):
            assert (page.parent / link.partition("#")[0]).exists(), link


@each_page
def test_every_module_and_name_of_the_package_that_a_page_names_exists(page):
    for dotted in re.findall(r"`(exo_pin(?:\.\w+)+)", page.read_text("utf-8")):
        head, *names = dotted.split(".")
        found = importlib.import_module(head)
        for k, name in enumerate(names):
            if not hasattr(found, name):
                found = importlib.import_module(".".join([head, *names[: k + 1]]))
            else:
                found = getattr(found, name)


@each_page
def test_every_test_file_that_a_page_names_exists(page):
    known = {path.stem for path in (ROOT / "tests").rglob("test_*.py")}
    named = set(re.findall(r"`(?:tests/[\w/]*/)?(test_\w+)(?:\.py)?`", page.read_text("utf-8")))
    assert named <= known


def test_every_promise_of_the_security_page_names_a_test():
    """A file that is not there is found by `test_every_file_of_the_repository_that_a_page_names_exists`."""
    promised = (ROOT / "SECURITY.md").read_text("utf-8").partition("## What is not promised")[0]
    rows = [line.strip("|").split("|") for line in promised.splitlines() if line.startswith("| ")][1:]
    assert len(rows) > 10
    for promise, *_, tests in rows:
        assert re.search(r"`tests/[\w/]+\.py`", tests), promise
