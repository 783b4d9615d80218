"""Who was recorded, where and when, as far as a C3D file's parameters have it."""

from __future__ import annotations

from exo_pin.formats.c3d.parameters import C3dParameters

_WORDS = {
    "person": ("SUBJECTS:NAMES", "SUBJECT:NAME", "PATIENT:NAME", "PATIENT:CODE"),
    "age": ("SUBJECTS:AGE", "SUBJECT:AGE", "PROCESSING:AGE", "PATIENT:AGE"),
    "date of birth": ("SUBJECTS:DATE_OF_BIRTH", "SUBJECT:DATE_OF_BIRTH", "PATIENT:DATE_OF_BIRTH"),
    "diagnosis": ("SUBJECT:DIAGNOSIS", "PATIENT:DIAGNOSIS"),
    "laboratory": ("MANUFACTURER:LABORATORY", "TRIAL:LABORATORY", "SESSION:LABORATORY", "INSTITUTION:NAME"),
    "recorded": ("TRIAL:DATE", "TRIAL:DATE_TIME", "SESSION:DATE", "TRIAL:TIME"),
    "recorded with": ("MANUFACTURER:SOFTWARE", "MANUFACTURER:COMPANY"),
}
"""What is printed -> parameters that hold it, the better first; they are not standardised."""


def session(parameters: C3dParameters) -> dict[str, str]:
    """Words by what they are; what no parameter states is left out."""
    found = {}
    for what, places in _WORDS.items():
        words = next(filter(None, (_words(parameters, place) for place in places)), "")
        if words:
            found[what] = words
    version = parameters.text("MANUFACTURER:VERSION_LABEL")
    if version and found.get("recorded with"):
        found["recorded with"] += f" {version.strip()}"
    return found


def _words(parameters: C3dParameters, place: str) -> str:
    text = parameters.text(place)
    if text is None:
        value = parameters.number(place)
        return "" if not value else f"{value:g}"
    return " ".join(text.split())[:80]
