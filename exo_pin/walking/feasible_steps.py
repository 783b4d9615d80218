"""Which steps a body can take: feet apart, time to swing, and reach within the joint limits, or why not."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from exo_pin.errors import GaitError
from exo_pin.physics import GRAVITY
from exo_pin.walking.course import Course
from exo_pin.walking.footsteps import Footsteps
from exo_pin.walking.pelvis_height import LegRoom
from exo_pin.walking.pendulum import time_constant
from exo_pin.walking.schedule import steps_at
from exo_pin.walking.sole_shape import Soles, on_soles

LEAST_GAP = 0.01
"""Between the soles of both feet, sideways [m]."""

_LEAST_SAMPLES = 4  # of a support phase: fewer do not show the motion
_TRIALS = 7  # of the bisection for the largest length: within 1 % of the given one


def check_time(walk: Footsteps, height: float, rate: float) -> None:
    """Refuse steps that are shorter or faster than a pendulum on this leg allows.

    A step takes at least the pendulum's time constant, in which the body falls away from its foot by a factor
    of e (people's quickest steps take as long). A body on a straight leg leaves the ground when it passes
    over its foot faster than sqrt(g l) (Froude number 1; Alexander, Am. Zool. 24, 1984).

    Args:
        walk: The footsteps.
        height: Of mid-hip on straight legs [m].
        rate: Samples a second [Hz].

    Raises:
        GaitError: The steps are too quick, the message says what the least time is.
    """
    longest = float(np.linalg.norm(walk.relative()[:, :2], axis=1).max())
    least = max(time_constant(height), longest / math.sqrt(GRAVITY * height))
    if walk.step_time < least:
        raise GaitError(
            f"step time is {walk.step_time:g} s; at least {math.ceil(1e3 * least) / 1e3:g} s is accepted: "
            f"the pendulum of a hip {height:.2f} m high takes no quicker steps of this length"
        )
    double = walk.step_time * walk.double_support
    for what, lasts in (("double", double), ("single", walk.step_time - double)):
        if lasts * rate < _LEAST_SAMPLES:
            raise GaitError(
                f"{what} support lasts {1e3 * lasts:.3g} ms with a double support of "
                f"{walk.double_support:g}; at least {1e3 * _LEAST_SAMPLES / rate:.3g} ms is accepted"
            )


def check_feet_apart(walk: Footsteps, plan: Course, soles: Soles) -> None:
    """Refuse steps that set or swing one foot onto, across or too close to the other.

    Args:
        walk: The footsteps.
        plan: Their course.
        soles: Of the robot.

    Raises:
        GaitError: Feet touch or cross; the message names the step.
    """
    corners = on_soles(plan.paths.feet, soles.corners)
    gaps = []
    for k, sign in ((0, -1.0), (1, 1.0)):  # seen by the left foot the right one is at negative y
        heading = plan.paths.heading[:, k]
        across = np.stack([-np.sin(heading), np.cos(heading)], axis=1) * sign
        own, other = (np.einsum("nck,nk->nc", corners[:, foot, :, :2], across) for foot in (k, 1 - k))
        gaps.append(other.min(axis=1) - own.max(axis=1))
    gap = np.maximum(*gaps)
    if gap.min() < LEAST_GAP:
        step = steps_at(plan.phases, plan.time)
        first = step[gap < LEAST_GAP][0]
        worst = int(np.where(step == first, gap, np.inf).argmin())
        raise GaitError(
            f"{step_words(walk, plan, worst)} comes {1e3 * (LEAST_GAP - gap[worst]):.0f} mm too close to the "
            f"other foot or across it: {1e3 * LEAST_GAP:.0f} mm between the soles are accepted; make the "
            "steps wider"
        )


def check_reach(
    walk: Footsteps, plan: Course, tight: LegRoom, least: float, room: Callable[[Footsteps], float]
) -> None:
    """Refuse steps that no height of the pelvis brings within reach and joint limits.

    Args:
        walk: The footsteps.
        plan: Their course, sampled as `tight` counts.
        tight: The tightest place at the best height of the pelvis.
        least: Room to the joint limits that is asked for [rad].
        room: Of other footsteps, at their best height [rad].

    Raises:
        GaitError: The message names the step, the joint and the largest length that fits.
    """
    if tight.room >= least:
        return
    joint = tight.joint.replace("_", " ")
    lower, upper = (math.degrees(x) for x in tight.limits)
    if tight.reach < 0.0:
        why = f"is {-1e3 * tight.reach:.0f} mm beyond the reach of a straight leg ({joint})"
    else:
        why = f"needs {joint} {math.degrees(tight.angle):.1f} deg, of {lower:g} to {upper:g}"
    raise GaitError(
        f"{step_words(walk, plan, tight.sample)} {why}, with the hips at their best height, "
        f"{tight.height:.3f} m; {_largest(walk, least, room)}"
    )


def _largest(walk: Footsteps, least: float, room: Callable[[Footsteps], float]) -> str:
    """The largest length that fits, in words; by bisection on all steps alike."""
    longest = float(np.abs(walk.relative()[:, 0]).max())
    low, high = 0.0, 1.0
    if room(walk.shortened(0.0)) < least:
        return "not even steps on the spot fit: lower the clearance, or make the steps narrower or turn less"
    for _ in range(_TRIALS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if room(walk.shortened(middle)) >= least else (low, middle)
    return f"steps up to {math.floor(100 * low * longest) / 100:.2f} m ahead fit, others as given"


def step_words(walk: Footsteps, plan: Course, sample: int) -> str:
    """The step that is taken at a sample, or taken next, in words.

    Args:
        walk: The footsteps.
        plan: Their course.
        sample: Of the course.
    """
    k = int(steps_at(plan.phases, plan.time[sample : sample + 1])[0])
    return f"step {k + 1} ({walk.steps[k].side} foot)"
