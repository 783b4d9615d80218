"""Residual of inverse dynamics: force and moment on the pelvis that the model does not explain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from exo_pin.arrays import Array
from exo_pin.short_repr import short_repr

FORCE_THRESHOLD = 0.05
"""Largest residual force as a part of the largest external force (Hicks et al., J Biomech Eng 137:020905,
2015)."""

MOMENT_THRESHOLD = 0.01
"""Largest residual moment as a part of the largest external force times the height of the centre of mass."""


@dataclass(frozen=True, eq=False)
class Residual:
    """The residual of n samples, shown as it is and never spread over the joints.

    Attributes:
        wrench: `(n, 6)` force, then moment about mid-hip, world axes [N, N m]; NaN where not known.
        external: `(n, 3)` sum of the ground's forces [N].
        com_height: Mean height of the centre of mass [m].
        weight: Of the masses [N].
    """

    wrench: Array
    external: Array
    com_height: float
    weight: float

    __repr__ = short_repr

    @property
    def force_rms(self) -> float:
        """Root mean square of the force's length [N]."""
        return _rms(self.wrench[:, :3])

    @property
    def moment_rms(self) -> float:
        """Root mean square of the moment's length [N m]."""
        return _rms(self.wrench[:, 3:])

    @property
    def force_limit(self) -> float:
        """Published threshold of the largest residual force [N]."""
        return FORCE_THRESHOLD * _largest(self.external)

    @property
    def moment_limit(self) -> float:
        """Published threshold of the largest residual moment [N m]."""
        return MOMENT_THRESHOLD * self.com_height * _largest(self.external)

    def facts(self) -> dict[str, Any]:
        """Numbers for JSON."""
        return {
            "force_rms_N": self.force_rms,
            "force_rms_percent_of_weight": 100 * self.force_rms / self.weight,
            "force_peak_N": _largest(self.wrench[:, :3]),
            "force_threshold_N": self.force_limit,
            "moment_rms_Nm": self.moment_rms,
            "moment_peak_Nm": _largest(self.wrench[:, 3:]),
            "moment_threshold_Nm": self.moment_limit,
            "threshold_source": "Hicks et al. 2015: 5 % of the largest external force; 1 % of that times the "
            "height of the centre of mass",
        }


def _rms(vectors: Array) -> float:
    return float(np.sqrt(np.nanmean((vectors**2).sum(axis=1))))


def _largest(vectors: Array) -> float:
    return float(np.nanmax(np.linalg.norm(vectors, axis=1)))
