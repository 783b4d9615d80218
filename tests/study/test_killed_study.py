"""A study of recordings with two workers, killed for real and continued, ends with the same bytes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import pytest

from exo_pin.cli import main
from exo_pin.formats import save_gait
from exo_pin.gait import normative_gait

PATIENCE = 120.0  # [s]: what a busy machine may take
FEW = 3  # where the start of a worker costs more than the work
RECORDINGS = int(os.environ.get("EXO_PIN_RECORDINGS", FEW))  # EXO_PIN_RECORDINGS=500: a hospital's


def command(folder, table, jobs=2):
    words = [
        "study",
        "--recordings",
        folder,
        "--devices",
        "hk4",
        "--pelvis",
        "recorded",
        "--no-page",
        "--json",
    ]
    return [sys.executable, "-m", "exo_pin", *map(str, words), "-o", str(table), "--jobs", str(jobs)]


def killed(words, part, number, rows):
    """Start the command and send it a signal when so many rows are written; its exit code."""
    with subprocess.Popen(words, stderr=subprocess.PIPE, start_new_session=True) as process:
        end = time.monotonic() + PATIENCE + RECORDINGS
        while process.poll() is None and (not part.exists() or part.read_bytes().count(b"\n") < rows):
            assert time.monotonic() < end
            time.sleep(0.01)
        if number == signal.SIGKILL:  # as a power cut: the workers at once, too
            os.killpg(process.pid, number)
        else:
            process.send_signal(number)
        process.communicate(timeout=PATIENCE)
    return process.returncode


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no process groups of this kind")
def test_a_study_killed_twice_and_continued_has_the_same_bytes(tmp_path, capsys):
    folder = tmp_path / "walks"
    folder.mkdir()
    for k in range(RECORDINGS):
        speed = ("slow", "free", "fast")[k % 3]
        save_gait(normative_gait(speed, leg_length=0.85 + 0.0001 * k).resampled(20), folder / f"{k:03d}.csv")
    whole, table = tmp_path / "whole.csv", tmp_path / "killed.csv"
    assert main(command(folder, whole, jobs=1)[3:]) == 0
    part = tmp_path / "killed.csv.part"
    share = RECORDINGS // 3
    assert killed(command(folder, table), part, signal.SIGKILL, 1 + 2 * share) == -signal.SIGKILL
    assert killed(command(folder, table), part, signal.SIGTERM, 1 + 4 * share) == 128 + signal.SIGTERM
    assert not table.exists()
    capsys.readouterr()
    assert main(command(folder, table, jobs=2 if RECORDINGS > FEW else 1)[3:]) == 0
    assert '"kept": 0' not in capsys.readouterr().out
    assert table.read_bytes() == whole.read_bytes()
    assert not part.exists()
