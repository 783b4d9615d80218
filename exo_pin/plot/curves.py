"""Curves of a walk on matplotlib's axes; needs the extra `plot`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from exo_pin.anatomy import MOVEMENTS, SIDES, joint
from exo_pin.anatomy.names import Movement
from exo_pin.arguments import word
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait, Torques, normative_gait
from exo_pin.gait.normative import normative_sd, speed_of
from exo_pin.html_summary import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_BAND = "0.85"
"""Grey of the normal band."""


def joints(gait: Gait, *, normal: bool = True, ax: Sequence[Axes] | None = None) -> Array:
    """Six panels of joint angles [deg], left and right.

    Args:
        gait: The walk.
        normal: Whether the mean +- one standard deviation of typically developing children (Schwartz 2008) is
            drawn, at the walk's own normal speed or else the free one; only for a walk of one cycle.
        ax: Six axes to draw on; new ones if left out.

    Returns:
        `(6,)` the axes, in the order of `MOVEMENTS`.

    Raises:
        DescriptionError: There are not six axes.
    """
    axes = _six(ax)
    x, label = _across(gait.time, gait.duration, periodic=gait.periodic)
    _lines(axes, x, label, np.degrees(gait.q), "deg")
    if normal and gait.periodic:
        speed = speed_of(gait) or "free"
        mean, spread = normative_gait(speed), normative_sd(speed)
        phase_axis = np.linspace(0.0, 100.0, len(mean), endpoint=False)
        for k, panel in enumerate(axes):  # the left leg, whose cycle starts at 0
            middle, sd = np.degrees(mean.q[:, k]), np.degrees(spread[:, k])
            panel.fill_between(phase_axis, middle - sd, middle + sd, color=_BAND, zorder=0, label="normal")
    axes[0].legend(frameon=False)
    return axes


def torques(tau: Torques, *, ax: Sequence[Axes] | None = None) -> Array:
    """Six panels of joint torques [N m], left and right; what is not known is left out.

    Args:
        tau: The torques, e.g. `dynamics.torques(robot, gait).to_torques()`.
        ax: As for `joints`.

    Returns:
        `(6,)` the axes.

    Raises:
        DescriptionError: There are not six axes.
    """
    axes = _six(ax)
    _lines(axes, tau.time - tau.time[0], "time [s]", tau.tau, "N m")
    axes[0].legend(frameon=False)
    return axes


def phase(
    gait: Gait, *, x: Movement = "hip_flexion", y: Movement = "knee_flexion", ax: Axes | None = None
) -> Any:
    """One joint's angle over another's, left and right (cyclogram) [deg].

    Args:
        gait: The walk.
        x: Movement to the right.
        y: Movement upwards.
        ax: Axes to draw on; new ones if left out.

    Raises:
        UnknownNameError: There is no such movement.
    """
    word("movement", x, MOVEMENTS)
    word("movement", y, MOVEMENTS)
    if ax is None:
        from matplotlib import pyplot

        ax = pyplot.subplots()[1]
    for side, colour in zip(SIDES, COLOURS, strict=True):
        across, up = (np.degrees(gait[joint(side, movement)]) for movement in (x, y))
        if gait.periodic:  # back to the start
            across, up = np.append(across, across[0]), np.append(up, up[0])
        ax.plot(across, up, color=colour, label=side)
    ax.set_xlabel(f"{x.replace('_', ' ')} [deg]")
    ax.set_ylabel(f"{y.replace('_', ' ')} [deg]")
    ax.legend(frameon=False)
    return ax


def _six(ax: Sequence[Axes] | None) -> Array:
    if ax is None:
        from matplotlib import pyplot

        ax = pyplot.subplots(2, 3, figsize=(10, 5), layout="constrained", sharex=True)[1].ravel()
    axes = np.ravel(np.array(ax, dtype=object))
    if len(axes) != len(MOVEMENTS):
        raise DescriptionError(f"{len(axes)} axes are given; {len(MOVEMENTS)} are accepted")
    return axes


def _across(time: Array, duration: float, *, periodic: bool) -> tuple[Array, str]:
    """The horizontal axis: percent of a cycle, or time."""
    return (100.0 * time / duration, "cycle [%]") if periodic else (time - time[0], "time [s]")


def _lines(axes: Array, x: Array, label: str, values: Array, unit: str) -> None:
    half = len(MOVEMENTS)
    for k, (panel, movement) in enumerate(zip(axes, MOVEMENTS, strict=True)):
        for side, colour, column in zip(SIDES, COLOURS, (k, k + half), strict=True):
            panel.plot(x, values[:, column], color=colour, label=side)
        panel.set_title(movement.replace("_", " "))
        panel.set_xlabel(label)
        panel.set_ylabel(f"[{unit}]")
