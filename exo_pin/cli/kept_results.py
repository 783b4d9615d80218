"""The cache of a command line: the option `--no-cache`, and a note where the cache is not used."""

from __future__ import annotations

import sys
from contextlib import AbstractContextManager, nullcontext

from exo_pin import cache

OPTION = "--no-cache"


def chosen(words: list[str]) -> tuple[list[str], AbstractContextManager[None]]:
    """The words without `--no-cache`, and what switches the cache off where it was among them.

    It is found before the words are parsed, because `replay` shows its last picture earlier.
    """
    end = words.index("--") if "--" in words else len(words)
    if OPTION not in words[:end]:
        return words, nullcontext()
    return [w for w in words[:end] if w != OPTION] + words[end:], cache.switched_off()


def print_refusal() -> None:
    """A note where the folder, or a file in it, is not used; the command goes on without."""
    home = cache.folder()
    if home is None:
        return
    why = cache.refusal(home)
    if why:
        print(f"note: the cache {home} is not used: {why}; name another by EXO_PIN_CACHE", file=sys.stderr)
        return
    found = cache.refused_entry()
    if found:
        words = "is not used; exo-pin cache --clear deletes it"
        print(f"note: {found[0]} in the cache {words} ({found[1]})", file=sys.stderr)
