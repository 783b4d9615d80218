"""The time of a run, by the system's clock."""

from __future__ import annotations

from datetime import datetime


def moment() -> str:
    """Now, as `2026-01-31 14:05+01:00`."""
    return datetime.now().astimezone().isoformat(" ", timespec="minutes")
