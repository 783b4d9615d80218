"""`exo-pin normal`: a normal band of one's own recordings."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import options, several_trials, show, trials
from exo_pin.errors import DescriptionError, FormatError

if TYPE_CHECKING:
    from exo_pin.clinic import NormalBand

_EXAMPLES = """examples:
  exo-pin normal healthy/ -o ours.csv
  exo-pin normal a.c3d b.c3d c.c3d -o ours.csv --name "our adults"
  exo-pin report patient.c3d --normal ours.csv -o report.html

Each recording counts once, by the mean of its sides' mean cycles; the band is their mean and standard
deviation (n - 1) at 0 .. 100 % of the cycle, for every angle that two recordings have. The file is CSV:
angle, percent, mean_deg, sd_deg, n."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument("recordings", nargs="+", metavar="FOLDER|FILE", help="a folder of trials, or trials")
    parser.add_argument("-o", "--output", metavar="FILE", required=True, help="the band to write (.csv)")
    parser.add_argument("--name", help="what the band is called (default: the folder's name)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options.add_preset(parser, "sign convention of files that do not tell it")
    trials.add(parser)
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Read, average, write."""
    from exo_pin import clinic

    if Path(args.output).suffix.lower() != ".csv":
        raise DescriptionError(f"{args.output}: a band is written as .csv")
    args.gait = args.recordings[0]
    first = Path(args.recordings[0])
    if len(args.recordings) == 1 and first.is_dir():
        found = several_trials.of_folder(args, first, None)
    else:
        found = several_trials.Found(several_trials.of_names(args, args.recordings, None), {})
    for name, why in found.failures.items():
        print(f"note: left out: {show.plain(name)}: {why}", file=sys.stderr)
    name = args.name or (first.resolve().name if first.is_dir() else f"{len(found.trials)} files")
    walks = [trial.sides for trial in found.trials if trial.sides]
    if len(walks) < 2:
        raise FormatError(first, f"{len(walks)} recordings with a whole cycle; a band takes two or more")
    band = clinic.recorded_band(walks, name)
    clinic.save_band(band, args.output)
    _print(args, band, len(walks))
    return 0


def _print(args: argparse.Namespace, band: NormalBand, recordings: int) -> None:
    """What the band holds."""
    if args.json:
        facts = {angle: curve.n for angle, curve in band.curves.items()}
        show.as_json({"output": args.output, "recordings": recordings, "n": facts})
        return
    rows = []
    for angle, curve in band.curves.items():
        ends = (float(curve.mean.min()), float(curve.mean.max()), float(curve.sd.mean()))
        rows.append([angle, str(curve.n), *(show.fixed(math.degrees(x)) for x in ends)])
    heads = ["angle", "n", "lowest mean deg", "highest mean deg", "mean sd deg"]
    show.table(f"{args.output}: {show.plain(band.population)}", heads, rows)
