"""What is not installed costs what needs it, and nothing else: one line, never a traceback."""

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from exo_pin.cli import installation, main, missing

ROOT = Path(__file__).resolve().parents[2]
HIDING = """
import importlib.metadata, sys
hidden = set(sys.argv.pop(1).split(","))
class Hidden:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in hidden:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
sys.meta_path.insert(0, Hidden())
real = importlib.metadata.distribution
def distribution(name):
    if name in hidden:
        raise importlib.metadata.PackageNotFoundError(name)
    return real(name)
importlib.metadata.distribution = distribution
if "example-robot-data" in hidden:
    sys.path = [entry for entry in sys.path if "site-packages" not in entry] + list(map(Linked, sys.path))
from exo_pin.cli import main
sys.exit(main(sys.argv[1:]))
"""
LINKED = """
class Linked(str):
    \"\"\"An entry of sys.path beside which no robot data are found.\"\"\"
    def __format__(self, spec):
        return "/nowhere"
"""


def without(hidden, *words, **env):
    """The command line in a process in which some modules and packages do not exist."""
    call = [sys.executable, "-c", LINKED + HIDING, hidden, *map(str, words)]
    return subprocess.run(call, capture_output=True, text=True, cwd=ROOT, env=os.environ | env)


def notes(run):
    return [line for line in run.stderr.splitlines() if line.startswith("note:")]


def test_the_list_of_packages_is_that_of_the_project():
    wanted = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    names = {line.partition(">")[0] for line in wanted}
    assert set(missing.PACKAGES) == names


@pytest.mark.parametrize("words", [["devices"], ["body"], ["urdf"], ["convert", "free", "{out}"]])
def test_without_pinocchio_files_and_descriptions_still_work(words, tmp_path):
    run = without("pinocchio", *[word.format(out=tmp_path / "walk.csv") for word in words])
    assert (run.returncode, run.stderr) == (0, "")


@pytest.mark.parametrize("command", ["check", "replay"])
def test_without_pinocchio_one_line_names_conda_forge_and_wsl(command):
    run = without("pinocchio", command)
    (line,) = run.stderr.splitlines()
    assert run.returncode == 2
    assert "conda-forge" in line
    assert "WSL" in line
    assert "pip install pin" in line


def test_without_yourdfpy_the_other_witnesses_check():
    run = without("yourdfpy", "check", "--json")
    assert run.returncode == 0
    (note,) = notes(run)
    assert "yourdfpy is not installed" in note
    assert set(json.loads(run.stdout)["fk_max_difference"]) == {"recursion", "dh"}


def test_without_the_figure_the_player_has_no_wearer_and_says_so_once(tmp_path):
    page = tmp_path / "walk.html"
    run = without("example-robot-data", "replay", "--html", page)
    assert run.returncode == 0
    (note,) = notes(run)
    assert "example-robot-data" in note
    assert "exoskeleton" in page.read_text().lower()


def test_without_a_package_an_unknown_module_is_no_answer():
    """A name that is no dependency is a fault of this package, to be seen in full."""
    assert missing.sentence(ModuleNotFoundError("no", name="exo_pin.nothing")) is None
    assert missing.sentence(ModuleNotFoundError("no", name="scipy.signal")) is not None


def test_without_a_browser_a_picture_is_one_line(tmp_path):
    run = without("nothing", "picture", "-o", tmp_path / "walk.png", PATH="/nowhere", EXO_PIN_CHROMIUM="")
    assert run.returncode == 2
    assert "chromium" in run.stderr.splitlines()[-1].lower()
    assert "Traceback" not in run.stderr


def test_robot_data_of_conda_are_found_by_their_folder(tmp_path, monkeypatch):
    from exo_pin import examples

    known = examples.located("human_description/robots/human.urdf")
    monkeypatch.setattr(examples, "_files", lambda wanted: [])
    monkeypatch.setattr(sys, "path", [])
    assert examples.located("human_description/robots/human.urdf") is None
    (tmp_path / "share").mkdir()
    (tmp_path / "share" / "example-robot-data").symlink_to(known.parents[3])
    monkeypatch.setenv("CONDA_PREFIX", str(tmp_path))
    assert examples.located("human_description/robots/human.urdf").samefile(known)
    assert examples.located("example-robot-data/package.xml") is not None


@pytest.mark.parametrize("module", ["exo_pin.formats.c3d.child_process", "exo_pin.xacro_files.restricted"])
def test_limits_of_a_child_need_no_module_of_posix(module, monkeypatch):
    monkeypatch.setitem(sys.modules, "resource", None)
    __import__(module, fromlist=["limit"]).limit(100, 10)


def test_the_doctor_finds_nothing_wrong_here_and_answers_a_program(capsys):
    assert main(["doctor", "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["ok"]
    names = [one["name"] for one in facts["checks"]]
    assert {"Python", "browser", "ffmpeg", "wearer's figure", "cache", "port", *missing.PACKAGES} == set(
        names
    )


def test_the_doctor_without_pinocchio_ends_with_one_and_the_cure():
    run = without("pinocchio,yourdfpy,rich", "doctor")
    assert run.returncode == 1
    assert "wrong: pin, rich" in run.stdout
    assert "conda-forge" in run.stdout


@pytest.mark.parametrize(
    ("found", "state"), [("1.9.9", "wrong"), ("2.0", "differs"), ("2.4.6", "ok"), ("2.5.5", "ok")]
)
def test_a_version_is_compared_with_lower_bound_and_lock(found, state, monkeypatch):
    monkeypatch.setattr(installation, "version", lambda name: found)
    assert installation._package("numpy", ("2.4.6", "2.5.5"), "2.0").state == state


def test_a_taken_port_and_a_refused_cache_have_a_cure(tmp_path, monkeypatch):
    import socket

    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        assert "--port 0" in installation._port(taken.getsockname()[1]).cure
    (tmp_path / "open").mkdir(mode=0o777)
    (tmp_path / "open").chmod(0o777)
    monkeypatch.setenv("EXO_PIN_CACHE", str(tmp_path / "open"))
    found = installation._cache()
    assert found.state == "wrong"
    assert "EXO_PIN_CACHE" in found.cure


def test_the_lock_is_found_beside_the_checkout():
    assert installation._locked()["numpy"]
