"""The front door: what `import exo_pin` offers, and what it does not load."""

import ast
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import exo_pin

ROOT = Path(__file__).resolve().parents[1]
DISTRIBUTION = {  # name of an import -> name of what is installed, where the two differ
    "PIL": "pillow",
    "coal": "pin",
    "example_robot_data": "example-robot-data",
    "pinocchio": "pin",
    "umsgpack": "u-msgpack-python",
    "yaml": "pyyaml",
}
DATA = {"example-robot-data"}
"""Read as files, never imported: robots' descriptions, the player's JavaScript."""
OPTIONAL = {"pandas", "xarray", "matplotlib", "opensim"}
"""Of extras: the witness is left out where they are not installed."""
HEAVY = ("pinocchio", "meshcat", "yourdfpy", "scipy", "matplotlib", "numpy", "tornado")


def _loaded(code):
    """Which heavy modules a fresh interpreter has after running code."""
    probe = f"{code}\nimport sys; print(*[m for m in {HEAVY!r} if m in sys.modules])"
    run = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    return set(run.stdout.splitlines()[-1].split())


def test_every_public_name_can_be_imported_and_is_listed():
    for name in exo_pin.__all__:
        assert getattr(exo_pin, name) is not None
    assert dir(exo_pin) == sorted(exo_pin.__all__)


def test_type_checkers_see_the_same_names():
    tree = ast.parse((ROOT / "exo_pin" / "__init__.py").read_text())
    block = next(node for node in tree.body if isinstance(node, ast.If))
    names = {alias.asname for node in block.body if isinstance(node, ast.ImportFrom) for alias in node.names}
    assert names == set(exo_pin.__all__)


def test_importing_the_package_loads_nothing_heavy():
    assert _loaded("import exo_pin") == set()


def test_help_loads_nothing_heavy():
    code = "from exo_pin.cli import main\ntry: main(['--help'])\nexcept SystemExit: pass"
    assert _loaded(code) == set()


def test_replay_s_help_does_not_load_the_viewer():
    code = "from exo_pin.cli import main\ntry: main(['replay', '--help'])\nexcept SystemExit: pass"
    assert _loaded(code) <= {"numpy"}


def test_the_version_is_that_of_the_project():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    assert project["tool"]["hatch"]["version"]["path"] == "exo_pin/version.py"
    assert f"version: {exo_pin.__version__}\n" in (ROOT / "CITATION.cff").read_text()


def test_every_package_that_is_imported_is_declared_and_no_other():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    declared = {re.split(r"[^\w-]", wanted)[0].lower() for wanted in project["dependencies"]}
    names = {
        name.split(".")[0]
        for path in (ROOT / "exo_pin").rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        for name in _imported(node)
    }
    foreign = names - {"exo_pin", "_typeshed", *OPTIONAL} - set(sys.stdlib_module_names)
    imported = {DISTRIBUTION.get(name, name) for name in foreign}
    assert imported <= declared - DATA
    assert declared - DATA <= imported


def _imported(node):
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    return [node.module] if isinstance(node, ast.ImportFrom) and node.module else []
