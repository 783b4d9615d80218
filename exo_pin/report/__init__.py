"""Figures and reports: documents as values, rendered as self-contained HTML or as Markdown.

`walk(robot, gait)` reports one walk for an engineer or clinician, `reproduction(robot, gait)` the paper's
figures, `comparison(compared)` devices side by side, `study(rows)` many walks, `trials(found)` and
`folder(found)` several trials of people. Each returns a `Document`:
`html(document)` and `markdown(document)` make text of it.

The rooms inside import one way only: draw -> document -> sections -> pages.
"""

from exo_pin.report.document.blocks import Document
from exo_pin.report.document.html_page import html
from exo_pin.report.document.markdown import markdown
from exo_pin.report.document.numbers_csv import csv_of
from exo_pin.report.draw.drawing import Drawing
from exo_pin.report.pages.comparison_page import comparison
from exo_pin.report.pages.reproduction import RenderedPictures, reproduction
from exo_pin.report.pages.study_page import study
from exo_pin.report.pages.trials_page import folder, trials
from exo_pin.report.pages.walk_page import ReportInfo, walk

__all__ = [
    "Document",
    "Drawing",
    "RenderedPictures",
    "ReportInfo",
    "comparison",
    "csv_of",
    "folder",
    "html",
    "markdown",
    "reproduction",
    "study",
    "trials",
    "walk",
]
