"""`exo-pin joints`: the loss of a walk for every choice of driven joints."""

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
    from exo_pin.compare import JointChoices

_EXAMPLES = """examples:
  exo-pin joints                     the normal walk
  exo-pin joints walk.mot -o pareto.svg     the figure; also .md, .csv (all 64 choices) and .json

Every choice of the six movements of a leg is tried, the same on both legs: the soles' error under the
best motion of such a device, the pelvis moving as recorded."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("-o", "--output", metavar="FILE", help="write .svg, .md, .csv or .json as well")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Try all choices and print."""
    from exo_pin.compare import compare_joints, comparison_table

    if args.output is not None and Path(args.output).suffix.lower() not in _WRITERS:
        raise DescriptionError(f"{args.output}: {', '.join(_WRITERS)} are accepted")
    body = options.body_from(args)
    gait = options.gait_from(args, body)
    found = compare_joints(gait, body)
    if args.json:
        show.as_json(found.facts())
    else:
        name = Path(args.gait).name
        show.table(
            f"Best choice for each number of motors: {name}",
            comparison_table.PARETO_COLUMNS,
            comparison_table.front_rows(found),
        )
        show.table(
            "One movement locked, or added after the others",
            comparison_table.MOVEMENT_COLUMNS,
            comparison_table.single_rows(found),
        )
    if args.output:
        write_text(args.output, _WRITERS[Path(args.output).suffix.lower()](found))
    return 0


def _svg(found: JointChoices) -> str:
    from exo_pin.report.draw.pareto import pareto_svg

    return pareto_svg(found)


def _markdown(found: JointChoices) -> str:
    from exo_pin.compare import comparison_table

    front = comparison_table.markdown(comparison_table.PARETO_COLUMNS, comparison_table.front_rows(found))
    return (
        front
        + "\n"
        + comparison_table.markdown(comparison_table.MOVEMENT_COLUMNS, comparison_table.single_rows(found))
    )


def _csv(found: JointChoices) -> str:
    from exo_pin.compare import comparison_table

    rows = [
        ["+".join(choice.movements) or "none", str(choice.motors), f"{1e3 * choice.loss:.4f}"]
        for choice in found.choices
    ]
    return comparison_table.csv(("driven", "motors", "sole rms mm"), rows)


def _json(found: JointChoices) -> str:
    return json.dumps(found.facts(), indent=2) + "\n"


_WRITERS: dict[str, Callable[[JointChoices], str]] = {
    ".svg": _svg,
    ".md": _markdown,
    ".csv": _csv,
    ".json": _json,
}
