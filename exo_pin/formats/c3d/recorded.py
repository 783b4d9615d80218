"""Whether a C3D file is a recording of a walk: no mean cycle in per cent, no single posture."""

from __future__ import annotations

from pathlib import Path

from exo_pin.anatomy import SIDES
from exo_pin.errors import FormatError
from exo_pin.formats.c3d.content import C3dContent
from exo_pin.gait.trial import Markers

_RESULTS = ("Walking Speed", "Cadence", "Stride Time")
"""Names in ANALYSIS that say how fast a mean cycle is."""


def check_recorded(path: Path, trial: Markers, content: C3dContent) -> None:
    """Refuse what has angles and is no recording.

    A mean cycle is written as one from 0 to 100 %, each foot from its own strike on, so both feet strike in
    its first and last frame, which no walk does. It has no seconds, and the feet's phase is lost.

    Args:
        path: The file, for messages.
        trial: Its angles and events.
        content: The file, for its own results.

    Raises:
        FormatError: It is a mean cycle, or one frame.
    """
    if len(trial) < 2:
        why = "holds one frame: a posture, no walk; it can be the standing trial (--static) of a marker trial"
        raise FormatError(path, why)
    start, end = float(trial.time[0]), float(trial.time[-1])
    frame = float(trial.time[1] - trial.time[0])
    ends = {
        (event.side, time)
        for event in trial.events
        for time in (start, end)
        if event.kind == "heel_strike" and abs(event.time - time) <= frame
    }
    if len(ends) < 2 * len(SIDES):
        return
    known = [f"{name} {value:.4g} {unit}" for name, (value, unit) in _results(content).items()]
    of = f" (its ANALYSIS: {', '.join(known)})" if known else ""
    why = f"a mean cycle in per cent, not a recording in seconds: both feet strike at {start:g} and {end:g} s"
    raise FormatError(path, f"{why}{of}; give the recorded trial")


def _results(content: C3dContent) -> dict[str, tuple[float, str]]:
    found = {name: content.analysis[name] for name in _RESULTS if name in content.analysis}
    return {name: (value, unit if unit.isprintable() else "") for name, (value, unit) in found.items()}
