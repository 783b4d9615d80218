"""The linear inverted pendulum: centre of mass of a ZMP path, divergent component, capture point, energy.

The cart-table model (Kajita et al., Proc. ICRA 2003): a centre of mass at constant height z over a
zero-moment point p moves by x'' = (x - p) g / z, in both directions of the ground alike.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from exo_pin.arguments import number, real
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.physics import GRAVITY

_HIGHEST = 1000.0  # centre of mass [m]
_SHORTEST, _LONGEST = 1e-6, 10.0  # time from sample to sample [s]


def com_of_zmp(zmp: npt.ArrayLike, dt: float, height: float) -> Array:
    """The one path of the centre of mass that has this ZMP and no acceleration at its two ends.

    The second difference of x makes p = x - (z / g) x'' a tridiagonal system, solved exactly in one pass
    forth and back (Thomas; as Kagami et al., Auton. Robots 12, 2002, for patterns of humanoids).

    Args:
        zmp: `(n, 2)` zero-moment point, n at least 2 [m].
        dt: Time from sample to sample [s].
        height: Of the centre of mass above the ground [m].

    Returns:
        `(n, 2)` centre of mass [m].

    Raises:
        DescriptionError: A shape does not fit, or a number is not finite.
    """
    p = _path("zmp", zmp)
    a = _constant(height) ** 2 / _time_step(dt) ** 2
    return np.stack([_solved(column, a) for column in p.T.tolist()], axis=1) if len(p) > 2 else p.copy()


def resting_zmp(zmp: npt.ArrayLike, dt: float, height: float, rest: float) -> Array:
    """The ZMP path with a small detour in the rests at both ends, so that the body starts and stops at rest.

    To move to one side from rest the ZMP has first to go to the other: without that the centre of mass would
    have to be under way at the first sample, and still be at the last.

    Args:
        zmp: `(n, 2)` zero-moment point, at rest at both ends [m].
        dt: Time from sample to sample [s].
        height: Of the centre of mass above the ground [m].
        rest: How long each detour may take [s].

    Raises:
        DescriptionError: A shape does not fit, a number is not finite, or the rests fill the path.
    """
    p, count = _path("zmp", zmp), round(number("rest", rest, above=0.0, most=1e4) / _time_step(dt))
    if not 2 < count < len(p) / 2:
        raise DescriptionError(
            f"rest is {rest:g} s; more than two samples and less than half the path is accepted"
        )
    s = np.arange(count) / count
    detours = np.zeros((len(p), 2))
    detours[:count, 0] = 16.0 * (s * (1.0 - s)) ** 2
    detours[:, 1] = detours[::-1, 0]
    drift, answer = (_end_steps(com_of_zmp(path, dt, height)) for path in (p, detours))
    return np.asarray(p - detours @ np.linalg.solve(answer, drift))


def zmp_of_com(com: npt.ArrayLike, dt: float, height: float) -> Array:
    """The ZMP of a path of the centre of mass, by second differences; without acceleration at the two ends.

    Args:
        com: `(n, 2)` centre of mass, n at least 2 [m].
        dt: Time from sample to sample [s].
        height: Of the centre of mass above the ground [m].

    Raises:
        DescriptionError: A shape does not fit, or a number is not finite.
    """
    x = _path("com", com)
    p = x.copy()
    p[1:-1] -= _constant(height) ** 2 / _time_step(dt) ** 2 * np.diff(x, 2, axis=0)
    return p


def divergent_component(position: npt.ArrayLike, velocity: npt.ArrayLike, height: float) -> Array:
    """The divergent component of motion x + x' sqrt(z / g), which moves away from the ZMP as e^t.

    On the ground it is the capture point: a pendulum whose foot is put there comes to rest above it (Pratt et
    al., Proc. Humanoids 2006).

    Args:
        position: `(n, 2)` of the centre of mass over the ground [m].
        velocity: `(n, 2)` of it [m/s].
        height: Of it above the ground [m].

    Raises:
        DescriptionError: A shape does not fit, or a number is not finite.
    """
    x, v = _states(position, velocity)
    return x + v * _constant(height)


def orbital_energy(
    position: npt.ArrayLike, velocity: npt.ArrayLike, zmp: npt.ArrayLike, height: float
) -> Array:
    """Energy per mass (x'^2 - (x - p)^2 g / z) / 2 in each direction, constant while the ZMP rests [J/kg].

    Positive: the pendulum passes over its foot; negative: it turns back before.

    Args:
        position: `(n, 2)` of the centre of mass over the ground [m].
        velocity: `(n, 2)` of it [m/s].
        zmp: `(n, 2)` zero-moment point [m].
        height: Of the centre of mass above the ground [m].

    Raises:
        DescriptionError: A shape does not fit, or a number is not finite.
    """
    x, v = _states(position, velocity)
    arm = x - real("zmp", zmp, x.shape)
    return np.asarray(0.5 * (v**2 - (arm / _constant(height)) ** 2))


def fall(
    position: npt.ArrayLike, velocity: npt.ArrayLike, zmp: npt.ArrayLike, height: float, time: npt.ArrayLike
) -> Array:
    """Where the centre of mass is while the ZMP rests: the pendulum's equation in closed form.

    Args:
        position: `(2,)` of the centre of mass at time 0 [m].
        velocity: `(2,)` of it [m/s].
        zmp: `(2,)` zero-moment point [m].
        height: Of the centre of mass above the ground [m].
        time: `(n,)` [s].

    Returns:
        `(n, 2)` centre of mass over the ground [m].

    Raises:
        DescriptionError: A shape does not fit, or a number is not finite.
    """
    x, v, p = (
        real(name, value, (2,))
        for name, value in (("position", position), ("velocity", velocity), ("zmp", zmp))
    )
    constant = _constant(height)
    t = real("time", time, ("n",))[:, None] / constant
    return np.asarray(p + (x - p) * np.cosh(t) + v * constant * np.sinh(t))


def time_constant(height: float) -> float:
    """sqrt(z / g): in this time the divergent component's distance from the ZMP grows by e [s].

    Raises:
        DescriptionError: The height is no positive number.
    """
    return _constant(height)


def _path(name: str, values: npt.ArrayLike) -> Array:
    path = real(name, values, ("n", 2))
    if len(path) < 2:
        raise DescriptionError(f"{name} has {len(path)} samples; at least 2 are accepted")
    return path


def _states(position: npt.ArrayLike, velocity: npt.ArrayLike) -> tuple[Array, Array]:
    x = real("position", position, ("n", 2))
    return x, real("velocity", velocity, x.shape)


def _time_step(dt: float) -> float:
    return number("dt", dt, least=_SHORTEST, most=_LONGEST)


def _end_steps(com: Array) -> Array:
    """`(2, 2)` how far the centre of mass moves in the first and in the last time step [m]."""
    return np.stack([com[1] - com[0], com[-1] - com[-2]])


def _constant(height: float) -> float:
    return math.sqrt(number("height", height, above=0.0, most=_HIGHEST) / GRAVITY)


def _solved(p: list[float], a: float) -> list[float]:
    """-a x[k-1] + (1 + 2 a) x[k] - a x[k+1] = p[k] with x = p at both ends, in plain floats."""
    n, main = len(p), 1.0 + 2.0 * a
    upper, right = [0.0] * n, [p[0]] * n
    for k in range(1, n - 1):
        share = 1.0 / (main - a * upper[k - 1])
        upper[k], right[k] = a * share, (p[k] + a * right[k - 1]) * share
    x = [p[-1]] * n
    for k in range(n - 2, -1, -1):
        x[k] = right[k] + upper[k] * x[k + 1]
    return x
