"""NumPy archives (.npz) of a walk: arrays time, q, joints and, where there are, base, events, source.

Nothing pickled is read, and no array is made before its size is known to be in the file.
"""

from __future__ import annotations

import ast
import io
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from exo_pin import files
from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, naming_file
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.tables.metadata import MOST_EVENTS, Metadata, event_of, to_gait
from exo_pin.formats.trial_file import TrialFile
from exo_pin.gait import Event, Gait

LARGEST_UNPACKED = 2 * files.LARGEST_FILE
"""An archive's arrays together [bytes]: a million samples with the pelvis's poses, which take 232 MB."""

_MOST_ARRAYS = 64
_LONGEST_DESCRIPTION = 4096
"""Bytes of an array's header; it has some eighty."""

_DTYPE_KINDS = "fiubU"
"""Numbers, booleans and texts; nothing that NumPy would have to unpickle."""


class _Header(NamedTuple):
    shape: tuple[int, ...]
    fortran: bool
    dtype: np.dtype[Any]
    start: int


@dataclass(frozen=True, eq=False)
class ArchiveFile(TrialFile):
    """A NumPy archive.

    Attributes:
        arrays: By name.
    """

    arrays: dict[str, NDArray[Any]]

    def gait(self, options: ReadOptions) -> Gait:
        """The walk of `time (n,)` [s], `q (n, 12)` [rad] and `joints (12,)` names, in any order.

        Raises:
            FormatError: With file and reason: arrays that are missing, or are no walk.
        """
        path, arrays = self.path, self.arrays
        options.refuse(path, "preset", "mapping", "units", why="the array `joints` names them, in radians")
        for name in ("time", "q", "joints"):
            if name not in arrays:
                raise FormatError(
                    path, f"no array {name!r}; expected time [s], q (n, 12) [rad] and joints (12,)"
                )
        joints = [str(name) for name in arrays["joints"].ravel().tolist()[:99]]
        q = arrays["q"]
        if sorted(joints) != sorted(JOINTS) or q.ndim != 2 or q.shape[1] != len(joints):
            raise FormatError(
                path, f"q has shape {q.shape} and {len(joints)} joints; expected {', '.join(JOINTS)}"
            )
        q = self._numbers("q")
        if tuple(joints) != JOINTS:
            q = q[:, [joints.index(joint) for joint in JOINTS]]
        base = self._numbers("base") if "base" in arrays else None
        return to_gait(path, self._numbers("time"), q, base, self._metadata())

    def _metadata(self) -> Metadata:
        arrays, empty = self.arrays, np.empty(0)
        source = str(arrays["source"].ravel()[0])[:10_000] if arrays.get("source", empty).size else None
        periodic = bool(arrays["periodic"].any()) if "periodic" in arrays else False
        return Metadata(self._events(), periodic, source)

    def _numbers(self, name: str) -> Array:
        if self.arrays[name].dtype.kind not in "fiu":
            raise FormatError(self.path, f"array {name!r} holds no numbers")
        return self.arrays[name].astype(np.float64, copy=False)

    def _events(self) -> tuple[Event, ...]:
        names = [f"event_{part}" for part in ("time", "kind", "side", "source")]
        if names[0] not in self.arrays:
            return ()
        columns = [self.arrays[name].ravel().tolist() for name in names if name in self.arrays]
        sizes = {len(column) for column in columns}
        if len(columns) < len(names) or len(sizes) > 1 or sizes.pop() > MOST_EVENTS:
            raise FormatError(self.path, f"arrays {', '.join(names)} must be there together, equally long")
        self._numbers(names[0])
        with naming_file(self.path):
            return tuple(
                event_of(time, str(kind), str(side), str(source))
                for time, kind, side, source in zip(*columns, strict=True)
            )


def open_archive(path: Path) -> ArchiveFile:
    """Read a NumPy archive.

    Raises:
        FormatError: With file and reason: no such archive, arrays that are pickled or too large.
    """
    return ArchiveFile(path, _arrays(path))


def write_archive(gait: Gait, path: Path) -> None:
    """Write every number as it is: reading brings back the same bits."""
    events = gait.events
    arrays: dict[str, NDArray[Any]] = {
        "time": gait.time,
        "q": gait.q,
        "joints": np.array(JOINTS),
        "periodic": np.array(gait.periodic),
        "source": np.array(gait.source),
        "event_time": np.array([event.time for event in events], dtype=float),
        "event_kind": np.array([event.kind for event in events], dtype=str),
        "event_side": np.array([event.side for event in events], dtype=str),
        "event_source": np.array([event.source for event in events], dtype=str),
    }
    if gait.base is not None:
        arrays["base"] = gait.base
    out = io.BytesIO()
    np.savez_compressed(out, allow_pickle=False, **arrays)
    files.write_bytes(path, out.getvalue())


def _arrays(path: Path) -> dict[str, NDArray[Any]]:
    data = files.read_bytes(path)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return {info.filename.removesuffix(".npy"): _member(archive, info) for info in _members(archive)}
    except FormatError:
        raise
    except Exception as error:  # zipfile, zlib and NumPy raise a dozen kinds for damaged archives
        why = " ".join(str(error).split())[:200] or type(error).__name__
        raise FormatError(path, f"not a NumPy archive that can be read: {why}") from error


def _members(archive: zipfile.ZipFile) -> list[zipfile.ZipInfo]:
    members = archive.infolist()
    if len(members) > _MOST_ARRAYS:
        raise ValueError(f"{len(members)} arrays; at most {_MOST_ARRAYS} are read")
    if sum(info.file_size for info in members) > LARGEST_UNPACKED:
        raise ValueError(f"more than {LARGEST_UNPACKED // 2**20} MiB unpacked")
    return members


def _member(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> NDArray[Any]:
    with archive.open(info) as file:  # never yields more than info.file_size
        data = file.read(info.file_size)
    header = _header(data)
    if header.dtype.kind not in _DTYPE_KINDS:
        raise ValueError(
            f"array {info.filename[:40]!r} holds {header.dtype.kind!r}; pickled data are not read"
        )
    count = int(np.prod(header.shape, dtype=object))
    if count * header.dtype.itemsize != len(data) - header.start:
        raise ValueError(f"array {info.filename[:40]!r} is not as long as it says; cut short?")
    flat = np.frombuffer(data, header.dtype, count, header.start) if count else np.empty(0, header.dtype)
    return flat.reshape(header.shape, order="F" if header.fortran else "C")


def _header(data: bytes) -> _Header:
    """The description in front of an array (NumPy's format 1.0 to 3.0), read without trusting it."""
    if data[:6] != b"\x93NUMPY" or len(data) < 12:
        raise ValueError("a member is no NumPy array")
    wide = data[6] > 1
    length = int.from_bytes(data[8 : 12 if wide else 10], "little")
    start = (12 if wide else 10) + length
    if length > _LONGEST_DESCRIPTION or start > len(data):
        raise ValueError("an array's description is too long")
    described = ast.literal_eval(data[start - length : start].decode("utf-8"))
    shape, fortran, dtype = described["shape"], described["fortran_order"], described["descr"]
    if not isinstance(dtype, str) or not all(type(n) is int and 0 <= n < 2**40 for n in shape):
        raise ValueError("an array's description is malformed")
    return _Header(tuple(shape), bool(fortran), np.dtype(dtype), start)
