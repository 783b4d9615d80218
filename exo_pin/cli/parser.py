"""The parser of the command line: choices and numbers in any clear spelling, and "did you mean"."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any, NoReturn

from exo_pin.cli import measures
from exo_pin.errors import hint, same_name


class Parser(argparse.ArgumentParser):
    """`argparse.ArgumentParser` for people: `--sex F`, `--gap 1,5`, `--speeds slow,free`, "did you mean".

    argparse has no public place for the first methods; they are the same from Python 3.11 to 3.14.
    """

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.register("type", float, measures.number)

    def _get_values(self, action: argparse.Action, arg_strings: list[str]) -> Any:
        if action.nargs == "+" and action.choices is not None:
            arg_strings = measures.listed(arg_strings)
        return super()._get_values(action, arg_strings)

    def _get_value(self, action: argparse.Action, arg_string: str) -> Any:
        value = super()._get_value(action, arg_string)
        if isinstance(action, argparse._SubParsersAction):  # its words are the command's own, too
            return value
        if action.choices is None or not isinstance(value, str):
            return value
        return _understood(value, tuple(action.choices))

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            raise argparse.ArgumentError(
                action, f"{str(value)!r} is unknown; {hint(str(value), map(str, action.choices))}"
            )

    def parse_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse, and answer an unknown option with the nearest one that the command has."""
        found, rest = self.parse_known_args(args, namespace)
        if rest:
            command = getattr(found, "command", None)
            words = "; ".join(_unknown(word, self._options_of(command)) for word in rest)
            self.exit(2, f"{self.prog}: {words}; {self._usage_of(command)}\n")
        return found

    def _usage_of(self, command: str | None) -> str:
        """One line: the command with its files, and where its options are explained."""
        parser = self._command(command) or self
        words = [str(x.metavar or x.dest) for x in parser._actions if not x.option_strings]
        return f"usage: {' '.join([parser.prog, *words])} [options] (see {parser.prog} --help)"

    def _command(self, name: str | None) -> argparse.ArgumentParser | None:
        """The parser of a command."""
        for action in self._actions:
            if isinstance(action, argparse._SubParsersAction) and name in action.choices:
                found: argparse.ArgumentParser = action.choices[name]
                return found
        return None

    def _options_of(self, command: str | None) -> tuple[str, ...]:
        return tuple((self._command(command) or self)._option_string_actions)

    def error(self, message: str) -> NoReturn:
        """One line on stderr, exit code 2."""
        self.exit(2, f"{self.prog}: {' '.join(message.split())} (see {self.prog} --help)\n")


def _understood(word: str, choices: Sequence[str]) -> str:
    """The choice that the word stands for: its other spelling, or its only beginning; else the word."""
    same = same_name(word, choices)
    begun = [choice for choice in choices if str(choice).casefold().startswith(word.casefold())]
    return same or (begun[0] if len(begun) == 1 and word else word)


def _unknown(word: str, known: Sequence[str]) -> str:
    if not word.startswith("-"):
        return f"{word!r} is one word too many"
    option = word.partition("=")[0]
    return f"unknown option {option!r}; {hint(option, [name for name in known if name.startswith('--')])}"
