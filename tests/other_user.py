"""Another user of the machine, for tests that run as root: what may he read?"""

from __future__ import annotations

from pathlib import Path

NOBODY = 65534
"""A user without rights."""


def reachable(folder: Path) -> None:
    """Let others enter a folder of a test and all above it: pytest closes its own, however deep they are."""
    for each in (*folder.parents, folder):
        if not each.stat().st_mode & 0o001:
            each.chmod(0o755)
