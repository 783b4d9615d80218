"""Results kept between runs: checked, whole, private, and missing without harm."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import threading
import time

import pytest

from exo_pin import cache, description
from exo_pin.anatomy import Body
from exo_pin.cli import main
from tests.other_user import NOBODY, reachable

NAME, OTHER = cache.key(["a"]), cache.key(["b"])
FILE = f"kind-{NAME}"
AT_ONCE = 1.0  # [s]; a pipe without a writer would be waited for for ever


@pytest.fixture
def home(tmp_path, monkeypatch):
    folder = tmp_path / "deep" / "cache"
    monkeypatch.setenv(cache.VARIABLE, str(folder))
    return folder


def test_what_is_kept_is_recalled(home):
    cache.keep("kind", "name", b"\0\xffdata")
    assert cache.recall("kind", "name") == b"\0\xffdata"
    assert cache.recall("kind", "other") is None
    assert cache.recall("other", "name") is None


def test_only_the_user_may_enter_the_folder(home):
    cache.keep("kind", "name", b"data")
    assert home.stat().st_mode & 0o077 == 0
    assert sorted(file.name for file in home.iterdir()) == ["key", "kind-name"]  # no draft is left
    assert {file.stat().st_mode & 0o777 for file in home.iterdir()} == {0o600}


def test_files_are_private_whatever_the_umask_says(home):
    before = os.umask(0)
    try:
        cache.keep("kind", NAME, b"data")
    finally:
        os.umask(before)
    assert {file.stat().st_mode & 0o777 for file in home.iterdir()} == {0o600}
    assert home.stat().st_mode & 0o777 == 0o700


def plant_pipe(file):
    os.mkfifo(file)


def plant_link(file):
    elsewhere = file.with_name("elsewhere")
    file.rename(elsewhere)
    file.symlink_to(elsewhere)


def plant_folder(file):
    file.mkdir()


def plant_shared_file(file):
    file.chmod(0o664)


def plant_device(file):
    os.mknod(file, 0o600 | 0o020000, os.makedev(1, 5))  # /dev/zero


@pytest.mark.parametrize("plant", [plant_pipe, plant_link, plant_folder, plant_shared_file, plant_device])
@pytest.mark.parametrize("name", [FILE, "key"])
def test_what_is_no_plain_file_of_ones_own_is_neither_read_nor_waited_for(home, plant, name):
    cache.keep("kind", NAME, b"data")
    file = home / name
    if plant not in (plant_link, plant_shared_file):
        file.unlink()
    try:
        plant(file)
    except PermissionError:
        pytest.skip("only root may make a device")
    start = time.monotonic()
    assert cache.recall("kind", NAME) is None
    entry, _ = cache.refused_entry()
    assert entry == file
    cache.keep("kind", NAME, b"new")
    assert time.monotonic() - start < AT_ONCE
    if plant is not plant_folder:  # the others are replaced, and a link is not followed
        assert cache.recall("kind", NAME) == b"new"
        assert cache.refused_entry() is None
    if plant is plant_link:
        assert (home / "elsewhere").read_bytes()[-3:] != b"new"


def test_a_folder_that_is_a_link_or_writable_by_others_is_not_used(home, capsys):
    cache.keep("kind", NAME, b"data")
    home.chmod(0o770)
    assert cache.recall("kind", NAME) is None
    cache.keep("kind", OTHER, b"data")
    assert not (home / f"kind-{OTHER}").exists()
    assert main(["devices"]) == 0
    (note,) = capsys.readouterr().err.splitlines()
    assert note.startswith(f"note: the cache {home} is not used: others may write to it (mode 770)")
    home.chmod(0o700)
    home.rename(home.with_name("real"))
    home.symlink_to(home.with_name("real"))
    assert cache.recall("kind", NAME) is None
    assert main(["cache", "--clear"]) == 2
    assert "a link" in capsys.readouterr().err
    assert len(list(home.with_name("real").iterdir())) == 2


def test_planted_content_is_not_believed(home, tmp_path, monkeypatch):
    """Neither a result of another cache, nor one under another name, nor the first seal's plain digest."""
    cache.keep("kind", NAME, b"data")
    (home / FILE).rename(home / f"kind-{OTHER}")
    assert cache.recall("kind", OTHER) is None
    monkeypatch.setenv(cache.VARIABLE, str(tmp_path / "mallory"))
    cache.keep("kind", NAME, b"planted")
    monkeypatch.setenv(cache.VARIABLE, str(home))
    shutil.copy(tmp_path / "mallory" / FILE, home / FILE)
    assert cache.recall("kind", NAME) is None


