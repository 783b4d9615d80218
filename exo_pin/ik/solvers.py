"""The solvers behind the settings: closed form, damped least squares, and the choice between them."""

from __future__ import annotations

import weakref
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from exo_pin.errors import DescriptionError
from exo_pin.ik.least_squares.sequential import follow
from exo_pin.ik.least_squares.subtree_kernel import together
from exo_pin.ik.leg import batch
from exo_pin.ik.leg.constants import IdealLeg, ideal
from exo_pin.ik.problem import Problem
from exo_pin.ik.reach import slack_of
from exo_pin.ik.result import SolutionBuffer, Track
from exo_pin.ik.settings import Auto, ClosedForm, Dls
from exo_pin.robot import LegAxes, Subtree

NEARLY = 0.2
"""Axes this near to an ideal leg's [m, sine] lend their closed form as a seed."""
_IDEALS: weakref.WeakKeyDictionary[LegAxes, dict[float, IdealLeg | None]] = weakref.WeakKeyDictionary()


def closed_form_of(own: LegAxes, *, tolerance: float = 1e-9) -> IdealLeg | None:
    """The constants of the leg's closed form, read once."""
    known = _IDEALS.setdefault(own, {})
    if tolerance not in known:
        known[tolerance] = ideal(own, tolerance=tolerance)
    return known[tolerance]


def auto(task: Problem, settings: Auto) -> Track:
    """Closed form, check, and damped least squares for the rest, each subtree by the best that it allows."""
    buffer, dls = SolutionBuffer.blank(task), replace(settings.dls, tolerance=settings.tolerance)
    for subtree, f, own in _limbs(task):
        exact = None if own is None else closed_form_of(own)
        near = None if own is None else exact or closed_form_of(own, tolerance=NEARLY)
        if own is None or near is None:
            _iterate(task, subtree, f, own, dls, buffer)
            continue
        if exact:
            batch.formula(task, f, own, exact, buffer)
            batch.polish(task, f, own, buffer)
        else:
            batch.nearly(task, f, own, near, buffer)
        batch.descent(task, f, own, dls, buffer)
    return buffer.track(task, settings.tolerance)


def closed(task: Problem, settings: ClosedForm) -> Track:
    """The closed form, checked.

    Raises:
        DescriptionError: A target is not the full pose of a leg that has a closed form.
    """
    buffer = SolutionBuffer.blank(task)
    for subtree, f, own in _limbs(task):
        exact = None if own is None else closed_form_of(own)
        if own is None or exact is None:
            raise DescriptionError(
                f"{', '.join(subtree.frames)}: no closed form; it needs the full pose of a frame on a leg of "
                "six joints whose hip axes meet, and so on (docs/ik.md). Auto() finds an answer all the same"
            )
        batch.formula(task, f, own, exact, buffer)
    return buffer.track(task, settings.tolerance)


def descend(task: Problem, settings: Dls) -> Track:
    """Damped least squares alone."""
    buffer = SolutionBuffer.blank(task)
    for subtree, f, own in _limbs(task):
        _iterate(task, subtree, f, own, settings, buffer)
    return buffer.track(task, settings.tolerance)


def _iterate(
    task: Problem, subtree: Subtree, f: int, own: LegAxes | None, settings: Dls, buffer: SolutionBuffer
) -> None:
    """All samples at once where they do not wait for each other, else one after the other."""
    for place in task.places_of(subtree) if not subtree.floating else ():
        goal = task.goals[place]
        buffer.slack[:, place] = slack_of(task.robot.leg(goal.frame), goal)
    apart = task.seed.ndim == 2 or not settings.warm_start
    joints = subtree.arrays if apart and task.n > 1 and not settings.damping else None
    if joints is None:
        follow(task, subtree, settings, buffer)
    elif own is None:
        together(task, subtree, joints, settings, buffer)
    else:
        seed = np.broadcast_to(task.seed, (task.n, task.robot.nq))[:, own.columns].T
        batch.descent(task, f, own, settings, buffer, seed=seed)


def _limbs(task: Problem) -> Iterator[tuple[Subtree, int, LegAxes | None]]:
    """Each subtree, with its target and its leg where it is a leg that is asked for full poses."""
    for subtree in task.subtrees:
        places = task.places_of(subtree)
        goal = task.goals[places[0]]
        full = goal.R is not None and bool((goal.weight > 0.0).all())
        single = len(places) == 1 and full and not subtree.floating
        yield subtree, places[0], task.robot.leg(goal.frame) if single else None
