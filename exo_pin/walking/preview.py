"""Preview control of the pendulum, sample by sample: the ZMP of the next moments is known, the rest is not.

Kajita et al., Biped walking pattern generation by using preview control of zero-moment point, ICRA 2003: a
linear quadratic servo on the cart-table model, driven by the jerk of the centre of mass.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from exo_pin.arguments import number, real
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.frozen_fields import set_fields
from exo_pin.physics import GRAVITY

_DOUBLINGS = 60  # of the Riccati equation's horizon: it has converged long before
_SETTLED = 1e-14


@dataclass(frozen=True)
class Preview:
    """A preview controller of the pendulum, the same in both directions of the ground.

    Attributes:
        dt: Time from sample to sample [s].
        height: Of the centre of mass above the ground [m].
        horizon: How far ahead the ZMP is known [s].
        tracking: Weight of the summed ZMP error (Q_e of the source).
        jerk: Weight of the jerk (R of the source); small: the ZMP is followed closely.

    Raises:
        DescriptionError: A number is not accepted.
    """

    dt: float
    height: float
    horizon: float = 1.6
    tracking: float = 1.0
    jerk: float = 1e-6

    def __post_init__(self) -> None:
        for name in ("dt", "height", "horizon", "tracking", "jerk"):
            set_fields(self, **{name: number(f"Preview.{name}", getattr(self, name), above=0.0)})
        if not 2 <= self.horizon / self.dt <= 100_000:
            raise DescriptionError(
                f"a horizon of {self.horizon:g} s holds {self.horizon / self.dt:.3g} samples; "
                "2 to 100000 are accepted"
            )

    @cached_property
    def system(self) -> tuple[Array, Array]:
        """A `(4, 4)` and B `(4, 1)` of the summed ZMP error, then position, velocity, acceleration."""
        dt, k = self.dt, self.height / GRAVITY
        A = np.array([[1.0, dt, dt**2 / 2], [0.0, 1.0, dt], [0.0, 0.0, 1.0]])
        B, C = np.array([[dt**3 / 6], [dt**2 / 2], [dt]]), np.array([[1.0, 0.0, -k]])
        return (
            np.block([[np.ones((1, 1)), C @ A], [np.zeros((3, 1)), A]]),
            np.concatenate([C @ B, B]),
        )

    @cached_property
    def cost(self) -> Array:
        """P `(4, 4)`, the solution of the discrete algebraic Riccati equation of the servo."""
        A, B = self.system
        return _riccati(A, B, np.diag([self.tracking, 0.0, 0.0, 0.0]), self.jerk)

    @cached_property
    def gains(self) -> tuple[Array, Array]:
        """Gains `(4,)` of summed error and state, and `(samples,)` of the ZMP from the next sample on."""
        (A, B), P = self.system, self.cost
        inverse = 1.0 / float((self.jerk + B.T @ P @ B)[0, 0])
        feedback = inverse * (B.T @ P @ A)[0]
        closed, X = A - B @ feedback[None], P[:, 0]
        ahead = np.empty(round(self.horizon / self.dt))
        for k in range(len(ahead)):
            ahead[k] = inverse * (B[:, 0] @ X)
            X = closed.T @ X
        return feedback, ahead

    def com(self, zmp: npt.ArrayLike) -> Array:
        """`(n, 2)` centre of mass that follows a ZMP `(n, 2)` from rest [m], seeing one horizon ahead.

        Raises:
            DescriptionError: The shape does not fit, or a number is not finite.
        """
        wanted = real("zmp", zmp, ("n", 2))
        if not len(wanted):
            raise DescriptionError("zmp is empty; at least one sample is accepted")
        A, B = self.system
        feedback, ahead = self.gains
        n = len(ahead)
        future = np.concatenate([wanted, np.repeat(wanted[-1:], n, axis=0)])
        state = np.zeros((4, wanted.shape[1]))
        state[1] = wanted[0]
        out = np.empty_like(wanted)
        for i in range(len(wanted)):
            out[i] = state[1]
            jerk = -feedback @ state + ahead @ future[i + 1 : i + 1 + n]
            state = A @ state + B @ jerk[None]
            state[0] -= future[i + 1]
        return out


def _riccati(A: Array, B: Array, Q: Array, R: float) -> Array:
    """P of A'PA - P - A'PB (R + B'PB)^-1 B'PA + Q = 0, by doubling (Chu et al., Int. J. Control 77, 2004)."""
    eye = np.eye(len(A))
    A, G, H = A.copy(), B @ B.T / R, Q.copy()
    for _ in range(_DOUBLINGS):
        W = np.linalg.solve(eye + G @ H, np.concatenate([A, G], axis=1))
        V, U = W[:, : len(A)], W[:, len(A) :]
        G, step = G + A @ U @ A.T, A.T @ H @ V
        H, A = H + step, A @ V
        if np.abs(step).max() <= _SETTLED * np.abs(H).max():
            break
    return np.asarray((H + H.T) / 2)
