"""Reports of several trials."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from exo_pin.errors import DescriptionError

if TYPE_CHECKING:
    from exo_pin.clinic import NormalBand
    from exo_pin.report import Document


def document(args: argparse.Namespace, band: NormalBand | None) -> Document:
    """To come."""
    raise DescriptionError("one walk, please")
