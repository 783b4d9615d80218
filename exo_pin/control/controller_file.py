"""Controllers from a user's own Python file, which is run as it is: no sandbox."""

from __future__ import annotations

import importlib.util
import traceback
from pathlib import Path
from types import ModuleType
from typing import Any, cast

from exo_pin import arguments
from exo_pin.control.controller import Controller
from exo_pin.errors import DescriptionError, FormatError, UnknownNameError

_PACKAGE = Path(__file__).parents[1]
"""Frames in here are ours, not the user's."""


def load_controller(text: str) -> Controller:
    """A controller from `file.py:Class` (or `file.py:function`); without a name the file's only one.

    The file is run with all rights of the user who names it.

    Args:
        text: Path and name.

    Raises:
        FormatError: The file cannot be read or run; the message has its line.
        UnknownNameError: It has no such class or function.
        DescriptionError: It has several and none is named, or what is named cannot be called.
    """
    path, name = _parts(text)
    module = _module(path)
    own = {
        key: value
        for key, value in vars(module).items()
        if callable(value) and getattr(value, "__module__", "") == module.__name__ and not key.startswith("_")
    }
    if not name:
        if len(own) != 1:
            raise DescriptionError(f"{path} holds {', '.join(own) or 'no class'}; name one: {path}:Class")
        name = next(iter(own))
    if name not in own:
        raise UnknownNameError(f"class in {path}", name, own)
    return _made(path, name, own[name])


def raised_where(error: BaseException) -> str:
    """The line at which a user's code raised, and what it says, in one line."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if not Path(frame.filename).is_relative_to(_PACKAGE)]
    place = f"{Path(own[-1].filename).name}:{own[-1].lineno}: " if own else ""
    return f"{place}{type(error).__name__}: {error}"


def _parts(text: str) -> tuple[Path, str]:
    text = arguments.text("controller", text)
    path, _, name = text.rpartition(":") if not text.endswith(".py") else (text, "", "")
    return Path(path), name


def _module(path: Path) -> ModuleType:
    if not path.is_file():
        raise FormatError(path, "is not a file; a Python file with a controller is accepted")
    spec = importlib.util.spec_from_file_location(f"controller_{path.stem}", path)
    if spec is None or spec.loader is None:
        raise FormatError(path, "is not a Python file (.py)")
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:  # whatever a user's file raises
        raise FormatError(path, f"cannot be run: {raised_where(error)}") from error
    return module


def _made(path: Path, name: str, found: object) -> Controller:
    """The controller itself: a class is instantiated, a function taken as it is."""
    try:
        controller: Any = found() if isinstance(found, type) else found
    except Exception as error:  # whatever a user's class raises
        raise FormatError(path, f"{name}() raises: {raised_where(error)}") from error
    if not callable(controller):
        raise DescriptionError(f"{path}:{name} cannot be called; (time, q, dq, reference) is what it gets")
    return cast(Controller, controller)  # its answer is checked at every step
