"""The child process that reads a C3D file, so that a crash, a hang or a lack of memory stays in it.

Run by `reader.py` as a script of its own: it imports nothing of this package, so it starts quickly.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import json
import os
import sys
import warnings
from typing import Any

import numpy as np

_CHANNEL = "FORCE_PLATFORM:CHANNEL"


def limit(megabytes: int, seconds: int) -> None:
    """No more memory and time than this, where the system can promise it."""
    try:
        import resource
    except ImportError:  # Windows; the parent's clock bounds the time
        return
    for what, amount in ((resource.RLIMIT_AS, megabytes << 20), (resource.RLIMIT_CPU, seconds)):
        with contextlib.suppress(ValueError, OSError):
            resource.setrlimit(what, (amount, amount))


def answer(content: dict[str, Any]) -> dict[str, np.ndarray]:
    """The content as plain arrays; of the analog signals only those of force plates, in their order."""
    parameters = content["parameters"]
    channels = np.asarray(parameters.get(_CHANNEL, []), dtype=float).astype(int).ravel(order="F") - 1
    analog = content["analog"]
    known = (channels >= 0) & (channels < len(analog))
    signals = np.full((len(channels), analog.shape[1]), np.nan)
    signals[known] = analog[channels[known]]
    plain = {
        name: value if isinstance(value, list) else {"shape": value.shape, "numbers": value.ravel().tolist()}
        for name, value in parameters.items()
    }
    return {
        "points": content["points"],
        "signals": signals,
        "rate": np.array(content["rate"]),
        "event_times": np.array(content["event_times"], dtype=float),
        "event_labels": np.array(content["event_labels"], dtype=str),
        "parameters": np.array(json.dumps(plain)),
    }


def main() -> None:
    """Arguments: reader (a module beside this one), file, megabytes, seconds. Writes a NumPy archive."""
    reader, path, megabytes, seconds = sys.argv[1:]
    pipe = os.dup(1)
    os.dup2(2, 1)  # whatever a reader prints is not the answer
    limit(int(megabytes), int(seconds))
    warnings.simplefilter("ignore")
    sys.path.append(os.path.dirname(os.path.abspath(__file__)))
    content = importlib.import_module(reader).load(path)
    out = io.BytesIO()
    np.savez(out, allow_pickle=False, **answer(content))
    with os.fdopen(pipe, "wb") as file:
        file.write(out.getbuffer())


if __name__ == "__main__":
    main()
