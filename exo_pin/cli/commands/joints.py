"""`exo-pin joints`: which joints of a leg are worth their motor."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import options, show
from exo_pin.errors import DescriptionError
from exo_pin.files import write_text

if TYPE_CHECKING:
    from exo_pin.compare import Worth

_EXAMPLES = """examples:
  exo-pin joints                     the normal walk
  exo-pin joints walk.mot -o pareto.svg     the figure; also .md, .csv (all 64 choices) and .json

Every choice of the six movements of a leg is tried, the same on both legs: what the soles then miss when the
device does its best and the pelvis moves as recorded."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("-o", "--output", metavar="FILE", help="write .svg, .md, .csv or .json as well")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Try all choices and print."""
    from exo_pin.compare import comparison_table, worth

    if args.output is not None and Path(args.output).suffix.lower() not in _WRITERS:
        raise DescriptionError(f"{args.output}: {', '.join(_WRITERS)} are accepted")
    body = options.body_from(args)
    gait = options.gait_from(args, body)
    study = worth(gait, body)
    if args.json:
        show.as_json(study.facts())
    else:
        name = Path(args.gait).name
        show.table(
            f"Best choice for each number of motors: {name}",
            comparison_table.FRONT,
            comparison_table.front_rows(study),
        )
        show.table(
            "One movement locked, or added after the others",
            comparison_table.SINGLE,
            comparison_table.single_rows(study),
        )
    if args.output:
        write_text(args.output, _WRITERS[Path(args.output).suffix.lower()](study))
    return 0


def _svg(study: Worth) -> str:
    from exo_pin.report.draw.pareto import pareto_svg

    return pareto_svg(study)


def _markdown(study: Worth) -> str:
    from exo_pin.compare import comparison_table

    front = comparison_table.markdown(comparison_table.FRONT, comparison_table.front_rows(study))
    return (
        front + "\n" + comparison_table.markdown(comparison_table.SINGLE, comparison_table.single_rows(study))
    )


def _csv(study: Worth) -> str:
    from exo_pin.compare import comparison_table

    rows = [
        ["+".join(x["movements"]) or "none", str(x["motors"]), f"{x['sole_rms_mm']:.4f}"]
        for x in study.facts()["all"]
    ]
    return comparison_table.csv(("driven", "motors", "sole rms mm"), rows)


def _json(study: Worth) -> str:
    return json.dumps(study.facts(), indent=2) + "\n"


_WRITERS: dict[str, Callable[[Worth], str]] = {".svg": _svg, ".md": _markdown, ".csv": _csv, ".json": _json}
