"""The time of a run, by the system's clock."""

from __future__ import annotations

from datetime import UTC, datetime


def moment() -> str:
    """Now, as `2026-01-31 14:05+01:00`."""
    try:
        now = datetime.now().astimezone()
    except (ValueError, OverflowError):  # TZ names an offset that no time zone has
        now = datetime.now(UTC)
    return now.isoformat(" ", timespec="minutes")
