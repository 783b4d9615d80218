"""Files in and out: a size cap when reading, never a half-written file when writing; numbers for JSON."""

from __future__ import annotations

import contextlib
import math
import os
import re
import secrets
from pathlib import Path

from exo_pin.errors import FormatError

LARGEST_FILE = 128 * 2**20
"""No more than this is read [bytes]: an hour of a walk at 100 Hz in full digits; bounds time and memory."""


_CONTROL = re.compile("[\0-\x08\x0e-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
"""What a terminal obeys (escapes, bells, reversed writing), but for blanks and ends of lines."""


def control_character(text: str) -> str:
    """The first control character of a text as its code, e.g. `U+001B`; empty if it has none."""
    found = _CONTROL.search(text)
    return f"U+{ord(found[0]):04X}" if found else ""


def without_control(text: str) -> str:
    """A text for a terminal: U+FFFD stands for each control character."""
    return _CONTROL.sub("\N{REPLACEMENT CHARACTER}", text)


def read_lines(path: str | Path) -> list[str]:
    """The lines of a UTF-8 text file without their ends, whatever ends them (Unix, Windows, old Mac).

    Raises:
        FormatError: If it is no file, cannot be read, is too large, or is not text.
    """
    return read_text(path).split("\n")


def read_text(path: str | Path) -> str:
    """A UTF-8 text file with Unix line ends and no control characters; errors as in `read_lines`."""
    path = Path(path)
    return _unix(_decoded(path, read_bytes(path)))


def first_lines(path: Path, size: int) -> list[str]:
    """The lines in the first bytes of a file, as far as they are text; none where it cannot be read.

    For recognising a format; the last line may be cut.

    Args:
        path: The file.
        size: How much is read [bytes].
    """
    try:
        if not path.is_file():  # opening a pipe would wait for its writer
            return []
        with path.open("rb") as file:
            head = file.read(size)
    except (OSError, ValueError):  # ValueError: a path with a zero byte in it
        return []
    return _unix(head.decode("utf-8-sig", "replace")).split("\n")


def read_bytes(path: str | Path) -> bytes:
    """A whole file.

    Raises:
        FormatError: If it is no file, cannot be read, or is larger than `LARGEST_FILE`.
    """
    path = Path(path)
    try:
        if not path.exists():
            raise FormatError(path, "no such file")
        if not path.is_file():
            raise FormatError(path, "not a file" + (" but a folder" if path.is_dir() else ""))
        with path.open("rb") as file:
            size = os.fstat(file.fileno()).st_size  # known before a byte is read
            data = file.read(size + 1) if size <= LARGEST_FILE else b""
            if len(data) > size:  # it grows, or its size is not known (/proc)
                data += file.read(LARGEST_FILE + 1 - len(data))
    except (OSError, ValueError) as error:  # ValueError: a path with a zero byte in it
        raise FormatError(path, f"cannot be read: {_reason(error)}") from error
    if max(size, len(data)) > LARGEST_FILE:
        raise FormatError(path, f"larger than {LARGEST_FILE // 2**20} MiB; split or resample the recording")
    return data


def _unix(text: str) -> str:
    """The text with the line ends of Unix."""
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _decoded(path: Path, data: bytes) -> str:
    if b"\0" in data:
        raise FormatError(path, "not a text file (it holds zero bytes); expected UTF-8 text")
    try:
        text = data.decode("utf-8-sig").removesuffix("\x1a")  # by which DOS ends a text
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise FormatError(path, "not UTF-8 text; save the file as UTF-8", line=line) from error
    found = _CONTROL.search(text)
    if found is not None:
        code = control_character(found[0])
        why = f"holds the control character {code}; remove it, expected plain text"
        raise FormatError(path, why, line=text.count("\n", 0, found.start()) + 1)
    return text


def write_text(path: str | Path, text: str) -> None:
    """Write UTF-8 text, all or nothing; errors as in `write_bytes`."""
    try:
        data = text.encode("utf-8")
    except UnicodeEncodeError as error:  # half a character, which no file can hold
        raise FormatError(path, f"cannot be written: {error}") from error
    write_bytes(path, data)


def write_bytes(path: str | Path, data: bytes) -> None:
    """Write a file: first to a temporary name in the same folder, then renamed, so all or nothing.

    A link is followed; what is no plain file (a terminal, a pipe, /dev/null) is written to directly.

    Raises:
        FormatError: If the file cannot be written.
    """
    shown = Path(path)
    try:
        target = Path(os.path.realpath(shown))
        if len(data) > LARGEST_FILE:  # nobody could load it again
            raise ValueError(f"larger than {LARGEST_FILE // 2**20} MiB; resample or split the recording")
        if target.exists() and not target.is_file() and not target.is_dir():
            target.write_bytes(data)
        else:
            _replace(target, data)
    except (OSError, ValueError) as error:
        raise FormatError(shown, f"cannot be written: {_reason(error)}") from error


def write_private(path: str | Path, data: bytes) -> None:
    """Write a file that its owner alone can read, all or nothing; a link of that name is replaced.

    Raises:
        OSError: The file cannot be written.
    """
    _replace(Path(path), data, private=True)


def json_number(value: float) -> float | None:
    """A number for JSON, which knows no NaN: None (`null`) stands for it."""
    return None if math.isnan(value) else float(value)


def _replace(target: Path, data: bytes, *, private: bool = False) -> None:
    def opened(name: str, flags: int) -> int:
        return os.open(name, flags, 0o600 if private else 0o666)

    draft = target.with_name(f".{target.name[:99]}.{secrets.token_hex(4)}.part")
    try:
        # x: never into a file or link that somebody else has put there
        with open(draft, "xb", opener=opened) as file:
            file.write(data)
        if target.exists() and not private:
            draft.chmod(target.stat().st_mode & 0o777)
        draft.replace(target)
    except BaseException:  # an interrupted write must not leave its draft behind either
        with contextlib.suppress(OSError):
            draft.unlink()
        raise


def _reason(error: Exception) -> str:
    return (error.strerror if isinstance(error, OSError) else None) or str(error)
