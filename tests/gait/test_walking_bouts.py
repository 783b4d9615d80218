"""A walk is found in whatever it is a part of, and what only looks like one is refused with the reason.

The motions are made as a person makes them: footprints on the ground, feet that stay where they stand, a
pelvis that follows, joint angles by inverse kinematics.
"""

from __future__ import annotations

import contextlib
import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exo_pin import ik
from exo_pin.anatomy import JOINTS, SIDES, Body
from exo_pin.errors import GaitError
from exo_pin.gait import Event, Gait, cycles, normative_gait, strides
from exo_pin.kinematics import events, spatiotemporal
from exo_pin.robot import load_robot

RATE = 50.0  # [Hz]
STEP, SWING = 0.6, 0.45  # [s] from step to step, and of it the foot is in the air
LANDING = 0.12  # [s] flat feet land softly: they are furthest ahead before they touch
LENGTHS = 0.02  # [m] a pelvis that follows the feet sways by as much
REACHED = 1e-3  # [m] the person can do this
FORWARD = 0.6  # [m] stride of the walks below


@pytest.fixture(scope="module")
def supple():
    """Ankles and hips that let the whole sole stay on the ground in everything below."""
    body = Body.from_stature(1.75)
    wide = {joint: (-1.5, 1.5) for joint in JOINTS if "ankle" in joint or "hip_rotation" in joint}
    return load_robot(dataclasses.replace(body, limits={**body.limits, **wide}))


def smooth(s):
    """From 0 to 1 with two derivatives at rest."""
    s = np.clip(s, 0, 1)
    return s**3 * (10 - 15 * s + 6 * s**2)


def turned(yaw):
    c, s, o = np.cos(yaw), np.sin(yaw), np.zeros_like(yaw)
    rows = (c, -s, o), (s, c, o), (o, o, o + 1)
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


