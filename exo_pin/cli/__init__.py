"""The command line `exo-pin`: the table of commands, the entry point, exit codes and error messages."""

from __future__ import annotations

import argparse
import errno
import os
import sys
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from exo_pin.cli import kept_results, output_files, stopping
from exo_pin.cli.parser import Parser
from exo_pin.cli.plain_output import plain_output
from exo_pin.errors import ConvergenceError, ExoPinError, LimitError, UnknownNameError, shortened
from exo_pin.version import __version__

COMMANDS = {
    "replay": "watch the exoskeleton walk in the browser, or write one offline page",
    "picture": "one moment of the walk as a PNG",
    "film": "the walk as GIF, WebM or MP4",
    "report": "a walk, trials side by side, or a folder, as a page for a clinician or engineer",
    "normal": "a normal band of your own recordings, for report --normal",
    "reproduce": "the paper's figures from our data, with a page that compares",
    "check": "cross-check kinematics and inverse kinematics on a gait",
    "info": "what a gait file holds: joints, ranges, events",
    "fk": "forward kinematics: a gait's foot poses as CSV",
    "ik": "inverse kinematics: joint angles from a table of foot poses",
    "convert": "a gait from one file format to another",
    "cycles": "a walk cut into cycles: mean, spread, spatiotemporal numbers",
    "edit": "adjust a walk: time, amplitude, stride, clearance, sides, ramps, smoothing",
    "body": "make a body file from a person's measures",
    "urdf": "the exoskeleton's URDF for a body",
    "export": "the exoskeleton as a model of MuJoCo, OpenSim or ROS 2",
    "devices": "the exoskeletons and planar models to choose from",
    "compare": "what each device loses of a walk",
    "joints": "which joints of a leg are worth their motor",
    "study": "all devices under many walks and on many bodies: a table and a page",
    "retarget": "a walk as joint angles of a humanoid",
    "torques": "what every joint of a walk bears: inverse dynamics, shared by motors and person",
    "feasible": "whether a device can do a walk with a person",
    "plan": "footsteps become a walk from rest to rest that nothing has to hold",
    "simulate": "the exoskeleton walks by torques: verdict, motors, the patient's part",
    "size": "which motor and gear bear a walk, and the worst over bodies and speeds",
    "doctor": "what is installed here, what is missing, and the cure",
    "dh": "the Denavit-Hartenberg table for a body",
    "cache": "what is kept between runs, and its deletion",
    "completion": "the completion of commands and options for bash, zsh or fish",
}
"""Commands and their help; each is a module of `commands`: `configure(parser)`, `run(args) -> exit code`."""

_EPILOG = """examples:
  exo-pin replay                       the normal walk, live in the browser
  exo-pin replay walk.mot --html w.html    a recording as one offline page
  exo-pin walk.mot                     a file alone is replayed
  exo-pin COMMAND --help               options and examples of a command

exit codes: 0 done, 1 the verdict is no, 2 bad input, 128 + n stopped by signal n (Ctrl-C: 130)"""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line.

    Args:
        argv: The words behind `exo-pin`; those of the process if left out.

    Returns:
        The exit code: 0 done, 1 the verdict is no, 2 bad input, 128 + n stopped by signal n.
    """
    words = list(sys.argv[1:] if argv is None else argv)
    try:
        with stopping.stoppable(), plain_output():
            return _answered(words)
    except KeyboardInterrupt as stop:
        return stopping.exit_code(stop)


def _answered(words: list[str]) -> int:
    """Run the words; bad input and a verdict become a line on stderr and an exit code."""
    try:
        try:
            return _run(words)
        finally:
            if sys.stdout is not None:
                sys.stdout.flush()  # a closed pipe raises here, not while the interpreter exits
    except ExoPinError as error:
        print(f"exo-pin: {shortened(str(error))}", file=sys.stderr)
        return 1 if isinstance(error, (LimitError, ConvergenceError)) else 2
    except ModuleNotFoundError as error:
        from exo_pin.cli import missing

        said = missing.sentence(error)
        if said is None:
            raise
        print(f"exo-pin: {said}", file=sys.stderr)
        return 2
    except BrokenPipeError:  # `exo-pin dh | head -1`: the reader has closed the pipe
        _discard_output()
        return 0
    except OSError as error:
        if error.errno != errno.ENAMETOOLONG:
            raise
        print(f"exo-pin: {shortened(str(error.filename), 120)}: the file name is too long", file=sys.stderr)
        return 2


def _run(words: list[str]) -> int:
    """Run the words, with or without the cache; the exit code."""
    words, cache = kept_results.chosen(words)
    with cache:
        return _run_command(words)


def _run_command(words: list[str]) -> int:
    """Parse the words and run the command; its exit code."""
    if len(words) == 1 and words[0] not in COMMANDS and not words[0].startswith("-"):
        if not Path(words[0]).suffix and not Path(words[0]).exists():
            raise UnknownNameError("command or file", words[0], COMMANDS)
        words.insert(0, "replay")
    with _early(words) as server:
        parser = command_parser(words)
        args = parser.parse_args(words, argparse.Namespace(words=words, server=server))
        if args.command is None:
            parser.print_help()
            return 0
        from exo_pin import scratch

        scratch.sweep()
        if args.command != "cache":  # it says so itself
            kept_results.print_refusal()
        command = _module(args.command)
        with output_files.watched(args, getattr(command, "outputs", lambda _: ())(args)):
            code: int = command.run(args)
        return code


def _early(words: list[str]) -> AbstractContextManager[Any]:
    """What runs before the words are parsed, since that imports NumPy: `replay` shows its last picture."""
    if words[:1] != ["replay"]:
        return nullcontext()
    last_picture = import_module("exo_pin.cli.last_picture")
    return last_picture.serve(words) or nullcontext()


def _discard_output() -> None:
    """Send what stdout still holds to nowhere, so that the interpreter can flush it when it exits."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)


def command_parser(words: Sequence[str]) -> argparse.ArgumentParser:
    """The parser. It imports only the command in use, so that help stays quick.

    Args:
        words: The words to be parsed; a command among them gets its options.
    """
    parser = Parser(
        prog="exo-pin",
        description="A person's walk becomes an exoskeleton's walk.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"exo-pin {__version__}")
    parser.add_argument(
        kept_results.OPTION, action="store_true", help="keep nothing between runs, use nothing that was kept"
    )
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", title="commands")
    for name, summary in COMMANDS.items():
        command = commands.add_parser(
            name,
            help=summary,
            description=f"{summary[0].upper()}{summary[1:]}.",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        if name in words:
            _module(name).configure(command)
    return parser


def _module(name: str) -> ModuleType:
    return import_module(f"exo_pin.cli.commands.{name}")
