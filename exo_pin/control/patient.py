"""Patients: how much of each joint's torque a person gives, and what their legs do by themselves."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from exo_pin import arguments
from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.control.passive_moments import moments
from exo_pin.frozen_fields import set_fields
from exo_pin.short_repr import short_repr

_STIFFEST, _MOST_DAMPING, _LONGEST_DELAY = 1000.0, 100.0, 1.0
"""Of a person's own joints [N m/rad, N m s/rad] and nerves [s]: what is larger is a wrong unit."""


@dataclass(frozen=True, eq=False)
class Patient:
    """What a person does in each joint, in the order of `JOINTS`.

    Attributes:
        name: What people call it.
        activity: `(12,)` share of the torque that inverse dynamics finds which the person gives, 0 to 1.
        stiffness: `(12,)` of the person's own holding on to the walk's angles [N m/rad].
        damping: `(12,)` of the person's joints [N m s/rad].
        passive: Whether the passive moments of muscles and tissues act (Riener and Edrich 1999).
        spasticity: `(12,)` torque against a joint's speed beyond the threshold [N m s/rad]; a model of the
            velocity-dependent stretch reflex, not a clinical statement.
        spastic_threshold: Speed from which it acts [rad/s].
        delay: Of everything that the person's nerves give: activity, own stiffness, spasticity [s].

    Raises:
        DescriptionError: A number is not within its range; the message says which.
    """

    name: str
    activity: Array
    stiffness: Array = field(default_factory=lambda: np.zeros(len(JOINTS)), kw_only=True)
    damping: Array = field(default_factory=lambda: np.zeros(len(JOINTS)), kw_only=True)
    passive: bool = field(default=True, kw_only=True)
    spasticity: Array = field(default_factory=lambda: np.zeros(len(JOINTS)), kw_only=True)
    spastic_threshold: float = field(default=1.0, kw_only=True)
    delay: float = field(default=0.0, kw_only=True)

    __repr__ = short_repr

    def __post_init__(self) -> None:
        for name, most in _LARGEST.items():
            set_fields(self, **{name: _checked(name, getattr(self, name), most)})
        for name, value, most in (
            ("delay", self.delay, _LONGEST_DELAY),
            ("spastic_threshold", self.spastic_threshold, 20.0),
        ):
            arguments.number(name, value, least=0.0, most=most)

    def given(self, tau: Array) -> Array:
        """What the person gives of the torques (..., 12) that a walk requires [N m]."""
        given: Array = self.activity * tau
        return given

    def own(self, q: Array, dq: Array, q_walk: Array, dq_walk: Array) -> Array:
        """Torques (..., 12) by the person's own stiffness and spasticity [N m], without delay.

        Args:
            q: Joint angles (..., 12) [rad].
            dq: Joint velocities (..., 12) [rad/s].
            q_walk: Angles (..., 12) that the person aims at [rad].
            dq_walk: Velocities (..., 12) of that walk [rad/s].
        """
        held: Array = self.stiffness * (q_walk - q) + self.damping * (dq_walk - dq)
        if not self._spastic:
            return held
        beyond = np.sign(dq) * np.maximum(np.abs(dq) - self.spastic_threshold, 0.0)
        own: Array = held - self.spasticity * beyond
        return own

    @cached_property
    def _spastic(self) -> bool:
        """Whether any joint is."""
        return bool(self.spasticity.any())

    def tissues(self, q: Array) -> Array:
        """Passive moments (..., 12) of muscles and tissues at joint angles (..., 12) [N m]."""
        return moments(q) if self.passive else np.zeros(q.shape)


def shares(
    tau: Array, q: Array, dq: Array, patient: Patient | None, assist: float | None = None
) -> tuple[Array, Array]:
    """How motors and person share the torques of a walk that both follow exactly.

    The person gives activity x required + passive + spasticity. The motors give the rest, or the part
    `assist` of what the relaxed leg requires: assist x (required - passive).

    Args:
        tau: Torques (n, 12) that the walk requires [N m]; NaN where unknown.
        q: Joint angles (n, 12) [rad].
        dq: Joint velocities (n, 12) [rad/s]; NaN where unknown.
        patient: The person; None gives nothing, the motors do it all.
        assist: Share of the motors, 0 to 1, instead of all that the person leaves.

    Returns:
        Torques (n, 12) of motors and of the person; their sum is `tau` [N m].

    Raises:
        DescriptionError: `assist` is not within 0 to 1, a shape differs, or a number is infinite.
    """
    tau = arguments.real("tau", tau, ("n", len(JOINTS)), gaps=True)
    q, dq = arguments.real("q", q, tau.shape), arguments.real("dq", dq, tau.shape, gaps=True)
    if assist is not None:
        arguments.number("assist", assist, least=0.0, most=1.0)
    tissues = np.zeros(q.shape) if patient is None else patient.tissues(q)
    if assist is not None:
        motors = assist * (tau - tissues)
    elif patient is None:
        motors = tau.copy()
    else:
        motors = tau - patient.given(tau) - tissues - patient.own(q, dq, q, dq)
    return motors, tau - motors


def _checked(name: str, values: Array, most: float) -> Array:
    """A read-only copy, one finite number a joint from 0 to `most`."""
    array = np.array(arguments.real(name, values, (len(JOINTS),)))
    for joint, value in zip(JOINTS, array, strict=True):
        arguments.number(f"{name} of {joint}", float(value), least=0.0, most=most)
    array.setflags(write=False)
    return array


_LARGEST: Mapping[str, float] = {
    "activity": 1.0,
    "stiffness": _STIFFEST,
    "damping": _MOST_DAMPING,
    "spasticity": _MOST_DAMPING,
}

_OWN_STIFFNESS, _OWN_DAMPING = 30.0, 2.0
"""Of an active leg's joints [N m/rad, N m s/rad], a choice: about 1 % of a stiff servo's stiffness."""


def with_activity(name: str, activity: Array, **others: Any) -> Patient:
    """A patient whose own stiffness follows the activity, unless it is given.

    Args:
        name: What people call it.
        activity: `(12,)` share of the required torque that the person gives.
        **others: Further fields of `Patient`.

    Raises:
        DescriptionError: A number is not within its range.
    """
    usual = {"stiffness": _OWN_STIFFNESS * activity, "damping": np.full(len(JOINTS), _OWN_DAMPING)}
    return Patient(name, activity, **(usual | others))


def _preset(name: str, left: float, right: float) -> Callable[[], Patient]:
    return lambda: with_activity(name, np.repeat([left, right], len(JOINTS) // 2))


PATIENTS: Mapping[str, Callable[[], Patient]] = {
    "healthy": _preset("healthy", 1.0, 1.0),
    "paretic_right": _preset("paretic_right", 1.0, 0.5),
    "plegic": _preset("plegic", 0.0, 0.0),
}
"""Name -> the patient: gives all, half on the right, or nothing of what the walk requires."""