class Person:
    """Somebody who stands at the origin and does one thing after the other."""

    def __init__(self, robot, rng=None):
        self.robot, self.rng, self.time = robot, rng, 0.0
        self.base = robot.placement.copy()
        self.base[2, 3] -= 0.06  # bent knees reach further
        half = robot.body.hip_width / 2
        self.feet = {side: (0.0, half if side == "left" else -half, 0.0) for side in SIDES}
        self.parts, self.truth = [], []

    def _keep(self, n, feet=None, drop=0.0, back=0.0, twist=0.0, lift=None):
        """`n` samples: feet (n, 4) x, y, yaw, height by side, the pelvis between them."""
        still = {side: np.tile([*self.feet[side], 0.0], (n, 1)) for side in SIDES}
        still |= feet or {}
        middle = (still["left"] + still["right"])[:, :3] / 2
        pelvis = np.column_stack(
            [middle[:, :2], middle[:, 2] + twist, drop + np.zeros(n), back + np.zeros(n)]
        )
        self.parts.append((pelvis, still["left"], still["right"]))
        self.time += n / RATE

    def stand(self, seconds):
        self._keep(round(seconds * RATE))
        return self

    def squat(self, times, seconds=2.0, depth=0.3):
        down = (1 - np.cos(2 * np.pi * np.arange(round(times * seconds * RATE)) / RATE / seconds)) / 2
        self._keep(len(down), drop=-depth * down, back=-0.15 * down)
        return self

    def twist(self, seconds, angle=0.4):
        t = np.arange(round(seconds * RATE)) / RATE
        self._keep(len(t), twist=angle * np.sin(np.pi * t) * smooth(t))
        return self

    def step(self, side, x=0.0, y=0.0, yaw=0.0, height=0.05):
        """One foot goes by that much, seen from the pelvis."""
        n = round(STEP * RATE)
        t = np.arange(n) / RATE
        s = smooth(t / SWING)
        course = (self.feet["left"][2] + self.feet["right"][2]) / 2
        c, d = np.cos(course), np.sin(course)
        old = np.array(self.feet[side])
        new = old + np.array([c * x - d * y, d * x + c * y, yaw])
        path = np.column_stack([old + s[:, None] * (new - old), height * np.sin(np.pi * s) ** 2])
        self.truth += [
            Event(self.time, "toe_off", side),
            Event(self.time + SWING, "heel_strike", side),
        ]
        self._keep(n, {side: path})
        self.feet[side] = tuple(new)
        return self

    def walk(self, steps, stride=FORWARD, turn=0.0):
        """Steps forward, the first and the last one half as long; each foot turns by `turn` a step."""
        for k in range(steps):
            length = stride / 2 if k in (0, steps - 1) else stride
            self.step(SIDES[k % 2], length, yaw=turn)
        return self

    def turn(self, steps, angle):
        """On the spot: footprints go around the point between the feet."""
        half = self.robot.body.hip_width / 2
        for k in range(steps):
            side = SIDES[k % 2]
            other = self.feet[SIDES[1 - k % 2]]
            yaw = other[2] + angle
            sign = 1 if side == "left" else -1
            center = (np.array(self.feet["left"][:2]) + self.feet["right"][:2]) / 2
            goal = center + sign * half * np.array([-np.sin(yaw), np.cos(yaw)])
            move = goal - self.feet[side][:2]
            course = (self.feet["left"][2] + self.feet["right"][2]) / 2
            c, d = np.cos(course), np.sin(course)
            back = (c * move[0] + d * move[1], -d * move[0] + c * move[1])
            self.step(side, *back, yaw=yaw - self.feet[side][2])
        return self

    def gait(self):
        """The motion as a recording without events."""
        pelvis, left, right = (np.concatenate(x) for x in zip(*self.parts, strict=True))
        width = 15  # [samples] the pelvis follows the feet within a third of a second
        pad = np.pad(pelvis, ((width, width), (0, 0)), mode="edge")
        window = np.hanning(2 * width + 1)
        pelvis = np.stack([np.convolve(c, window / window.sum(), "valid") for c in pad.T], axis=1)
        n = len(pelvis)
        base = np.tile(self.base, (n, 1, 1))
        base[:, :3, :3] = turned(pelvis[:, 2])
        ahead = base[:, :2, 0] * pelvis[:, 4:5]
        base[:, :2, 3] = pelvis[:, :2] + ahead
        base[:, 2, 3] += pelvis[:, 3]
        if self.rng is not None:
            base[:, :2, 3] += self._sway(n)
        targets = {}
        for side, foot in zip(SIDES, (left, right), strict=True):
            T = np.tile(np.eye(4), (n, 1, 1))
            T[:, :3, :3], T[:, :2, 3], T[:, 2, 3] = turned(foot[:, 2]), foot[:, :2], foot[:, 3]
            targets[f"{side}_foot"] = T
        track = ik.track(self.robot, targets, base=base)
        assert track.position_error.max() < REACHED
        like = Gait(np.arange(n) / RATE, np.zeros((n, 12)), base=base, source="steps")
        return self.robot.to_gait(track.q, like)

    def _sway(self, n):
        """Two centimetres of slow noise."""
        window = np.hanning(51)
        noise = self.rng.normal(size=(n + 50, 2))
        slow = np.stack([np.convolve(c, window / window.sum(), "valid") for c in noise.T], axis=1)
        return 0.02 * slow / np.abs(slow).max()


def moved(gait, yaw, x=0.0, y=0.0):
    """The same motion elsewhere, heading elsewhere."""
    T = np.eye(4)
    T[:3, :3], T[:2, 3] = turned(np.array(yaw)), (x, y)
    return dataclasses.replace(gait, base=T @ gait.base)


def whole(robot, gait):
    """The gait with events, and the strides that count."""
    with_events = dataclasses.replace(gait, events=events(robot, gait))
    return with_events, [s for side in SIDES for s in strides(with_events, side) if not s.why]


def assert_in(spans, *allowed):
    """Every stride lies in one of the walks; and there are some in each."""
    for a, b in allowed:
        assert any(a <= s.start and s.end <= b for s in spans), (a, b)
    for s in spans:
        assert any(a - LANDING <= s.start and s.end <= b + LANDING for a, b in allowed), s


