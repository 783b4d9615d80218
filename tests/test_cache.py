"""Results kept between runs: checked, whole, private, and missing without harm."""

from __future__ import annotations

import os
import threading

import pytest

from exo_pin import cache, description
from exo_pin.anatomy import Body


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
    assert [file.name for file in home.iterdir()] == ["kind-name"]  # no draft is left


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
    assert [file.name.split("-")[0] for file in home.iterdir()] == ["urdf"]
    assert description.urdf(body) == first
    other = description.urdf(Body.from_stature(1.682))
    assert other != first
    assert len(list(home.iterdir())) == 2


def test_a_change_of_the_sources_makes_a_new_urdf(home, monkeypatch):
    body = Body.from_stature(1.683)
    description.urdf(body)
    makers = description._makers()
    monkeypatch.setattr(description, "_makers", lambda: (*makers[:-1], makers[-1] + b"<!-- changed -->"))
    description.urdf(body)
    assert len(list(home.iterdir())) == 2
