"""The child process that runs ezc3d, so that a crash, a hang or a lack of memory stays in it.

Run by `ezc3d_reader.py` as a script of its own: it imports nothing of this package, so it starts quickly.
"""

from __future__ import annotations

import contextlib
import io
import os
import sys

import numpy as np

_TEXT_PARAMETERS = {
    "labels": ("POINT", "LABELS"),
    "angles": ("POINT", "ANGLES"),
    "forces": ("POINT", "FORCES"),
    "moments": ("POINT", "MOMENTS"),
    "powers": ("POINT", "POWERS"),
    "scalars": ("POINT", "SCALARS"),
    "units": ("POINT", "UNITS"),
    "angle_units": ("POINT", "ANGLE_UNITS"),
    "y_screen": ("POINT", "Y_SCREEN"),
    "event_labels": ("EVENT", "LABELS"),
    "event_contexts": ("EVENT", "CONTEXTS"),
    "analysis_names": ("ANALYSIS", "NAMES"),
    "analysis_units": ("ANALYSIS", "UNITS"),
}
"""Array -> parameter of texts; those with more than 255 texts go on in LABELS2, LABELS3 ..."""

_MOST_CONTINUATIONS = 40
"""Continuations of a parameter that are looked for."""


def limit(megabytes: int, seconds: int) -> None:
    """No more memory and time than this, where the system can promise it."""
    import resource

    for what, amount in ((resource.RLIMIT_AS, megabytes << 20), (resource.RLIMIT_CPU, seconds)):
        with contextlib.suppress(ValueError, OSError):
            resource.setrlimit(what, (amount, amount))


def load(path: str):  # type: ignore[no-untyped-def]  # ezc3d has no types
    """The file; without force plates where ezc3d does not understand them."""
    import ezc3d

    with contextlib.suppress(Exception):  # ezc3d raises what it likes for plates of unknown type
        return ezc3d.c3d(path, extract_forceplat_data=True)
    return ezc3d.c3d(path)


def arrays(file) -> dict[str, np.ndarray]:  # type: ignore[no-untyped-def]
    """Points, outputs, events and parameters by name."""
    parameters = file["parameters"]
    out = {name: np.array(_texts(parameters, *place), dtype=str) for name, place in _TEXT_PARAMETERS.items()}
    out["points"] = file["data"]["points"][:3]
    out["event_times"] = _numbers(parameters, "EVENT", "TIMES")
    out["analysis_values"] = _numbers(parameters, "ANALYSIS", "VALUES").ravel()
    mass = np.atleast_1d(parameters.get("PROCESSING", {}).get("Bodymass", {}).get("value", []))
    out["mass"] = np.asarray(mass[:1], dtype=float)
    rate = parameters.get("ANALOG", {}).get("RATE", {}).get("value", [0.0])
    out["analog_rate"] = np.array(float(rate[0]) if len(rate) else 0.0)
    return out


def force_plates(file) -> dict[str, np.ndarray]:  # type: ignore[no-untyped-def]
    """Force plates by number and quantity, up to the first that is not understood."""
    out = {}
    with contextlib.suppress(KeyError, TypeError, ValueError):
        for k, plate in enumerate(file["data"].get("platform", [])):
            for name in ("force", "center_of_pressure", "Tz"):
                out[f"plate_{k}_{name}"] = np.asarray(plate[name], dtype=float)
            out[f"plate_{k}_units"] = np.array([plate[f"unit_{x}"] for x in ("force", "moment", "position")])
    return out


def _texts(parameters, group: str, name: str) -> list[str]:  # type: ignore[no-untyped-def]  # ezc3d has no types
    entries = parameters.get(group, {})
    names = [name, *(f"{name}{k}" for k in range(2, _MOST_CONTINUATIONS))]
    return [str(text) for key in names if key in entries for text in entries[key]["value"]]


def _numbers(parameters, group: str, name: str) -> np.ndarray:  # type: ignore[no-untyped-def]
    """The numbers of a parameter in its own shape; those of NAME2, NAME3 .. behind it."""
    entries = parameters.get(group, {})
    names = [name, *(f"{name}{k}" for k in range(2, _MOST_CONTINUATIONS))]
    found = []
    with contextlib.suppress(TypeError, ValueError):  # a text where numbers belong
        found = [np.atleast_2d(np.asarray(entries[key]["value"], float)) for key in names if key in entries]
        return np.concatenate(found, axis=1)
    return found[0] if found else np.zeros((2, 0))


def main() -> None:
    """Arguments: file, megabytes, seconds. Writes a NumPy archive to standard output."""
    path, megabytes, seconds = sys.argv[1:]
    pipe = os.dup(1)
    os.dup2(2, 1)  # whatever ezc3d prints is not the answer
    limit(int(megabytes), int(seconds))
    content = load(path)
    answer = arrays(content) | force_plates(content)
    out = io.BytesIO()
    np.savez(out, allow_pickle=False, **answer)
    with os.fdopen(pipe, "wb") as file:
        file.write(out.getbuffer())


if __name__ == "__main__":
    main()