def test_steps_are_found_when_and_where_they_were_made(robot, supple):
    person = Person(supple).stand(1).walk(10).stand(1)
    gait = person.gait()
    found = events(robot, gait)
    for event in found:
        same = [e.time for e in person.truth if (e.kind, e.side) == (event.kind, event.side)]
        assert min(abs(event.time - t) for t in same) < LANDING, event
    numbers = spatiotemporal(robot, dataclasses.replace(gait, events=found))
    assert numbers["stride_time"].mean == pytest.approx(2 * STEP, abs=0.02)
    assert numbers["step_width"].mean == pytest.approx(robot.body.hip_width, abs=LENGTHS)
    assert numbers["stride_length"].mean == pytest.approx(FORWARD, abs=0.1)


def test_walks_are_found_between_other_things(robot, supple):
    person = Person(supple).stand(6)
    a = person.time
    person.walk(8)
    b = person.time
    person.stand(1.5).squat(2).stand(1.5)
    c = person.time
    gait = person.walk(8).gait()
    with_events, spans = whole(robot, gait)
    assert_in(spans, (a, b), (c, person.time))
    assert len(cycles(with_events, "left")) == sum(s.side == "left" for s in spans)
    assert sum(bool(s.why) for s in strides(with_events, "left")) == 1  # the pause, with its reason


def test_a_walk_there_and_back_has_no_strides_on_the_turn(robot, supple):
    person = Person(supple).walk(8)
    a = person.time
    person.turn(8, np.pi / 8)
    b = person.time
    gait = person.walk(8).gait()
    with_events, spans = whole(robot, gait)
    assert_in(spans, (0, a), (b, person.time))
    numbers = spatiotemporal(robot, with_events)
    assert numbers["stride_length"].mean == pytest.approx(FORWARD, abs=0.1)
    assert numbers["step_width"].mean == pytest.approx(robot.body.hip_width, abs=LENGTHS)


@pytest.mark.parametrize(
    ("doing", "why"),
    [
        (lambda p: p.stand(5), "less than 0.05 m"),
        (lambda p: p.squat(4), "take turns"),
        (lambda p: p.squat(1, 3.0, 0.4), "both feet move forward together"),
        (lambda p: p.turn(10, np.pi / 4), r"the pelvis turns by 4\d\d deg on the spot"),
        (lambda p: p.twist(8), "stepping on the spot"),
        (lambda p: [p.step(SIDES[k % 2], height=0.15) for k in range(10)], "less than|spot|air"),
        (lambda p: [p.step(side, y=0.2) for side in ("left", "right") * 5], "less than"),
        (lambda p: [p.step("left", 0.4 * (-1) ** k) for k in range(8)], "stepping on the spot"),
    ],
    ids=["stands", "squats", "one squat", "turns", "twists", "marches", "side steps", "one foot"],
)
def test_what_is_no_walk_is_refused_with_its_reason(robot, supple, rng, doing, why):
    person = Person(supple, rng)
    doing(person.stand(1))
    with pytest.raises(GaitError, match=f"no gait cycles found: .*({why})"):
        events(robot, person.stand(1).gait())


def lifted_legs(flexion, knee, period=1.3, n=600):
    """Legs that move in turns about a pelvis that is held, by sines of these amplitudes [rad]."""
    t = np.arange(n) / 100
    q = np.zeros((n, 12))
    for k, side in enumerate(SIDES):
        up = np.maximum(np.sin(2 * np.pi * (t / period - k / 2)), 0) ** 2
        q[:, JOINTS.index(f"{side}_hip_flexion")] = flexion * up
        q[:, JOINTS.index(f"{side}_knee_flexion")] = knee * up
    return Gait(t, q)


def test_marching_in_the_balance_support_is_no_walk(robot):
    with pytest.raises(GaitError, match="no gait cycles found"):
        events(robot, lifted_legs(1.0, 1.4))
    with pytest.raises(GaitError, match="no gait cycles found"):
        events(robot, lifted_legs(0.7, 0.7))


def recording(walk, k=5):
    long = walk.repeated(k)
    return Gait(long.time, long.q, base=long.base, source="on a treadmill")


def over_ground(gait, speed=1.2, turn=0.0):
    """The pelvis gets along where it looks, turning evenly [m/s, rad/s]."""
    yaw = turn * gait.time
    base = gait.base.copy()
    base[:, :3, :3] = turned(yaw) @ base[:, :3, :3]
    step = speed * gait.time[1] * np.stack([np.cos(yaw), np.sin(yaw)], axis=1)
    base[1:, :2, 3] += np.cumsum(step[:-1], axis=0)
    return dataclasses.replace(gait, base=base)


