"""Damped least squares for a leg of six joints, all samples at once.

The same method as `dls`, written over arrays: for legs whose axes are calibrated and hence have no closed
form, for samples that a closed form could not answer, and for seeds of one's own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from exo_pin.arrays import Array, Index, Mask
from exo_pin.ik.least_squares import normal_equations
from exo_pin.ik.least_squares.restarts import starts
from exo_pin.ik.leg.forward import Matrix, Number, components, pose_and_jacobian
from exo_pin.ik.settings import Dls
from exo_pin.robot.leg_axes import LegAxes

CHUNK = 6000
KNEE = 3
KICK = 0.1
"""How far the knee is bent to leave a saddle near the straight leg [rad]."""
_FLOOR = 1e-15  # keeps the normal equations definite at a singular pose
_STUCK = 1e-11  # a step this small changes nothing any more [rad]
_CALMER, _STRONGER = 0.25, 4.0


@dataclass(eq=False)
class Batch:
    """Answers for m samples: angles (6, m), distance and angle (2, m), steps (m,)."""

    q: Array
    errors: Array
    steps: Index

    def reached(self, tolerance: float) -> Mask:
        """Which samples are within the tolerance; NaN is not."""
        return np.asarray((self.errors <= tolerance).all(axis=0))

    def take(self, where: Index, better: Batch) -> None:
        """Replace some samples by better ones, adding up the steps."""
        self.q[:, where], self.errors[:, where] = better.q, better.errors


def answers(leg: LegAxes, R: Array, p: Array, seed: Array, settings: Dls, *, reachable: Mask) -> Batch:
    """Joint angles from the seeds (6, m); samples that got stuck are started again elsewhere.

    Args:
        leg: The leg.
        R: Target rotations (m, 3, 3).
        p: Target positions (m, 3) [m].
        seed: Where each sample starts.
        settings: Tolerance, weights, number of steps and restarts.
        reachable: Where a restart is worth trying.
    """
    out = _descend(leg, R, p, seed, settings)
    for start in _starts(leg, settings.restarts):
        stuck = np.flatnonzero(~out.reached(settings.tolerance) & reachable)
        if not len(stuck):
            break
        again = _descend(leg, R[stuck], p[stuck], start(out.q[:, stuck]), settings)
        out.steps[stuck] += again.steps
        good = again.reached(settings.tolerance)
        out.take(stuck[good], Batch(again.q[:, good], again.errors[:, good], again.steps[good]))
    return out


def _starts(leg: LegAxes, count: int) -> Iterator[Callable[[Array], Array]]:
    """Starts made from where samples got stuck: the knee bent a little either way, then elsewhere."""
    for bend in (KICK, -KICK)[:count]:
        yield partial(np.add, bend * (np.arange(6) == KNEE)[:, None])
    for start in starts(0.5 * (leg.lower + leg.upper), leg.lower, leg.upper, count - 2):
        yield partial(_everywhere, start)


def _everywhere(start: Array, q: Array) -> Array:
    return np.tile(start[:, None], q.shape[1])


def _descend(leg: LegAxes, R: Array, p: Array, seed: Array, settings: Dls) -> Batch:
    """Levenberg-Marquardt steps within the limits, in a pool that samples leave and join."""
    low, high = leg.lower[:, None], leg.upper[:, None]
    start = np.where(np.isnan(seed), 0.5 * (low + high), seed)
    out = Batch(np.clip(start, low, high), np.empty((2, len(p))), np.zeros(len(p), dtype=np.int64))
    pool, joined = _Pool.of(leg, R, p, out, slice(0, CHUNK), settings), CHUNK
    while True:
        ended = pool.ended(settings)
        if ended.sum() * 4 >= len(ended):
            pool.leave(out, ended)
            if joined < len(p) and len(pool.who) <= CHUNK // 2:
                more = slice(joined, joined + CHUNK - len(pool.who))
                pool, joined = pool.joined(_Pool.of(leg, R, p, out, more, settings)), more.stop
            if not len(pool.who):
                return out
        pool.step(leg, settings)


@dataclass(eq=False)
class _Pool:
    """Samples under way: who they are, where they stand, error, Jacobian, cost, factor of the damping."""

    who: Index
    goal: _Goal
    q: Array
    e: Array
    J: Array
    errors: Array
    cost: Array
    factor: Array
    steps: Index

    @classmethod
    def of(cls, leg: LegAxes, R: Array, p: Array, out: Batch, part: slice, settings: Dls) -> _Pool:
        """New samples at their seeds."""
        who = np.arange(len(p))[part]
        goal, q = _Goal(*components(R[part], p[part])), out.q[:, part]
        e, J, errors = goal.residual(leg, q, settings)
        return cls(who, goal, q, e, J, errors, _square(e), np.ones(len(who)), np.zeros_like(who))

    def ended(self, settings: Dls) -> Mask:
        """Which samples have arrived, do not move any more, or have used up their steps."""
        arrived = (self.errors <= settings.tolerance).all(axis=0)
        return np.asarray(arrived | (self.factor == np.inf) | (self.steps >= settings.max_iterations))

    def leave(self, out: Batch, ended: Mask) -> None:
        """Hand over the samples that have ended."""
        who = self.who[ended]
        out.q[:, who], out.errors[:, who] = self.q[:, ended], self.errors[:, ended]
        out.steps[who] = self.steps[ended]
        stay = np.flatnonzero(~ended)
        for name in ("who", "q", "e", "J", "errors", "cost", "factor", "steps"):
            setattr(self, name, getattr(self, name)[..., stay])
        self.goal = self.goal.only(stay)

    def joined(self, other: _Pool) -> _Pool:
        """Both together."""
        both = [
            np.concatenate([getattr(self, name), getattr(other, name)], axis=-1)
            for name in ("q", "e", "J", "errors", "cost", "factor", "steps")
        ]
        return _Pool(np.concatenate([self.who, other.who]), self.goal.joined(other.goal), *both)

    def step(self, leg: LegAxes, settings: Dls) -> None:
        """One damped step of every sample; a step that does not help is taken back and damped more."""
        low, high = leg.lower[:, None], leg.upper[:, None]
        A, g = normal_equations.normal(self.J, self.e)
        A[range(6), range(6)] += np.minimum(self.factor, 1e30) * self.cost + _FLOOR
        x = normal_equations.box_steps(A, g, low - self.q, high - self.q)
        trial = np.minimum(np.maximum(self.q + x, low), high)
        e, J, errors = self.goal.residual(leg, trial, settings)
        cost = _square(e)
        better = cost < self.cost
        self.steps += ~self.ended(settings)
        if better.all():
            self.q, self.e, self.J, self.errors, self.cost = trial, e, J, errors, cost
        else:
            self.q, self.errors = np.where(better, trial, self.q), np.where(better, errors, self.errors)
            self.e, self.J = np.where(better, e, self.e), np.where(better, J, self.J)
            self.cost = np.where(better, cost, self.cost)
        self.factor *= np.where(better, _CALMER, _STRONGER)
        self.factor[np.abs(x).max(axis=0) < _STUCK] = np.inf


@dataclass(frozen=True, eq=False)
class _Goal:
    """Targets component by component, with weights."""

    R: Matrix
    p: list[Number]

    def only(self, stay: Index) -> _Goal:
        """Some of the samples."""
        R: Matrix = [[np.asarray(x)[stay] for x in row] for row in self.R]
        return _Goal(R, [np.asarray(x)[stay] for x in self.p])

    def joined(self, other: _Goal) -> _Goal:
        """Both together."""
        R: Matrix = [
            [np.append(x, y) for x, y in zip(*rows, strict=True)]
            for rows in zip(self.R, other.R, strict=True)
        ]
        return _Goal(R, [np.append(x, y) for x, y in zip(self.p, other.p, strict=True)])

    def residual(self, leg: LegAxes, q: Array, settings: Dls) -> tuple[Array, Array, Array]:
        """Weighted error (6, m), its Jacobian (6, 6, m) and the plain distance and angle (2, m)."""
        tip, J = pose_and_jacobian(leg, q)
        e = np.empty((6, q.shape[1]))
        for i in range(3):
            np.subtract(self.p[i], tip.p[i], out=e[i])
        e[3:] = turn(tip.R, self.R)
        errors = np.sqrt(np.stack([_square(e[:3]), _square(e[3:])]))
        for rows, weight in ((slice(3), settings.position_weight), (slice(3, 6), settings.rotation_weight)):
            if weight != 1.0:
                e[rows] *= weight
                J[rows] *= weight
        return e, J, errors


def turn(R: Matrix, S: Matrix) -> Array:
    """The rotation vectors (3, m) in world axes that carry R to S."""
    v = np.zeros((3, *np.shape(S[0][0])))
    for i in range(3):
        a, b = (i + 1) % 3, (i + 2) % 3
        for c in range(3):
            v[i] += R[a][c] * S[b][c] - R[b][c] * S[a][c]
    v *= 0.5
    cosine = 0.5 * (sum(R[i][j] * S[i][j] for i in range(3) for j in range(3)) - 1.0)
    sine = np.sqrt(_square(v))
    angle = np.arctan2(sine, cosine)
    with np.errstate(divide="ignore", invalid="ignore"):
        v *= np.where(sine > 1e-9, angle / sine, 1.0)
    back = np.flatnonzero((cosine < -0.999) & (sine < 0.05))
    if len(back):
        v[:, back] = _half_turns(R, S, back)
    return v


def _half_turns(R: Matrix, S: Matrix, where: Index) -> Array:
    """Rotation vectors near half a turn, where the skew part of the rotation vanishes."""
    import pinocchio as pin  # rare: a sample at a time is good enough

    A = np.array([[np.broadcast_to(x, np.shape(S[0][0]))[where] for x in row] for row in R])
    B = np.array([[np.asarray(x)[where] for x in row] for row in S])
    return np.stack([pin.log3(B[:, :, k] @ A[:, :, k].T) for k in range(len(where))], axis=1)


def _square(e: Array) -> Array:
    total = e[0] * e[0]
    for row in e[1:]:
        total += row * row
    return np.asarray(total)