STRANGER = """
import os, sys
for folder, _, files in os.walk(sys.argv[1]):
    for name in files:
        try:
            print("read", name, open(os.path.join(folder, name), "rb").read())
        except OSError:
            print("refused", name)
print("user", os.geteuid(), os.access(sys.argv[1], os.R_OK))
"""


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root can be another user")
def test_another_user_reads_nothing_and_plants_nothing(home, tmp_path, capsys):
    cache.keep("kind", NAME, b"a patient's walk")
    reachable(home.parent)
    home.chmod(0o755)  # as if the user had opened it: the files are private all the same
    python = shutil.which("python3", path="/usr/bin")
    if python is None:
        pytest.skip("needs a Python that other users may run")
    done = subprocess.run(
        [python, "-I", "-c", STRANGER, str(home)],
        user=NOBODY, group=NOBODY, extra_groups=[], capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert f"user {NOBODY} True" in done.stdout
    assert "patient" not in done.stdout
    assert done.stdout.count("refused") == 2
    os.chown(home / FILE, NOBODY, NOBODY)
    assert cache.recall("kind", NAME) is None
    os.chown(home / FILE, 0, 0)
    os.chown(home, NOBODY, NOBODY)
    assert cache.recall("kind", NAME) is None
    assert main(["devices"]) == 0
    assert f"another user (uid {NOBODY})" in capsys.readouterr().err
    assert main(["cache", "--clear"]) == 2
    assert (home / FILE).exists()


def test_no_cache_keeps_and_recalls_nothing_and_only_for_that_run(home, capsys):
    assert main(["urdf", "--no-cache"]) == 0
    assert main(["--no-cache", "urdf"]) == 0
    assert not home.exists()
    assert os.environ[cache.VARIABLE] == str(home)
    assert main(["urdf"]) == 0
    assert home.exists()
    capsys.readouterr()


def test_the_command_shows_what_is_kept_and_deletes_only_that(home, capsys):
    assert main(["cache", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["holds"] == {}
    cache.keep("scene", NAME, b"x" * 2_000_000)
    cache.keep("urdf", NAME, b"x")
    (home / "mine.txt").write_text("of the user")
    (home / ".scene-x.0123.part").write_text("a draft of a killed run")
    assert main(["cache"]) == 0
    said = capsys.readouterr().out
    assert f"{home}: 2.0 MB" in said
    assert "1 last pictures" in said
    assert main(["cache", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["holds"]["scene"] == {"results": 1, "bytes": 2_000_032}
    assert main(["cache", "--clear"]) == 0
    assert "2 results deleted" in capsys.readouterr().out
    assert [file.name for file in home.iterdir()] == ["mine.txt"]
    (home / "mine.txt").unlink()
    cache.keep("urdf", NAME, b"x")
    assert main(["cache", "--clear"]) == 0
    assert not home.exists()


@pytest.mark.parametrize("damage", [b"", b"short", b"x" * 500])
def test_what_is_damaged_is_not_recalled(home, damage):
    cache.keep("kind", "name", b"data" * 100)
    (home / "kind-name").write_bytes(damage)
    assert cache.recall("kind", "name") is None


def test_a_changed_byte_is_noticed(home):
    cache.keep("kind", "name", b"data" * 100)
    content = bytearray((home / "kind-name").read_bytes())
    content[-1] ^= 1
    (home / "kind-name").write_bytes(content)
    assert cache.recall("kind", "name") is None


def test_nothing_is_kept_where_nothing_may_be(monkeypatch, tmp_path):
    monkeypatch.setenv(cache.VARIABLE, "")
    assert cache.folder() is None
    cache.keep("kind", "name", b"data")
    assert cache.recall("kind", "name") is None
    file = tmp_path / "file"
    file.write_text("in the way")
    monkeypatch.setenv(cache.VARIABLE, str(file / "folder"))
    cache.keep("kind", "name", b"data")  # fails in silence
    assert cache.recall("kind", "name") is None


def test_the_folder_follows_the_systems_custom(monkeypatch, tmp_path):
    monkeypatch.delenv(cache.VARIABLE)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache.folder() == tmp_path / "exo_pin"


def test_the_oldest_go_when_there_are_many(home):
    for k in range(cache.MOST_RESULTS + 5):
        cache.keep("kind", str(k), b"data")
        os.utime(home / f"kind-{k}", (k, k))
    cache.keep("other", "name", b"data")
    assert cache.recall("kind", "0") is None
    assert cache.recall("kind", str(cache.MOST_RESULTS + 4)) == b"data"
    assert len(list(home.glob("kind-*"))) <= cache.MOST_RESULTS


def test_writers_at_the_same_time_leave_a_whole_result(home):
    def write(k):
        cache.keep("kind", "name", bytes([k]) * 100_000)

    threads = [threading.Thread(target=write, args=(k,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    data = cache.recall("kind", "name")
    assert len(data) == 100_000
    assert len(set(data)) == 1


def test_parts_do_not_run_into_each_other():
    assert cache.key(["ab", "c"]) != cache.key(["a", "bc"]) != cache.key(["abc"])
    assert cache.key(["a", b"b"]) == cache.key([b"a", "b"])


def test_a_urdf_of_an_earlier_run_is_the_same_text(home):
    body = Body.from_stature(1.681)
    first = description.urdf(body)
    assert sorted(file.name.split("-")[0] for file in home.iterdir()) == ["key", "urdf"]
    assert description.urdf(body) == first
    other = description.urdf(Body.from_stature(1.682))
    assert other != first
    assert len(list(home.glob("urdf-*"))) == 2


def test_a_change_of_the_sources_makes_a_new_urdf(home, monkeypatch):
    body = Body.from_stature(1.683)
    description.urdf(body)
    makers = description._makers()
    monkeypatch.setattr(description, "_makers", lambda: (*makers[:-1], makers[-1] + b"<!-- changed -->"))
    description.urdf(body)
    assert len(list(home.glob("urdf-*"))) == 2
