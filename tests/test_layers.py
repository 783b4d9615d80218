"""The floors of the house: a module imports only from lower floors, and some rooms stay pure."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1] / "exo_pin"
FLOORS = [
    {"errors", "version", "arrays", "physics", "frozen_fields"},
    {"files"},
    {"safe", "cache", "examples"},
    {"anatomy"},
    {"devices"},
    {"description", "dh", "gait", "signals"},
    {"robot", "formats"},
    {"kinematics"},
    {"ik", "demand", "ground"},
    {"dynamics"},
    {"compare", "markers", "retarget", "walking"},
    {"feasible", "sizing", "control"},
    {"edit", "simulation"},
    {"crosscheck", "export", "study"},
    {"viewer", "report", "plot"},
    {"cli"},
    {"__init__", "__main__"},
]
GROUND = {"errors", "arrays", "physics", "frozen_fields", "files", "cache", "anatomy", "devices"}
FLOOR = {room: k for k, rooms in enumerate(FLOORS) for room in rooms}
ONLY = {  # what comes from elsewhere is imported here and nowhere else
    "xacro": {"description"},
    "meshcat": {"viewer"},
    "argparse": {"cli"},
    "rich": {"cli"},
    "yourdfpy": {"crosscheck"},
    "joblib": {"study"},
}
HEAVY = {"meshcat", "yourdfpy", "matplotlib", "scipy", "ezc3d", "tornado", "PIL", "joblib"}
FILES = sorted(PACKAGE.rglob("*.py"))


def dotted(path):
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts).removesuffix(".__init__")


MODULES = {dotted(path) for path in FILES}


def room(path):
    return path.relative_to(PACKAGE).with_suffix("").parts[0]


def imports(path, *, top_level=False):
    """Dotted names that a file imports; those in functions and under TYPE_CHECKING too unless `top_level`."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    nodes = ast.iter_child_nodes(tree) if top_level else ast.walk(tree)
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                name = f"{node.module}.{alias.name}"
                yield name if name in MODULES else node.module


def ours(name):
    return name.split(".")[1] if name.startswith("exo_pin.") else None


def test_every_room_has_a_floor():
    assert {room(path) for path in FILES} <= set(FLOOR)


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_a_module_imports_only_from_lower_floors(path):
    here = room(path)
    if here == "__init__":
        return  # the front door names every room
    for name in imports(path):
        other = ours(name)
        if other and other != here and other in FLOOR:
            assert FLOOR[other] < FLOOR[here], f"{path} imports {name}"


@pytest.mark.parametrize("path", [p for p in FILES if room(p) in ("dh", "gait")], ids=lambda p: p.name)
def test_witness_and_gait_know_only_numpy_and_the_ground_floor(path):
    for name in imports(path):
        other = ours(name)
        if other:
            assert other in GROUND | {room(path)}
        else:
            assert name.split(".")[0] not in {"pinocchio", "xacro", "scipy", "yourdfpy", "meshcat"}


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_foreign_packages_stay_in_their_rooms(path):
    for name in imports(path):
        rooms = ONLY.get(name.split(".")[0])
        assert rooms is None or room(path) in rooms, f"{path} imports {name}"


@pytest.mark.parametrize("path", [p for p in FILES if room(p) not in ("viewer",)], ids=lambda p: p.name)
def test_heavy_packages_are_imported_where_they_are_needed(path):
    assert not {name.split(".")[0] for name in imports(path, top_level=True)} & HEAVY


def test_rooms_do_not_import_each_other_in_circles():
    graph = {dotted(path): set(imports(path, top_level=True)) for path in FILES}
    done, open_now = set(), []

    def visit(name):
        assert name not in open_now, " -> ".join([*open_now, name])
        if name in done or name not in graph:
            return
        open_now.append(name)
        for other in graph[name]:
            if other != name:
                visit(other)
        open_now.pop()
        done.add(name)

    for name in graph:
        if name not in ("exo_pin", "exo_pin.__main__"):
            visit(name)
