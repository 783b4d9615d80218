"""Private folders: for their owner alone, gone at every end."""

from __future__ import annotations

import os
import stat
import subprocess
import sys

import pytest

from exo_pin import scratch

HOLDER = (
    "import sys, time; from pathlib import Path; from exo_pin import scratch\n"
    "with scratch.folder(Path(sys.argv[1])) as path:\n"
    "    (path / 'walk').write_text('x'); print(path, flush=True); time.sleep(60)"
)


def test_it_is_for_its_owner_alone_and_goes_with_all_that_is_in_it(tmp_path):
    old = os.umask(0)
    try:
        with scratch.folder(tmp_path) as path:
            assert stat.S_IMODE(path.stat().st_mode) == 0o700
            (path / "deep").mkdir()
            (path / "deep" / "walk").write_text("x")
    finally:
        os.umask(old)
    assert list(tmp_path.iterdir()) == []


def test_it_goes_when_what_is_inside_fails(tmp_path):
    with pytest.raises(KeyboardInterrupt), scratch.folder(tmp_path):
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == []


def test_the_folder_of_a_killed_run_is_swept_by_the_next_and_that_of_a_living_one_is_not(tmp_path):
    command = [sys.executable, "-c", HOLDER, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as other:
        held = other.stdout.readline().strip()
        scratch.sweep(tmp_path)
        with scratch.folder(tmp_path) as path:
            assert {str(each) for each in tmp_path.iterdir()} == {held, str(path)}
            scratch.sweep(tmp_path)  # nor this run's own
            assert path.exists()
        other.kill()
    assert os.path.exists(held)
    with scratch.folder(tmp_path) as path:
        assert list(tmp_path.iterdir()) == [path]


def test_what_is_not_ours_is_left_alone(tmp_path):
    with scratch.folder(tmp_path) as path:
        prefix = path.name[: -len(path.name.rpartition("-")[2])]
    treasure = tmp_path / "treasure"
    treasure.mkdir()
    (treasure / "kept").write_text("x")
    (tmp_path / f"{prefix}link").symlink_to(treasure)
    (tmp_path / f"{prefix}file").write_text("x")
    (tmp_path / "exo_pin-mine").mkdir()
    if os.geteuid() == 0:
        other = tmp_path / f"{prefix}other"
        other.mkdir()
        os.chown(other, 65534, 65534)
    before = set(tmp_path.iterdir())
    scratch.sweep(tmp_path)
    assert set(tmp_path.iterdir()) == before
    assert (treasure / "kept").exists()
