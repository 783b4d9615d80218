"""YAML of untrusted files: PyYAML's safe loader, without aliases, limits of size and depth."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from exo_pin.errors import FormatError

_LARGEST = 32 * 2**20
"""Characters; YAML is read slowly: this takes a minute or two, a minute's walk a second."""

_DEEPEST = 32
"""Nodes within nodes; a trajectory has four."""


def load_yaml(path: Path, text: str) -> Any:
    """The one document in a YAML text, as plain lists, dictionaries, texts and numbers.

    Raises:
        FormatError: It is no YAML, too large, too deep, or holds an alias (which can stand for gigabytes).
    """
    import yaml  # 0.03 s, needed here only

    if len(text) > _LARGEST:
        raise FormatError(path, f"larger than {_LARGEST // 2**20} MiB of YAML; use .json, .npz or .csv")
    loader = yaml.CSafeLoader if yaml.__with_libyaml__ else yaml.SafeLoader
    try:
        _check(path, yaml, loader, text)
        return yaml.load(text, loader)
    except yaml.MarkedYAMLError as error:
        line = None if error.problem_mark is None else error.problem_mark.line + 1
        raise FormatError(path, f"no YAML: {str(error.problem)[:200]}", line=line) from error
    except (yaml.YAMLError, ValueError, RecursionError, TypeError) as error:  # TypeError: a list as a key
        why = " ".join(str(error).split())[:200]
        raise FormatError(path, f"no YAML: {why}") from error


def _check(path: Path, yaml: Any, loader: Any, text: str) -> None:
    """Walk through the events, which costs no memory, before anything is built."""
    depth = 0
    for event in yaml.parse(text, loader):
        if isinstance(event, yaml.events.AliasEvent):
            raise FormatError(path, "holds an alias (*); write it out", line=event.start_mark.line + 1)
        depth += isinstance(event, yaml.events.CollectionStartEvent)
        depth -= isinstance(event, yaml.events.CollectionEndEvent)
        if depth > _DEEPEST:
            line = event.start_mark.line + 1
            raise FormatError(path, f"more than {_DEEPEST} levels deep; a trajectory has four", line=line)
