"""Files of normal bands: CSV with a row for each angle and percent of the cycle."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np

from exo_pin.anatomy.names import CLINICAL_ANGLES
from exo_pin.clinic.clinical_cycles import PERCENT
from exo_pin.clinic.normal_band import BandCurve, NormalBand
from exo_pin.errors import FormatError
from exo_pin.files import read_text, write_text
from exo_pin.safe import plain_numbers

_COLUMNS = ("angle", "percent", "mean_deg", "sd_deg", "n")
_POPULATION = "# population: "
_ACCEPTED = f"a file that `exo-pin normal` wrote is accepted: columns {', '.join(_COLUMNS)}"
_STEEPEST = 360.0  # [deg] no mean or spread of a joint is larger


def save_band(band: NormalBand, path: str | Path) -> None:
    """Write a band; `load_band` reads it."""
    text = io.StringIO()
    text.write(f"{_POPULATION}{' '.join(band.population.split())}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(_COLUMNS)
    for angle, curve in band.curves.items():
        for percent, mean, sd in zip(PERCENT, np.degrees(curve.mean), np.degrees(curve.sd), strict=True):
            writer.writerow([angle, f"{percent:g}", f"{mean:.5f}", f"{sd:.5f}", curve.n])
    write_text(path, text.getvalue())


def load_band(path: str | Path) -> NormalBand:
    """A band from a file; between its percents it is linear.

    Raises:
        FormatError: It is no such file, with the line and what is accepted.
    """
    path = Path(path)
    lines = read_text(path).splitlines()
    population = next((x.removeprefix(_POPULATION) for x in lines if x.startswith(_POPULATION)), "not stated")
    numbered = [(k, line) for k, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]
    if not numbered or tuple(next(csv.reader([numbered[0][1]]))) != _COLUMNS:
        raise FormatError(path, f"no band of normal walks; {_ACCEPTED}")
    rows: dict[str, list[tuple[float, ...]]] = {}
    for k, line in numbered[1:]:
        name, numbers = _row(path, k, line)
        rows.setdefault(name, []).append(numbers)
    curves = {angle: _curve(path, angle, rows[angle]) for angle in CLINICAL_ANGLES if angle in rows}
    if not curves:
        raise FormatError(path, f"holds no angle; {_ACCEPTED}")
    return NormalBand(path.name, population, curves)


def _row(path: Path, k: int, line: str) -> tuple[str, tuple[float, ...]]:
    cells = next(csv.reader([line]))
    if len(cells) != len(_COLUMNS):
        raise FormatError(path, f"line {k} has {len(cells)} cells, expected {len(_COLUMNS)}")
    if cells[0] not in CLINICAL_ANGLES:
        raise FormatError(path, f"line {k}: {cells[0][:40]!a} is no angle; {', '.join(CLINICAL_ANGLES)} are")
    try:
        numbers = tuple(plain_numbers.number(cell) for cell in cells[1:])
    except ValueError:
        raise FormatError(path, f"line {k}: a cell is no number") from None
    percent, mean, sd, n = numbers
    if not (0 <= percent <= 100 and abs(mean) <= _STEEPEST and 0 <= sd <= _STEEPEST and n >= 1):
        raise FormatError(
            path, f"line {k}: percent 0 .. 100, angles in degrees, sd from 0, n from 1 expected"
        )
    return cells[0], numbers


def _curve(path: Path, angle: str, rows: list[tuple[float, ...]]) -> BandCurve:
    percent, mean, sd, n = np.array(rows).T
    if len(percent) < 2 or (np.diff(percent) <= 0).any() or percent[0] > 0 or percent[-1] < 100:
        raise FormatError(path, f"{angle}: rows from 0 to 100 percent in increasing order are expected")
    at = [np.radians(np.interp(PERCENT, percent, values)) for values in (mean, sd)]
    return BandCurve(at[0], at[1], int(n[0]))
