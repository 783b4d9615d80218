"""The child process that expands a xacro file: its expressions reach neither files elsewhere nor the system.

Run by `expansion.py` as a script of its own. xacro evaluates expressions as Python, and its own checks can be
passed by; so names that lead out of an expression are refused before it runs, and the interpreter's audit
hook refuses every other file, every process and every connection.
"""

from __future__ import annotations

import ast
import builtins
import contextlib
import io
import json
import os
import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

_PACKAGE = Path(__file__).resolve().parent.parent

_INWARD = (
    "gi_frame gi_code cr_frame cr_code ag_frame ag_code tb_frame mro format_map "
    "f_back f_builtins f_globals f_locals f_code"
)
"""Attributes by which an expression would reach the interpreter, besides those that begin with `__`."""

_BUILTINS = (
    "abs all any bool dict divmod enumerate float int len list map max min range reversed round set sorted "
    "str sum tuple zip"
)
"""What `$(eval ...)` may call."""

_HARMLESS = (
    "open compile exec import object. glob. os.listdir os.scandir os.walk builtins.id marshal. code. "
    "sys._getframe pathlib. re. time.sleep"
)
"""Audit events that are allowed, or judged by themselves (`open`)."""

_LARGEST = 32 * 2**20
"""Characters of the text that comes out."""


class _RefusedError(Exception):
    """What the file wants is not allowed."""


def limit(megabytes: int, seconds: int) -> None:
    """No more memory and time than this, where the system can promise it."""
    try:
        import resource
    except ImportError:  # Windows; the parent's clock bounds the time
        return
    for what, amount in ((resource.RLIMIT_AS, megabytes << 20), (resource.RLIMIT_CPU, seconds)):
        with contextlib.suppress(ValueError, OSError):
            resource.setrlimit(what, (amount, amount))


class _Reach:
    """The folders that may be read: those of the file, of packages that it names, and Python's own."""

    def __init__(self, path: Path) -> None:
        from exo_pin import ros_packages

        self.path, self.packages, self.looking = path.resolve(), ros_packages, False
        self.folders = {*map(os.path.realpath, ros_packages.own(self.path)), os.path.realpath(_PACKAGE)}
        self.folders |= {os.path.realpath(folder) for folder in sys.path if folder}

    def package(self, name: str) -> str:
        """The folder of a ROS package that a xacro file names."""
        self.looking = True  # for package.xml, in folders around the file
        try:
            found = next(filter(Path.is_dir, self.packages.named(self.path, name)), None)
        finally:
            self.looking = False
        if found is not None:
            self.folders.add(os.path.realpath(found))
            return str(found)
        raise _RefusedError(
            f"$(find {name[:60]}): there is no package {name[:60]!r} (a folder with package.xml) above or "
            "beside the file, nor on ROS_PACKAGE_PATH or AMENT_PREFIX_PATH"
        )

    def hook(self, event: str, arguments: tuple[Any, ...]) -> None:
        """What the interpreter calls before it does something that matters outside."""
        if event == "open":
            self._judge_open(*arguments[:3])
        elif not event.startswith(tuple(_HARMLESS.split())):
            raise _RefusedError(f"its expressions must not do that ({event})")

    def _judge_open(self, path: object, mode: object, flags: object) -> None:
        if isinstance(path, int) or self.looking:
            return
        writes = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
        real = os.path.realpath(os.fsdecode(path))  # type: ignore[arg-type]
        inside = any(Path(real).is_relative_to(folder) for folder in self.folders)
        if not inside or (isinstance(flags, int) and flags & writes):
            raise _RefusedError(f"must not open {real[:80]!r}: not in a package of this file")


def judged(expression: str) -> Any:
    """The compiled expression; raises `_RefusedError` where a name in it would lead outside."""
    tree = ast.parse(expression.strip(), "<expression>", "eval")
    for name in _names(ast.walk(tree)):
        if name.startswith("__") or name in _INWARD.split():
            raise _RefusedError(f"its expressions must not use {name[:40]}")
    return compile(tree, "<expression>", "eval")


def _names(nodes: Iterable[ast.AST]) -> Iterator[str]:
    for node in nodes:
        if isinstance(node, ast.Name):
            yield node.id
        elif isinstance(node, ast.Attribute):
            yield node.attr


def restrict(xacro: Any, substitution_args: Any, reach: _Reach) -> None:
    """Replace the parts of xacro that read files and evaluate expressions by careful ones.

    Args:
        xacro: The package.
        substitution_args: Its module, which evaluates `$(...)`.
        reach: What may be read.
    """
    from exo_pin.safe.xml_reader import XmlLimits, load_xml

    few = {name: getattr(builtins, name) for name in _BUILTINS.split()}
    own_parse: Callable[..., Any] = xacro.parse

    def parse(text: Any, filename: str | None = None) -> Any:
        whole = os.path.join(xacro.root_dir, filename or "")
        if text is None and os.path.exists(whole):
            load_xml(Path(whole), XmlLimits(mebibytes=8, elements=50_000))
        return own_parse(text, filename)

    def _safe_eval(expression: str, symbols: dict[str, Any], local: Any = None) -> Any:
        symbols.update(__builtins__={})
        return eval(judged(expression), symbols, local)

    def _evaluate(expression: str, _: object, local: Any) -> Any:
        return eval(judged(expression), {"__builtins__": few}, local)

    xacro.parse, xacro.safe_eval = parse, _safe_eval
    substitution_args.eval, substitution_args._eval_find = _evaluate, reach.package
    sys.addaudithook(reach.hook)


def answer(path: Path) -> tuple[str, str]:
    """The URDF's text and "", or "" and the reason of the failure."""
    import glob  # noqa: F401 - loaded before files are judged, as is what xacro imports late

    import xacro
    import yaml  # noqa: F401
    from xacro import substitution_args

    from exo_pin.errors import ExoPinError

    restrict(xacro, substitution_args, _Reach(path))
    try:
        text = str(xacro.process_file(str(path)).documentElement.toxml())
    except (_RefusedError, ExoPinError) as error:
        return "", str(error)
    except MemoryError:
        return "", "xacro cannot expand it: it takes too much memory; endless macros?"
    except RecursionError:
        return "", "xacro cannot expand it: macros or properties within themselves"
    except Exception as error:  # xacro lets ZeroDivisionError, XMLSyntaxError and others pass
        inner = getattr(error, "exc", None)
        why = str(inner) if isinstance(inner, (_RefusedError, ExoPinError)) else str(error)
        return "", f"xacro cannot expand it: {why[:500]}"
    return (text, "") if len(text) <= _LARGEST else ("", "xacro makes more than 32 MiB of it")


def main() -> None:
    """Arguments: file, megabytes, seconds. Writes what `answer` returns as JSON."""
    path, megabytes, seconds = sys.argv[1:]
    pipe = os.dup(1)
    nowhere = io.StringIO()  # xacro reports on the console
    limit(int(megabytes), int(seconds))
    sys.path.append(str(_PACKAGE.parent))
    with contextlib.redirect_stderr(nowhere), contextlib.redirect_stdout(nowhere):
        found = answer(Path(path))
    with os.fdopen(pipe, "w", encoding="utf-8") as out:
        json.dump(found, out)


if __name__ == "__main__":
    main()
