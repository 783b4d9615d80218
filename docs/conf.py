"""Settings of the site: chapters from the Markdown pages, a reference page for each room from its `__all__`.

`scripts/docs` builds it. Every build writes `docs/generated/` anew; git ignores that folder.
"""

import ast
import importlib
import inspect
import pkgutil
import re
from pathlib import Path
from types import ModuleType
from typing import Any

import exo_pin
from exo_pin.version import __version__

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
GENERATED = HERE / "generated"
OUTSIDE = ("README", "CONTRIBUTING", "SECURITY", "CHANGELOG")
"""Pages at the root of the repository that are chapters too."""

project = "exo_pin"
author = "The exo_pin authors"
version = release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
html_theme = "furo"
html_title = f"exo_pin {release}"
html_copy_source = False
html_show_copyright = False
default_role = "code"  # docstrings put code in single backticks

myst_heading_anchors = 3
napoleon_numpy_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 100


def rooms() -> dict[str, ModuleType]:
    """Every room of the package that has public names, by its name."""
    names = [found.name for found in pkgutil.iter_modules(exo_pin.__path__) if found.name != "__main__"]
    modules = {name: importlib.import_module(f"exo_pin.{name}") for name in names}
    return {name: module for name, module in modules.items() if getattr(module, "__all__", ())}


def entry(module: ModuleType, name: str) -> str:
    """The directive that shows one public name with its docstring."""
    value, path = getattr(module, name), f"{module.__name__}.{name}"
    if inspect.ismodule(value):
        return f".. automodule:: {value.__name__}\n   :members:\n"
    if inspect.isclass(value):
        kind = "exception" if issubclass(value, BaseException) else "class"
        return f".. auto{kind}:: {path}\n   :members:\n"
    if inspect.isroutine(value):
        return f".. autofunction:: {path}\n"
    return f".. autodata:: {path}\n   :no-value:\n"


def reference_page(module: ModuleType) -> str:
    """The docstring of a room, and an entry for each of its public names."""
    title = module.__name__
    head = f"{title}\n{'=' * len(title)}\n\n.. py:module:: {title}\n\n{inspect.getdoc(module)}\n"
    return "\n".join([head, *(entry(module, name) for name in sorted(module.__all__))])


def chapter(text: str) -> str:
    """A page at the root of the repository, its links as they are from the folder of generated pages."""
    text = re.sub(rf"\]\(({'|'.join(OUTSIDE)})\.md", lambda m: f"]({m[1].lower()}.md", text)
    return text.replace("](docs/gallery)", "](gallery.md)").replace("](docs/", "](../")


def gallery() -> str:
    """The example scripts as one page."""
    lines = [
        "# Gallery",
        "Scripts of the folder `docs/gallery` that run as they are; a test runs each.",
    ]
    for path in sorted((HERE / "gallery").glob("*.py")):
        title, _, code = path.read_text("utf-8").removeprefix('"""').partition('"""\n')
        lines += [f"## {path.stem.replace('_', ' ').capitalize()}", title, f"```python\n{code.strip()}\n```"]
    return "\n\n".join(lines) + "\n"


def generated() -> dict[str, str]:
    """Every generated page by its path below the folder."""
    pages = {f"reference/{room}.rst": reference_page(module) for room, module in rooms().items()}
    pages["gallery.md"] = gallery()
    return pages | {f"{n.lower()}.md": chapter((ROOT / f"{n}.md").read_text("utf-8")) for n in OUTSIDE}


def write_generated(app: Any) -> None:
    """Write the generated pages, except what has not changed: Sphinx reads a page again that is newer."""
    pages = {GENERATED / name: text for name, text in generated().items()}
    (GENERATED / "reference").mkdir(parents=True, exist_ok=True)
    for path in {*GENERATED.rglob("*.md"), *GENERATED.rglob("*.rst")} - set(pages):
        path.unlink()
    for path, text in pages.items():
        if not path.exists() or path.read_text("utf-8") != text:
            path.write_text(text, encoding="utf-8")


def docstring_of_data(module: ModuleType, name: str) -> str:
    """The text below an assignment, in the module that makes it: Python keeps no docstring for data."""
    body = ast.parse(inspect.getsource(module)).body
    for node, after in zip(body, [*body[1:], ast.Pass()], strict=True):
        if isinstance(node, ast.ImportFrom):
            for alias in node.names:
                if (alias.asname or alias.name) == name:
                    return docstring_of_data(importlib.import_module(str(node.module)), alias.name)
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        if any(isinstance(one, ast.Name) and one.id == name for one in targets):
            text = getattr(getattr(after, "value", None), "value", None)
            return inspect.cleandoc(text) if isinstance(text, str) else ""
    return ""


def prepare_docstring(app: Any, what: str, name: str, value: Any, options: Any, lines: list[str]) -> None:
    """Give a constant the text below it; keep napoleon from taking the words before a colon for a type."""
    if what == "data":
        module, _, last = name.rpartition(".")
        lines[:] = [*docstring_of_data(importlib.import_module(module), last).splitlines(), ""]
    if what in {"data", "attribute", "property"}:
        lines[:0] = ["..", ""]  # an empty comment: napoleon looks at the first line alone


def link_chapters(app: Any, docname: str, source: list[str]) -> None:
    """Lead a page's links to pages at the root of the repository to their chapters."""
    found = rf"\]\(\.\./({'|'.join(OUTSIDE)})\.md"
    source[0] = re.sub(found, lambda m: f"](generated/{m[1].lower()}.md", source[0])


def skip_field(app: Any, what: str, name: str, value: Any, skip: bool, options: Any) -> bool | None:
    """Leave out fields of a NamedTuple whose only text is Python's own: the class describes them."""
    return True if str(getattr(value, "__doc__", "")).startswith("Alias for field number") else None


def setup(app: Any) -> None:
    """Connect the above to Sphinx."""
    app.connect("builder-inited", write_generated)
    app.connect("autodoc-process-docstring", prepare_docstring, priority=400)  # napoleon comes at 500
    app.connect("autodoc-skip-member", skip_field)
    app.connect("source-read", link_chapters)
