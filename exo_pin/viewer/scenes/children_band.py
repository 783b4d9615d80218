"""The band of typically developing children behind a walk's curves, each leg at its own phase."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.anatomy.names import Speed
from exo_pin.arrays import Array
from exo_pin.gait import Gait, normative_gait, normative_sd
from exo_pin.gait.normative import nearest_speed
from exo_pin.gait.normative_kinetics import normative_moments, normative_powers
from exo_pin.gait.time_series import at_phase
from exo_pin.robot import Robot
from exo_pin.viewer.scenes.joint_plots import Tab
from exo_pin.viewer.scenes.leg_phases import leg_phases

_SAMPLES = 100
_HALF = len(JOINTS) // 2


@dataclass(frozen=True, eq=False)
class ChildrenBand:
    """The band of a walk: which speed it is of, and the phase of each leg.

    Attributes:
        speed: Of the source whose cadence is nearest.
        phases: `(n, 2)` of left and right leg; NaN outside of whole cycles.
        mass: Of the person, by which moments and powers are multiplied [kg]; NaN if there is none.
    """

    speed: Speed
    phases: Array
    mass: float

    @property
    def note(self) -> str:
        """Where the band comes from."""
        speed = self.speed.replace("_", " ")
        return (
            "Normal band: mean and one standard deviation of typically developing children at the speed "
            f"{speed} (Schwartz 2008), chosen by cadence; moments and powers times the person's mass. "
            "The level of hip flexion depends on how the pelvis is measured."
        )

    def behind(self, tab: Tab) -> Tab:
        """A tab of joints with the band behind its curves, where the source has one for it."""
        found = self._curves(tab.name)
        if found is None:
            return tab
        mean, sd = (self._of_legs(values) for values in found)
        columns = [JOINTS.index(joint) for joint in tab.joints]
        return replace(tab, band=((mean - sd)[:, columns], (mean + sd)[:, columns]))

    def _curves(self, name: str) -> tuple[Array, Array] | None:
        """Mean and spread `(samples, 6)` of a leg from its heel strike on."""
        if name == "angles":
            walk = normative_gait(self.speed, samples=_SAMPLES)
            return walk.q[:, :_HALF], normative_sd(self.speed, samples=_SAMPLES)[:, :_HALF]
        kinetics = {"torques": normative_moments, "power": normative_powers}.get(name)
        if kinetics is None or np.isnan(self.mass):
            return None
        mean, sd = kinetics(self.speed, samples=_SAMPLES)
        return self.mass * mean[:, :_HALF], self.mass * sd[:, :_HALF]

    def _of_legs(self, curves: Array) -> Array:
        """`(n, 12)` the curves of a leg, at the phases of each."""
        out = np.full((len(self.phases), len(JOINTS)), np.nan)
        for k in range(len(SIDES)):
            known = np.isfinite(self.phases[:, k])
            out[known, k * _HALF : (k + 1) * _HALF] = at_phase(curves, self.phases[known, k])
        return out


def children_band(robot: Robot, gait: Gait) -> ChildrenBand | None:
    """The band for a walk; None without a body, or where no leg has a whole cycle.

    Args:
        robot: Its body gives leg length and mass.
        gait: The walk, with events.
    """
    phases, stride = leg_phases(gait)
    if robot.body is None or stride is None:
        return None
    mass = robot.body.mass if robot.body.wearer else float("nan")
    return ChildrenBand(nearest_speed(stride, robot.body.leg_length), phases, mass)
