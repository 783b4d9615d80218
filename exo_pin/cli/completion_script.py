"""Completion of the command line in a shell: its script, made from the parser."""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

SHELLS = ("bash", "zsh", "fish")


class Completed(NamedTuple):
    """What a command is completed with.

    Attributes:
        summary: The command in words.
        options: Long option -> the words that it takes; empty: a file or a number, or nothing.
        words: Those of the first argument; files besides.
    """

    summary: str
    options: Mapping[str, tuple[str, ...]]
    words: tuple[str, ...]


def completed(parser: argparse.ArgumentParser, names: Mapping[str, Sequence[str]]) -> dict[str, Completed]:
    """Commands with their options and words.

    Args:
        parser: With every command configured.
        names: Option, or the name of the first argument -> words that the parser does not know.
    """
    (commands,) = (x for x in parser._actions if isinstance(x, argparse._SubParsersAction))
    summaries = {entry.dest: entry.help or "" for entry in commands._choices_actions}
    return {name: Completed(summaries[name], *_parts(one, names)) for name, one in commands.choices.items()}


def _parts(
    command: argparse.ArgumentParser, names: Mapping[str, Sequence[str]]
) -> tuple[dict[str, tuple[str, ...]], tuple[str, ...]]:
    options: dict[str, tuple[str, ...]] = {}
    words: tuple[str, ...] = ()
    for action in command._actions:
        known = tuple(map(str, action.choices or ()))
        for option in action.option_strings:
            if option.startswith("--"):
                options[option] = known or tuple(names.get(option, ()))
        if not action.option_strings and not words:
            words = known or tuple(names.get(str(action.metavar), ()))
    return options, words


def script(shell: str, commands: Mapping[str, Completed]) -> str:
    """The script that a shell reads.

    Args:
        shell: One of `SHELLS`.
        commands: Of `completed`.
    """
    if shell == "fish":
        return "\n".join(_fish(commands)) + "\n"
    head = ["autoload -U +X bashcompinit && bashcompinit"] if shell == "zsh" else []
    return "\n".join([*head, *_bash(commands)]) + "\n"


def _bash(commands: Mapping[str, Completed]) -> Iterator[str]:
    yield "_exo_pin() {"
    yield '    local cur="${COMP_WORDS[COMP_CWORD]}" prev="${COMP_WORDS[COMP_CWORD-1]}" command="" word'
    yield '    for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do'
    yield f'        case "$word" in {"|".join(commands)}) command="$word"; break ;; esac'
    yield "    done"
    yield '    case "$command $prev" in'
    for name, entry in commands.items():
        for option, words in entry.options.items():
            if words:
                yield f'        "{name} {option}") {_replies(words)}; return ;;'
    yield "    esac"
    yield '    case "$command" in'
    yield f'        "") {_replies(commands, files=True)} ;;'
    for name, entry in commands.items():
        yield f"        {name})"
        yield f'            if [[ "$cur" == -* ]]; then {_replies(entry.options)}'
        yield f"            else {_replies(entry.words, files=True)}; fi ;;"
    yield "    esac"
    yield "}"
    yield "complete -o filenames -F _exo_pin exo-pin"


def _replies(words: Iterable[str], *, files: bool = False) -> str:
    """Bash: offer those of the words that begin like the one being typed, with `files` files too."""
    more = ' $(compgen -f -- "$cur")' if files else ""
    return f'COMPREPLY=($(compgen -W "{" ".join(words)}" -- "$cur"){more})'


def _fish(commands: Mapping[str, Completed]) -> Iterator[str]:
    for name, entry in commands.items():
        yield f"complete -c exo-pin -n __fish_use_subcommand -a {name} -d {shlex.quote(entry.summary)}"
        seen = f'-n "__fish_seen_subcommand_from {name}"'
        if entry.words:
            yield f'complete -c exo-pin {seen} -a "{" ".join(entry.words)}"'
        for option, words in entry.options.items():
            takes = f' -x -a "{" ".join(words)}"' if words else ""
            yield f"complete -c exo-pin {seen} -l {option.removeprefix('--')}{takes}"
