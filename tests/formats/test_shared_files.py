"""Every file of the shared recordings goes through the commands: a walk comes out, or one clear line."""

from __future__ import annotations

from pathlib import Path

import pytest

from exo_pin.cli import main

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "data"
FILES = sorted(path for path in FOLDER.rglob("*") if path.is_file())
WALKS = {
    "HC036A01_static.c3d",
    "HC036A10_walk.c3d",
    "subject01_walk1.trc",
    "subject01_walk1_ik.mot",
    "subject01_walk1_ik_full_opensim46.mot",
}
REASONS = {  # why the others hold no walk
    "subject01_walk1_grf.mot": "holds forces or moments",
    "subject01_walk1_id.sto": "holds forces or moments",
    ".osim": "holds no motion; name it as the model of a .mot",
    ".xml": "a setup holds no motion",
    ".csv": "are not ours",
    ".txt": "no header line with the mapped columns",
    ".md": "unknown kind of file",
}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
@pytest.mark.parametrize("command", ["info", "convert"])
def test_a_file_is_a_walk_or_says_in_one_line_what_it_is(capsys, tmp_path, path, command):
    words = [command, str(path), *([str(tmp_path / "walk.npz")] if command == "convert" else [])]
    code = main(words)
    out, err = capsys.readouterr()
    if path.name in WALKS:
        assert (code, bool(out)) == (0, True)
        assert "read: " in err
        return
    reason = REASONS.get(path.name) or REASONS[path.suffix]
    assert (code, out, len(err.splitlines())) == (2, "", 1)
    assert reason in err
    assert path.name in err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", sorted(name for name in WALKS if "full" not in name))
def test_a_recording_is_replayed_as_a_page(capsys, tmp_path, shared, name):
    path = next(path for path in FILES if path.name == name)
    assert main(["replay", str(path), "--html", str(tmp_path / "walk.html")]) == 0
    assert "feet reached" in capsys.readouterr().out
    assert "<html" in (tmp_path / "walk.html").read_text()[:500]
