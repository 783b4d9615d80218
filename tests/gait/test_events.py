"""Zeni's events are found in a walk, also a noisy one, and nowhere else."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.errors import GaitError
from exo_pin.gait import zeni
from exo_pin.gait.quaternions import rotations

PERIOD = 1.1
STANCE = 0.6  # of the cycle
SAMPLE = 0.01  # [s]
NOISE = 0.005  # [m] markers on skin
NOISY = 0.03  # [s] noise moves a flat top by a few samples; Zeni's own error is as large


def swing(t):
    """A foot about the pelvis [m]: back evenly in stance, forward in swing, struck at whole periods."""
    phase = (t / PERIOD) % 1
    back = 0.35 - 0.7 * phase / STANCE
    forward = -0.35 * np.cos(np.pi * (phase - STANCE) / (1 - STANCE))
    return np.where(phase < STANCE, back, forward)


def walk(t):
    """Heels and toes of both feet: (n, 2) each; the right foot half a period after the left."""
    feet = np.stack([swing(t), swing(t - PERIOD / 2)], axis=1)
    return feet - 0.05, feet + 0.15


def expected(start, end):
    moments = []
    for side, late in (("left", 0), ("right", 0.5)):
        for kind, phase in (("heel_strike", 0), ("toe_off", STANCE)):
            moments += [(PERIOD * (k + late + phase), kind, side) for k in range(-2, 20)]
    return [moment for moment in sorted(moments) if start < moment[0] < end]


def assert_events(found, wanted, tolerance):
    assert [(event.kind, event.side) for event in found] == [moment[1:] for moment in wanted]
    np.testing.assert_allclose(
        [event.time for event in found], [moment[0] for moment in wanted], atol=tolerance
    )


@given(start=st.floats(0, PERIOD), length=st.floats(2.5, 5))
def test_a_recording_yields_its_events_wherever_it_begins_and_ends(start, length):
    t = np.arange(start, start + length, SAMPLE)
    found = zeni(t, *walk(t))
    border = 0.1  # [s] events this close to an end cannot be told from the end
    for event in found:
        truth = [m[0] for m in expected(-9, 99) if m[1:] == (event.kind, event.side)]
        assert min(abs(event.time - time) for time in truth) < SAMPLE
    assert len(found) >= len(expected(start + border, t[-1] - border))


def test_noise_and_bumps_make_no_events(rng):
    t = np.arange(0.3, 6, SAMPLE)
    heel, toe = (x + NOISE * rng.normal(size=x.shape) + 0.005 * np.sin(40 * t)[:, None] for x in walk(t))
    assert_events(zeni(t, heel, toe), expected(0.3, 6), NOISY)


def test_one_bad_sample_does_not_hide_the_walk():
    t = np.arange(0.3, 6, SAMPLE)
    heel, toe = walk(t)
    heel[250, 0] = -3.0
    assert_events(zeni(t, heel, toe), expected(0.3, 6), SAMPLE)


def test_uneven_time_is_no_hindrance(rng):
    t = np.cumsum(rng.uniform(0.004, 0.016, 515))
    assert t[-1] > 4.95 + 0.05  # long enough past its last heel strike
    assert_events(zeni(t, *walk(t)), expected(t[0], t[-1]), 0.016)


@pytest.mark.parametrize("cycles", [1, 3])
@pytest.mark.parametrize("shift", [0.0, 0.2, 0.55, 0.9])
def test_a_periodic_walk_has_every_event_also_at_its_seam(cycles, shift):
    n = 110 * cycles
    t = PERIOD * cycles * np.arange(n) / n
    found = zeni(t, *walk(t + shift * PERIOD), periodic=True)
    assert len(found) == 4 * cycles
    wanted = [
        ((moment[0] - shift * PERIOD) % (cycles * PERIOD), *moment[1:])
        for moment in expected(-0.01, cycles * PERIOD - 0.01)
    ]
    for time, kind, side in wanted:
        gap = [
            abs((e.time - time + 0.5) % (cycles * PERIOD) - 0.5)
            for e in found
            if (e.kind, e.side) == (kind, side)
        ]
        assert min(gap) < SAMPLE
    assert all(0 <= event.time < cycles * PERIOD for event in found)


def test_the_parabola_finds_smooth_turns_between_the_samples():
    t = PERIOD * np.arange(23) / 23  # 48 ms steps
    y = np.stack([np.cos(2 * np.pi * (t / PERIOD - late)) for late in (0.31, 0.81)], axis=1)
    found = zeni(t, y, y, periodic=True)
    strikes = [event.time / PERIOD for event in found if event.kind == "heel_strike"]
    np.testing.assert_allclose(strikes, [0.31, 0.81], atol=1e-3)


def test_what_is_no_walk_is_refused(rng):
    t = np.arange(0, 5, SAMPLE)
    heel, toe = walk(t)
    still = 0.002 * rng.normal(size=heel.shape)
    for h, f, match in (
        (still, still, "left foot moves .* less than 0.05 m"),
        (heel[:, [0, 0]], toe[:, [0, 0]], "both feet move forward together"),  # a jump
        (heel, heel * [1, 0] + still, "right foot moves"),
        (np.outer(t, [1, -1]), np.outer(t, [1, -1]), "does not both strike"),
    ):
        with pytest.raises(GaitError, match="no gait cycles found.*" + match):
            zeni(t, h, f)
    short = t[t < 0.3]
    with pytest.raises(GaitError, match="no gait cycles found"):
        zeni(short, *walk(short))


def test_unusable_arrays_are_refused():
    t = np.arange(0, 5, SAMPLE)
    heel, toe = walk(t)
    holes = heel.copy()
    holes[3, 0] = np.nan
    for arguments in ((t, holes, toe), (t, heel[:-1], toe), (t, heel, toe[:, 0]), (t[::-1], heel, toe)):
        with pytest.raises(GaitError):
            zeni(*arguments)


FORCE_PLATES = [  # [s] README of the data: 20 N threshold
    (0.165, "toe_off", "right"),
    (0.618, "heel_strike", "right"),
    (0.788, "toe_off", "left"),
    (1.247, "heel_strike", "left"),
    (1.410, "toe_off", "right"),
    (1.853, "heel_strike", "right"),
    (2.018, "toe_off", "left"),
    (2.460, "heel_strike", "left"),
]
MEASURED = 0.035  # [s] DOMAIN.md section 5 promises about 30 ms for this recording


def test_events_of_the_recording_agree_with_the_force_plates(shared):
    with (shared / "opensim_subject01_walk" / "subject01_walk1_body_poses_full.csv").open() as file:
        rows = list(csv.DictReader(file))

    def column(*names):
        return np.array([[float(row[name]) for name in names] for row in rows])

    pelvis = column("pelvis_px")[:, 0]
    heels, toes = [], []
    for side in "lr":
        q = column(*(f"calcn_{side}_q{part}" for part in "wxyz"))
        R = rotations(q / np.linalg.norm(q, axis=1, keepdims=True))
        origin = column(f"calcn_{side}_px")[:, 0] - pelvis
        heels.append(origin)
        toes.append(origin + 0.18 * R[:, 0, 0])  # the ball, about 18 cm ahead along the foot's x axis
    found = zeni(column("time")[:, 0], np.transpose(heels), np.transpose(toes))
    assert_events(found, FORCE_PLATES, MEASURED)
