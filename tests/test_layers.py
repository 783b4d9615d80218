"""The floors of the house: a module imports only from lower floors, and some rooms stay pure.

The imports between the package's own modules are read by scripts/structure, those for types included.
"""

import ast
import importlib.util
from importlib.machinery import SourceFileLoader
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
PACKAGE = REPOSITORY / "exo_pin"
FLOORS = [
    {"errors", "version", "arrays", "physics", "frozen_fields"},
    {"arguments", "files", "scratch", "chunks", "short_repr", "plugins"},
    {"safe", "cache", "examples"},
    {"ros_packages"},
    {"xacro_files"},
    {"anatomy"},
    {"html_summary"},
    {"devices"},
    {"description", "dh", "gait", "signals"},
    {"robot", "formats"},
    {"kinematics"},
    {"ik", "demand", "ground"},
    {"dynamics"},
    {"clinic", "compare", "markers", "retarget", "walking"},
    {"feasible", "sizing", "control"},
    {"edit", "simulation"},
    {"crosscheck", "export", "study"},
    {"viewer", "report", "plot"},
    {"cli"},
    {"__init__", "__main__"},
]
INNER_FLOORS = {  # of rooms with folders, in the same order; "." are the modules that no other entry names
    "formats": [
        {"sign_presets", "read_options", "trial_file", "units"},
        {"tables"},
        {"c3d", "opensim", "xsens"},
        {"motion_bids", "nexus"},
        {"."},
    ],
    "ik": [{"settings", "targets", "problem", "result"}, {"leg", "least_squares"}, {"."}],
    "report": [{"draw"}, {"document"}, {"sections"}, {"pages"}],
    "viewer": [{"drawing_commands"}, {"meshes"}, {"scenes"}, {"page"}, {"film", "live"}, {"."}],
    "cli": [{"."}, {"commands"}],
}
GROUND = {
    "errors",
    "arguments",
    "arrays",
    "chunks",
    "physics",
    "frozen_fields",
    "short_repr",
    "plugins",
    "html_summary",
    "files",
    "cache",
    "anatomy",
    "devices",
}
FLOOR = {room: k for k, rooms in enumerate(FLOORS) for room in rooms}
ONLY = {  # what comes from elsewhere is imported here and nowhere else
    "xacro": {"description", "xacro_files"},
    "meshcat": {"viewer"},
    "argparse": {"cli"},
    "rich": {"cli"},
    "yourdfpy": {"crosscheck"},
    "joblib": {"study"},
    "mujoco": {"crosscheck", "simulation", "export"},
    "opensim": {"crosscheck"},
}
HEAVY = {
    "meshcat",
    "yourdfpy",
    "matplotlib",
    "pandas",
    "xarray",
    "scipy",
    "ezc3d",
    "c3d",
    "tornado",
    "PIL",
    "joblib",
    "mujoco",
    "opensim",
}
FILES = sorted(PACKAGE.rglob("*.py"))


def dotted(path):
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts).removesuffix(".__init__")


def script(name):
    """A script of scripts/ as a module."""
    loader = SourceFileLoader(name, str(REPOSITORY / "scripts" / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


structure = script("structure")
GRAPH = structure.graph()
"""Module -> modules of the package that it imports."""


def room(path):
    return path.relative_to(PACKAGE).with_suffix("").parts[0]


def foreign(path, *, top_level=False):
    """Packages from elsewhere that a file imports, in functions and for types too unless `top_level`."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    nodes = ast.iter_child_nodes(tree) if top_level else ast.walk(tree)
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module.split(".")[0]


def ours(name):
    return name.split(".")[1] if name.startswith("exo_pin.") else None


def test_every_room_has_a_floor():
    assert {room(path) for path in FILES} <= set(FLOOR)


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_a_module_imports_only_from_lower_floors(path):
    here = room(path)
    if here == "__init__":
        return  # the front door names every room
    for name in GRAPH[dotted(path)]:
        other = ours(name) or "__init__"  # `import exo_pin` and `from exo_pin import load_robot` go up
        if other != here and here != "__main__":
            assert FLOOR[other] < FLOOR[here], f"{path} imports {name}"


def part_of(room, module):
    """The entry of `INNER_FLOORS` that a module of a room belongs to."""
    part = module.split(".")[2]
    return part if any(part in parts for parts in INNER_FLOORS[room]) else "."


@pytest.mark.parametrize("room", INNER_FLOORS)
def test_the_parts_of_a_room_keep_their_order(room):
    """Parts on one floor may import each other; the room's own `__init__` passes names on."""
    level = {part: k for k, parts in enumerate(INNER_FLOORS[room]) for part in parts}
    mine = {name for name in GRAPH if name.startswith(f"exo_pin.{room}.")}
    for name in mine:
        for other in GRAPH[name] & mine:
            here, there = (part_of(room, module) for module in (name, other))
            assert level[there] <= level[here], f"{name} imports {other}"


@pytest.mark.parametrize("room", INNER_FLOORS)
def test_every_part_of_a_room_has_a_floor_and_every_floor_a_part(room):
    folders = {path.name for path in (PACKAGE / room).iterdir() if (path / "__init__.py").exists()}
    modules = {path.stem for path in (PACKAGE / room).glob("*.py")} - {"__init__"}
    named = {part for parts in INNER_FLOORS[room] for part in parts} - {"."}
    assert folders <= named <= folders | modules


def test_no_command_imports_another():
    """What they share belongs beside the commands."""
    commands = {name for name in GRAPH if name.startswith("exo_pin.cli.commands.")}
    assert {(name, other) for name in commands for other in GRAPH[name] & commands} == set()


def test_a_file_name_has_one_meaning():
    """`SAME_MEANING` of scripts/structure gives each exception its reason."""
    assert structure.twice(structure.file_names()) == []
    stems = [path.stem for path in FILES]
    for name, reason in structure.SAME_MEANING.items():
        assert stems.count(name) > 1, f"{name} needs no exception"
        assert reason


def test_no_module_imports_the_front_door():
    assert structure.front_door() == []


def test_imports_are_absolute():
    """The graph of the imports would not see others."""
    for path in FILES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            assert not (isinstance(node, ast.ImportFrom) and node.level), path


@pytest.mark.parametrize("path", [p for p in FILES if room(p) in ("dh", "gait")], ids=lambda p: p.name)
def test_witness_and_gait_know_only_numpy_and_the_ground_floor(path):
    assert {ours(name) for name in GRAPH[dotted(path)]} <= GROUND | {room(path)}
    assert not {"pinocchio", "xacro", "scipy", "yourdfpy", "meshcat"} & set(foreign(path))


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_foreign_packages_stay_in_their_rooms(path):
    for name in foreign(path):
        rooms = ONLY.get(name)
        assert rooms is None or room(path) in rooms, f"{path} imports {name}"


@pytest.mark.parametrize("path", [p for p in FILES if room(p) not in ("viewer",)], ids=lambda p: p.name)
def test_heavy_packages_are_imported_where_they_are_needed(path):
    assert not set(foreign(path, top_level=True)) & HEAVY


def test_modules_do_not_import_each_other_in_circles():
    """Imports for types and in functions count."""
    assert structure.cycles() == []
