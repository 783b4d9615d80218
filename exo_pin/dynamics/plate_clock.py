"""Clock of force plates against that of a walk: heel strikes and toe-offs of both, side by side."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exo_pin.errors import GaitError
from exo_pin.gait import Event
from exo_pin.kinematics.event_differences import differences

_APART = 0.06
"""Mean difference [s] of all events from which two clocks differ: kinematics alone are 5 to 30 ms off."""


def check_event_times(moving: Sequence[Event], measured: Sequence[Event]) -> None:
    """Refuse plates whose contacts come earlier or later than the feet's, all of them.

    Args:
        moving: Heel strikes and toe-offs by the motion of the feet; none where there is no walk.
        measured: Those of the plates.

    Raises:
        GaitError: With the difference.
    """
    found = differences(moving, measured)
    late = [difference for kind in found for difference in kind.late]
    mean = float(np.mean(late)) if late else 0.0
    if len(late) > 1 and abs(mean) > _APART and len({difference > 0 for difference in late}) == 1:
        when = "later" if mean > 0 else "earlier"
        raise GaitError(
            f"by their motion the feet strike and leave the ground {1e3 * abs(mean):.0f} ms {when} than the "
            f"plates have it ({'; '.join(map(str, found))}): plates of another clock? The same is accepted"
        )
    if moving and not late and len(measured) > 1:
        raise GaitError(
            "no heel strike or toe-off of the feet's motion is within 200 ms of one of the plates: plates of "
            "another clock or trial? The same clock is accepted"
        )
