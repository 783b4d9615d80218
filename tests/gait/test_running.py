"""A run is recognised, its contacts are found when they happen, and nothing of a walk is said of it.

The runs are made with known contacts. Their vertical motion is that of a mass on a spring leg (Blickhan, J
Biomech 22 (1989) 1217-1227): a half sine while a foot stands, free fall while none does. A standing foot
rolls over heel and ball; a swinging one goes along a smooth path that meets the ground at a speed, as a
runner's does. Joint angles follow by inverse kinematics.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, PchipInterpolator

from exo_pin import ik
from exo_pin.anatomy import JOINTS, SIDES, Body
from exo_pin.errors import GaitError
from exo_pin.gait import SPEEDS, Event, Gait, cycles, manner, normative_gait
from exo_pin.gait.running_method import RUNNING_SOURCES
from exo_pin.gait.trial import ForcePlate
from exo_pin.kinematics import events, plausibility, walk_numbers, with_plates
from exo_pin.robot import load_robot

FRAMES = 0.033  # [s] two frames of 60 Hz: what kinematics may differ from the truth
G = 9.81
REACHED = 0.02  # [m] the legs can nearly do it; they are straight where they miss


@dataclass(frozen=True)
class Run:
    """A run and when its feet strike and leave."""

    stride: float = 0.72  # [s]
    duty: float = 0.36  # part of the stride that a foot stands
    speed: float = 3.0  # [m/s]
    landing: float = 0.25  # [rad] toes up at contact: heel first; negative: ball first
    fall: float = 0.9  # [m/s] vertical speed of the foot at contact
    strides: int = 6
    rate: float = 100.0
    treadmill: bool = False

    @property
    def end(self):
        return self.strides * self.stride

    def truth(self):
        """The contacts, those of the left foot at 0, 1, 2 ... strides."""
        found = []
        for k, side in enumerate(SIDES):
            for n in range(-1, self.strides + 1):
                strike = (n + k / 2) * self.stride
                found += [
                    Event(strike, "heel_strike", side),
                    Event(strike + self.duty * self.stride, "toe_off", side),
                ]
        return sorted((e for e in found if 0 <= e.time <= self.end), key=lambda e: e.time)

    def heights(self, t, top):
        """`(n,)` of the pelvis: `top` at touchdown and take-off."""
        contact = self.duty * self.stride
        flight = self.stride / 2 - contact
        rise = G * flight / 2
        s = np.mod(t, self.stride / 2)
        down = -rise * contact / np.pi * np.sin(np.pi * s / contact)
        up = rise * (s - contact) - G * (s - contact) ** 2 / 2
        return top + np.where(s < contact, down, up)

    def foot(self, body, phase):
        """Ahead of the pelvis, height [m] and pitch [rad] (toes up) of the sole, by phase 0 .. 1."""
        heel, ball = body.left_heel, body.left_ball
        contact = self.duty * self.stride
        ahead = 0.425 * self.speed * contact  # [m] the foot lands so far before the pelvis
        pitch_at = PchipInterpolator([0, 0.2, 0.5, 1.0], [self.landing, 0.0, 0.0, -0.95])  # over the stance
        s = np.linspace(0, 1, 201)
        pitch = pitch_at(s)
        pivot = np.where(pitch > 0, -heel, ball)
        # the pivot stands: the sole's origin turns about it
        x, z = -pivot * np.cos(pitch) + pivot, -pivot * np.sin(pitch)
        ground = ahead + x - self.speed * contact * s  # seen from the pelvis
        end_v = np.gradient(ground, contact * s)[-1], np.gradient(z, contact * s)[-1]
        swing = self.stride - contact
        times = np.array([0, 0.35, 0.72, 1.0]) * swing
        last = [ground[0], z[0], pitch[0]]
        xs = CubicSpline(
            times,
            [ground[-1], -0.30, ahead + 0.06, last[0]],
            bc_type=((1, end_v[0]), (1, -self.speed * 0.75)),
        )
        zs = CubicSpline(times, [z[-1], 0.42, 0.22, last[1]], bc_type=((1, end_v[1]), (1, -self.fall)))
        ps = CubicSpline(times, [pitch[-1], -1.5, 0.1, last[2]], bc_type=((1, -3.0), (1, 0.0)))
        tau = phase * self.stride
        standing = tau < contact
        part = np.clip(tau / contact, 0, 1)
        late = np.clip(tau - contact, 0, swing)
        parts = zip((ground, z, pitch), (xs, zs, ps), strict=True)
        return [np.where(standing, np.interp(part, s, stance), fly(late)) for stance, fly in parts]

    def gait(self, robot, rng=None, noise=0.0):
        body = robot.body
        n = round(self.end * self.rate) + 1
        t = np.arange(n) / self.rate
        base = np.tile(robot.placement, (n, 1, 1))
        leg = base[0, 2, 3]
        base[:, 2, 3] = self.heights(t, leg - 0.045)
        base[:, 0, 3] = 0.0 if self.treadmill else self.speed * t
        targets = {}
        for k, side in enumerate(SIDES):
            x, z, pitch = self.foot(body, np.mod(t / self.stride - k / 2, 1.0))
            T = np.tile(np.eye(4), (n, 1, 1))
            c, d = np.cos(pitch), np.sin(pitch)
            T[:, 0, 0], T[:, 0, 2], T[:, 2, 0], T[:, 2, 2] = c, -d, d, c
            T[:, 0, 3], T[:, 2, 3] = base[:, 0, 3] + x, z
            T[:, 1, 3] = (1 - 2 * k) * 0.05
            targets[f"{side}_foot"] = T
        track = ik.track(robot, targets, base=base)
        assert track.position_error.max() < REACHED
        q = robot.angles(track.q)
        if noise:
            q = q + rng.normal(0, noise, q.shape)
            base[:, :3, 3] += rng.normal(0, noise, (n, 3))
        return Gait(t, q, base=base, source="a run")


KINDS = {  # jog to fast run, heel and ball first, camera of 60 Hz, treadmill
    "run": Run(strides=4),
    "ball first": Run(landing=-0.15, strides=4),
    "fast": Run(stride=0.66, duty=0.30, speed=4.0, strides=4),
    "jog": Run(stride=0.76, duty=0.44, speed=2.2, strides=4),
    "60 Hz": Run(rate=60.0, strides=4),
    "treadmill": Run(treadmill=True, strides=4),
    "two strides": Run(strides=2),
}


@pytest.fixture(scope="module")
def supple():
    """Hips and ankles that reach as a runner's do."""
    body = Body.from_stature(1.75)
    wide = {joint: (-1.8, 1.8) for joint in JOINTS if "ankle" in joint or "hip" in joint}
    return load_robot(dataclasses.replace(body, limits={**body.limits, **wide}))