def told(found):
    return [(round(event.time, 6), event.kind, event.side) for event in found]


@settings(max_examples=12)
@given(yaw=st.floats(-np.pi, np.pi), ground=st.booleans())
def test_the_walks_direction_does_not_matter(yaw, ground):
    robot, gait = load_robot(), recording(normative_gait("free"))
    gait = over_ground(gait) if ground else gait
    here, there = (spatiotemporal(robot, g) for g in (gait, moved(gait, yaw, -30.0, 7.0)))
    assert told(events(robot, gait)) == told(events(robot, moved(gait, yaw, -30.0, 7.0)))
    for name, number in here.items():
        assert there[name].mean == pytest.approx(number.mean, abs=1e-6), name


@pytest.mark.parametrize("base", ["treadmill", "ground", "none"])
@pytest.mark.parametrize("speed", ["very_slow", "free", "very_fast"])
def test_a_walk_backwards_has_first_and_last_contacts_and_says_so(robot, base, speed):
    """Backwards is forward with time reversed: what was the last contact is the first one."""
    gait = recording(normative_gait(speed))
    gait = over_ground(gait) if base == "ground" else gait
    gait = Gait(gait.time, gait.q) if base == "none" else gait
    back = dataclasses.replace(gait, q=gait.q[::-1], base=None if gait.base is None else gait.base[::-1])
    forward, backward = events(robot, gait), events(robot, back)
    assert {event.source for event in forward} == {"Zeni 2008"}
    assert {event.source for event in backward} == {"Zeni 2008, walking backwards"}
    end = gait.time[-1]
    for event in backward:
        other = "toe_off" if event.kind == "heel_strike" else "heel_strike"
        same = [end - e.time for e in forward if (e.kind, e.side) == (other, event.side)]
        assert min(abs(event.time - t) for t in same) < 0.06 * gait.duration / 5  # of the cycle


def test_gentle_curves_are_walks_and_sharp_ones_are_not(robot):
    gait = recording(normative_gait("free"))
    straight = spatiotemporal(robot, over_ground(gait))
    curve = spatiotemporal(robot, over_ground(gait, turn=1.2 / 6))  # radius 6 m
    for name in ("speed", "stride_length", "cadence"):
        assert curve[name].mean == pytest.approx(straight[name].mean, rel=0.01), name
    for sharp in (over_ground(gait, turn=1.2 / 2), over_ground(gait, speed=0.0, turn=1.0)):
        with pytest.raises(GaitError, match="no gait cycles found: the pelvis turns by"):
            events(robot, sharp)


def test_a_standing_child_in_the_laboratory_has_no_strides(shared):
    from exo_pin.formats import load_gait

    gait = load_gait(shared / "c3d_pig_walk_HC036A/HC036A01_static.c3d")
    with pytest.raises(GaitError, match=r"no gait cycles found: the left foot moves 0\.0"):
        events(load_robot(), gait)


def test_no_motion_breaks_it(robot, rng):
    """Noise, random walks and waves, few samples and many, with and without a pelvis and a period."""
    for k in range(40):
        n = int(rng.choice([2, 3, 5, 30, 200]))
        t = np.arange(n) * rng.choice([0.001, 0.01, 0.1])
        waves = np.sin(np.outer(t, rng.uniform(1, 30, 12)) + rng.uniform(0, 6, 12)) * rng.uniform(0, 1.2, 12)
        q = (rng.uniform(-3, 3, (n, 12)), np.cumsum(0.01 * rng.normal(size=(n, 12)), axis=0), waves)[k % 3]
        base = np.tile(np.eye(4), (n, 1, 1))
        base[:, :3, 3] = np.cumsum(0.02 * rng.normal(size=(n, 3)), axis=0)
        gait = Gait(t, q, base=base if k % 2 else None, periodic=k % 5 == 0)
        found: tuple[Event, ...] = ()
        with contextlib.suppress(GaitError):  # nothing else may come out of it
            found = events(robot, gait)
        assert all(gait.time[0] <= event.time <= gait.time[0] + gait.duration for event in found)
