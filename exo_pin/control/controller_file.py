"""Controllers from a user's own Python file, which is run as it is: no sandbox."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType
from typing import Any, cast

from exo_pin import arguments
from exo_pin.control.controller import Controller
from exo_pin.control.users_code import users_code
from exo_pin.errors import DescriptionError, FormatError, UnknownNameError


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
    if not own:
        raise DescriptionError(
            f"{path} holds neither a class nor a function; one of a controller is accepted"
        )
    if not name:
        if len(own) != 1:
            raise DescriptionError(f"{path} holds {', '.join(own)}; name one: {path}:Class")
        name = next(iter(own))
    if name not in own:
        raise UnknownNameError(f"class in {path}", name, own)
    return _made(path, name, own[name])


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
    with users_code(lambda why: FormatError(path, f"cannot be run: {why}")):
        spec.loader.exec_module(module)
    return module


def _made(path: Path, name: str, found: object) -> Controller:
    """The controller itself: a class is instantiated, a function taken as it is."""
    with users_code(lambda why: FormatError(path, f"{name}() fails: {why}")):
        controller: Any = found() if isinstance(found, type) else found
    if not callable(controller):
        raise DescriptionError(f"{path}:{name} cannot be called; (time, q, dq, reference) is what it gets")
    return cast(Controller, controller)  # its answer is checked at every step
