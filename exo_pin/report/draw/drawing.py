"""A finished picture, as SVG text or PNG bytes, with its title and file name."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Drawing:
    """One picture.

    Attributes:
        name: Its file name without the ending.
        title: What it shows.
        svg: The picture as SVG text; empty for a PNG.
        png: The picture as PNG bytes; empty for an SVG.
    """

    name: str
    title: str
    svg: str = ""
    png: bytes = b""

    @property
    def file(self) -> str:
        """Its file name."""
        return f"{self.name}.svg" if self.svg else f"{self.name}.png"

    @property
    def data(self) -> bytes:
        """The content of its file."""
        return self.svg.encode() + b"\n" if self.svg else self.png
