"""The settings of the site: every public name has an entry with a docstring, links lead to chapters."""

import importlib.util
import inspect
import re
from pathlib import Path

import pytest

import exo_pin

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def conf():
    spec = importlib.util.spec_from_file_location("site_conf", ROOT / "docs" / "conf.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def pages(conf):
    return conf.generated()


def test_every_public_name_has_an_entry(pages):
    for name in exo_pin.__all__:
        value = getattr(exo_pin, name)
        if inspect.ismodule(value):
            assert f"reference/{name}.rst" in pages
            assert value.__all__
        else:
            assert any(
                re.search(rf"^\.\. auto\w+:: exo_pin\.\w+\.{name}$", page, re.M) for page in pages.values()
            )


def test_every_entry_has_a_docstring(conf):
    for room, module in conf.rooms().items():
        for name in module.__all__:
            value = getattr(module, name)
            own = inspect.ismodule(value) or inspect.isclass(value) or inspect.isroutine(value)
            assert inspect.getdoc(value) if own else conf.docstring_of_data(module, name), f"{room}.{name}"


def test_links_of_generated_chapters_lead_to_a_page(conf, pages):
    for name, text in pages.items():
        for link in re.findall(r"\]\((?!http)([^)\s#]+)", text) if name.endswith(".md") else ():
            assert link in pages or (conf.GENERATED / link).resolve().exists(), (name, link)


def test_every_page_is_in_the_table_of_contents(pages):
    index = (ROOT / "docs" / "index.md").read_text("utf-8")
    listed = set(re.findall(r"^(?:.*<)?([\w/*]+)>?$", index, re.M))
    assert {path.stem for path in (ROOT / "docs").glob("*.md")} - {"index"} <= listed
    assert {f"generated/{Path(name).stem}" for name in pages if name.endswith(".md")} <= listed
    assert "generated/reference/*" in listed
