"""The error of a damaged mesh; the reader of files adds which file it is."""

from __future__ import annotations


class DamagedMeshError(ValueError):
    """A mesh cannot be used; the message is a reason in plain words."""