def assert_true(found, truth):
    for event in found:
        same = [e.time for e in truth if (e.kind, e.side) == (event.kind, event.side)]
        assert min(abs(event.time - t) for t in same) < FRAMES, event


@pytest.mark.parametrize("kind", KINDS)
def test_a_run_is_found_with_its_contacts_speed_and_cadence(supple, kind):
    run = KINDS[kind]
    gait = run.gait(supple)
    found = events(supple, gait)
    assert {event.source for event in found} == set(RUNNING_SOURCES)
    assert_true(found, run.truth())
    assert len(found) >= len(run.truth()) - 5  # those at the ends of the recording may be missing
    known = walk_numbers(supple, dataclasses.replace(gait, events=found))
    assert known.manner == "run"
    assert known.numbers["speed"].mean == pytest.approx(run.speed, rel=0.02)
    assert known.numbers["cadence"].mean == pytest.approx(120 / run.stride, rel=0.01)
    assert known.numbers["stride_length"].mean == pytest.approx(run.speed * run.stride, rel=0.02)


def test_of_a_run_without_plates_contact_is_left_out_and_no_double_support_is_made(supple):
    gait = KINDS["run"].gait(supple)
    known = walk_numbers(supple, dataclasses.replace(gait, events=events(supple, gait)))
    assert not [name for name in known.numbers if name.endswith(("stance", "swing", "support", "flight"))]
    assert "left out" in known.unknown
    assert known.usual == {}  # the published ranges are those of walks


def test_known_contacts_of_a_run_give_stance_and_flight(supple):
    run = KINDS["run"]
    known = walk_numbers(supple, dataclasses.replace(run.gait(supple), events=tuple(run.truth())))
    assert known.manner == "run"
    assert known.unknown == ""
    assert known.numbers["left_stance"].mean == pytest.approx(100 * run.duty, abs=0.1)
    assert known.numbers["flight"].mean == pytest.approx(100 - 200 * run.duty, abs=0.1)
    assert "double_support" not in known.numbers


