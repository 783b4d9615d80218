"""`exo-pin cache`: what is kept between runs, and its deletion."""

from __future__ import annotations

import argparse

from exo_pin import cache
from exo_pin.cli import kept_results, show

_EXAMPLES = """examples:
  exo-pin cache                        the folder, its size and what it holds
  exo-pin cache --clear                delete it all: the last pictures hold walks of patients
  exo-pin replay walk.c3d --no-cache   keep nothing of this walk; every command has the option
  EXO_PIN_CACHE= exo-pin replay ...    the same by the environment; EXO_PIN_CACHE=DIR keeps it in DIR

The folder is ~/.cache/exo_pin, or exo_pin in XDG_CACHE_HOME. Only its owner can read it."""

_WHAT = {"scene": "last pictures of replay: the walks of those who were shown", "urdf": "URDFs of bodies"}


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument("--clear", action="store_true", help="delete what is kept")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(args: argparse.Namespace) -> int:
    """Print what is kept, or delete it."""
    home, kept = cache.folder(), cache.contents()
    deleted = cache.clear() if args.clear else None
    if args.json:
        kinds = {part.kind: {"results": part.number, "bytes": part.size} for part in kept}
        size = 0 if args.clear else sum(part.size for part in kept)
        refusal = cache.refusal(home) if home else "switched off"
        facts = {"folder": home and str(home), "unused_because": refusal or None, "bytes": size}
        show.as_json(facts | {"holds": {} if args.clear else kinds, "deleted": kinds if args.clear else {}})
    elif home is None:
        print("no cache: EXO_PIN_CACHE is empty, or --no-cache is given")
    elif deleted is not None:
        print(f"{home}: {deleted} results deleted")
    else:
        _print(str(home), kept)
    return 0


def _print(home: str, kept: list[cache.Kept]) -> None:
    print(f"{home}: {sum(part.size for part in kept) / 1e6:.1f} MB")
    for part in kept:
        print(f"  {part.number:3d} {_WHAT.get(part.kind, part.kind)}, {part.size / 1e6:.1f} MB")
    kept_results.print_refusal()
