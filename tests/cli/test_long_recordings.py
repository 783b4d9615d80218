"""Long recordings: commands keep within a bound of memory."""

import subprocess
import sys

import numpy as np
import pytest

from exo_pin.formats import save_gait
from exo_pin.gait import Gait, normative_gait
from exo_pin.kinematics import contacts
from exo_pin.robot import load_robot

SAMPLES = 100_000
MOST_MB = 280  # 160 measured, of which the imports take 130; poses of all samples at once took 391


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    """A quarter of an hour on a treadmill, the pelvis as high as the standing foot carries it."""
    robot, cycle = load_robot(), normative_gait("free").resampled(100)
    lowest = contacts(robot, robot.from_gait(cycle)).height.min(axis=1)
    rounds = SAMPLES // len(cycle)
    base = np.tile(np.eye(4), (SAMPLES, 1, 1))
    base[:, 2, 3] = np.tile(robot.placement[2, 3] - lowest, rounds)
    base[:, 0, 3] = 0.02 * np.sin(0.1 * np.arange(SAMPLES))
    time = np.arange(SAMPLES) * cycle.duration / len(cycle)
    noise = np.random.default_rng(1).normal(0, 1e-4, (SAMPLES, 12))
    path = tmp_path_factory.mktemp("long") / "walk.npz"
    save_gait(Gait(time, np.tile(cycle.q, (rounds, 1)) + noise, base=base), path)
    return path


COMMAND = """
import re, sys
from pathlib import Path
from exo_pin.cli import main
code = main(sys.argv[1:])
status = Path("/proc/self/status").read_text()
print("peak of memory", re.search(r"VmHWM:\\s*(\\d+) kB", status)[1], file=sys.stderr)
sys.exit(code)
"""
"""What the child itself has used: the usage that its parent is told begins with the parent's own."""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="other systems have no /proc/self/status")
@pytest.mark.parametrize("command", ["info", "cycles"])
def test_a_hundred_thousand_samples_take_little_memory(recording, command):
    words = [sys.executable, "-c", COMMAND, command, str(recording)]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    assert "steps/min" in done.stdout
    peak = int(done.stderr.split("peak of memory")[1])
    assert peak / 1024 < MOST_MB
