"""`exo-pin doctor`: the installation examined, each fault with its cure."""

from __future__ import annotations

import argparse

from exo_pin.cli import installation, show
from exo_pin.version import __version__

_EXAMPLES = """examples:
  exo-pin doctor                     packages, browser, ffmpeg, wearer's figure, cache, port
  exo-pin doctor --json              the same for a program, or for a report of a fault

ok; differs: from the version that the tests ran with; optional: missing or taken,
and the rest works; wrong: mend it.
exit code 0: nothing is wrong; 1: something is"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(args: argparse.Namespace) -> int:
    """Examine and print; 1 if something is wrong."""
    found = installation.findings()
    wrong = [one.name for one in found if one.state == "wrong"]
    if args.json:
        checks = [one._asdict() for one in found]
        show.as_json({"exo_pin": __version__, "ok": not wrong, "checks": checks})
    else:
        _print(found)
        print(f"wrong: {', '.join(wrong)}" if wrong else "nothing is wrong")
    return 1 if wrong else 0


def _print(found: list[installation.Finding]) -> None:
    """Lines without a table, since the package that draws tables may be what is missing."""
    print(f"exo_pin {__version__}")
    for one in found:
        print(f"  {one.state:9s}{one.name:20s}{show.plain(one.found)}")
        if one.cure:
            print(f"{'':31s}-> {one.cure}")