def test_a_plate_under_one_step_sets_its_events_and_moves_the_others(supple):
    run = KINDS["run"]
    gait = run.gait(supple)
    strike, off = 2 * run.stride, (2 + run.duty) * run.stride  # the left foot's third contact
    time = np.arange(round(1000 * gait.duration)) / 1000
    force = np.zeros((len(time), 3))
    inside = (time > strike) & (time < off)
    force[inside, 2] = 2000 * np.sin(np.pi * (time[inside] - strike) / (off - strike))
    point = np.zeros((len(time), 3))
    point[:, :2] = [run.speed * strike + 0.325 * run.speed * run.duty * run.stride, 0.05]
    plate = ForcePlate("plate", time, force, point, np.zeros_like(force))
    found = with_plates(supple, gait, [plate]).events
    assert sum(event.source == "force plate" for event in found) == 2
    assert all(event.source.startswith((*RUNNING_SOURCES, "force plate")) for event in found)
    assert_true(found, run.truth())


def test_a_run_without_its_pelvis_is_found_too(supple):
    run = KINDS["run"]
    gait = run.gait(supple)
    held = Gait(gait.time, gait.q)
    found = events(supple, held)
    assert {event.source for event in found} == set(RUNNING_SOURCES)
    assert_true(found, run.truth())
    known = walk_numbers(supple, dataclasses.replace(held, events=found))
    assert known.numbers["speed"].mean == pytest.approx(run.speed, rel=0.03)


@pytest.mark.parametrize("stature", [1.6, 1.9])
def test_the_body_need_not_be_the_runners(supple, stature):
    run = KINDS["run"]
    gait = run.gait(supple)
    assert_true(events(load_robot(Body.from_stature(stature)), gait), run.truth())


def test_noise_of_two_millimetres_changes_nothing_of_it(supple, rng):
    run = KINDS["run"]
    found = events(supple, run.gait(supple, rng, noise=2e-3))
    assert {event.source for event in found} == set(RUNNING_SOURCES)
    assert_true(found, run.truth())


@pytest.mark.parametrize("speed", SPEEDS)
def test_walks_of_any_speed_are_no_runs(robot, speed):
    walk = normative_gait(speed)
    assert manner(walk) == "walk"
    long = walk.repeated(4)
    for base in (long.base, None):
        recording = Gait(long.time, long.q, base=base)
        assert manner(dataclasses.replace(recording, events=events(robot, recording))) == "walk"


def test_hops_on_both_feet_are_no_run(supple):
    run = KINDS["run"].gait(supple)
    half = len(JOINTS) // 2
    both = Gait(run.time, np.tile(run.q[:, :half], 2), base=run.base)
    with pytest.raises(GaitError, match="no gait cycles found"):
        events(supple, both)


@pytest.mark.parametrize("kind", KINDS)
def test_a_run_is_plausible_though_its_feet_land_hard(supple, kind):
    assert plausibility(supple, KINDS[kind].gait(supple)).reasons == ()


@pytest.mark.parametrize("at", [0.2, 0.5, 0.8])
def test_a_sample_that_jumps_in_a_run_is_an_outlier(supple, at):
    """15 degrees at one sample of the third stride, in stance, flight and swing: no other step has it."""
    run = KINDS["run"]
    gait = run.gait(supple)
    q, k = gait.q.copy(), round((2 + at) * run.stride * run.rate)
    q[k, JOINTS.index("left_knee_flexion")] += np.radians(15)
    (reason,) = plausibility(supple, Gait(gait.time, q, base=gait.base)).reasons
    assert f"left_knee_flexion at {gait.time[k]:.3f} s" in reason


def test_the_mean_cycle_of_a_run_is_a_run_whose_contacts_nobody_measured(supple):
    gait = KINDS["run"].gait(supple)
    run = dataclasses.replace(gait, events=events(supple, gait))
    mean = cycles(run, "left").average()
    assert manner(mean) == "run"
    known = walk_numbers(supple, mean)
    assert "left out" in known.unknown
    assert not [name for name in known.numbers if name.endswith(("stance", "swing", "support", "flight"))]
    measured = dataclasses.replace(gait, events=tuple(KINDS["run"].truth()))
    assert walk_numbers(supple, cycles(measured, "left").average()).unknown == ""
