"""Figures and reports: documents as values, rendered as self-contained HTML or as Markdown.

`walk(robot, gait)` is one walk for an engineer or clinician, `reproduction(robot, gait)` the paper's
figures, `comparison(compared)` devices side by side, `study(rows)` many walks. All are `Document`s:
`html(document)` and `markdown(document)` make text of them.
"""

from exo_pin.report.document.blocks import Document, Drawing
from exo_pin.report.document.html_page import html
from exo_pin.report.document.markdown import markdown
from exo_pin.report.pages.comparison_page import comparison
from exo_pin.report.pages.reproduction import Rendered, reproduction
from exo_pin.report.pages.study_page import study
from exo_pin.report.pages.walk_page import About, walk

__all__ = [
    "About",
    "Document",
    "Drawing",
    "Rendered",
    "comparison",
    "html",
    "markdown",
    "reproduction",
    "study",
    "walk",
]
