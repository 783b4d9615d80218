"""The paper's figures one by one: what the paper shows, what this page shows, what remains open."""

from __future__ import annotations

from typing import NamedTuple

from exo_pin.report.document.blocks import Paragraph, Section, Table


class PaperFigure(NamedTuple):
    """One figure of the paper; words in braces depend on the run."""

    title: str
    in_paper: str
    on_this_page: str
    open_points: str


_FIGURES = (
    PaperFigure(
        "Fig. 1: coordinate frames",
        "World frame on the ground between the feet; body and 12 joints, all parallel at the start",
        "The same frames, of our model at q = 0, with origins, axes and the deviation from parallel",
        "Segment lengths: ours are anthropometric",
    ),
    PaperFigure(
        "Fig. 2: inverse kinematics",
        "Guess, forward kinematics, compare the foot pose, correct, repeat",
        "The loop as our iterative solver runs it, and its error after each correction",
        "Tolerance and treatment of joint limits: ours are stated",
    ),
    PaperFigure(
        "Fig. 3: three-dimensional model",
        "The 3-D model of the exoskeleton",
        "Our model, {drawn}",
        "Shapes and colours are ours",
    ),
    PaperFigure(
        "Fig. 4: input gait",
        "Clinical gait curves (Hong Kong Polytechnic University, clinicalgaitanalysis.com)",
        "Schwartz 2008 at free speed{and_recording}, with bands of 1 standard deviation. Not the paper's "
        "curves number by number",
        "Its numbers could not be found; nothing here is read off its picture",
    ),
    PaperFigure(
        "Fig. 5: ten poses",
        "Ten poses of one gait cycle, axes in cm",
        "Ten poses of one cycle of Schwartz's walk, axes in cm{and_rendered}",
        "The body's size in its picture; ours is stated with the figure",
    ),
    PaperFigure(
        "Fig. 6: recovered joint curves",
        "Curves recovered by inverse kinematics (dotted) over the measured ones (solid)",
        "The same, exact by construction since the feet are the model's own; and cases that are not: "
        "{a_recording}feet with 1, 3 and 5 mm of noise",
        "How errors of the feet's positions become errors of angles",
    ),
)
"""The paper's figures in their order."""


def overview(recording: str, *, rendered: bool) -> Section:
    """The table of all figures.

    Args:
        recording: Name of the recording that is shown besides the normal walk; empty: none.
        rendered: Whether a browser drew the model and the poses.
    """
    words_of_run = {
        "drawn": "rendered in the browser"
        if rendered
        else "as a line drawing (no browser was used in this run)",
        "and_rendered": ", as stick figures and rendered" if rendered else ", as stick figures",
        "and_recording": f" and {recording}" if recording else "",
        "a_recording": "a recording, and " if recording else "",
    }
    rows = [[x.title, x.in_paper, x.on_this_page.format_map(words_of_run), x.open_points] for x in _FIGURES]
    columns = ("point", "the paper", "this page", "open in the paper, or not at hand")
    words = "Point by point. Every number below was computed in this run."
    return Section(
        "What the paper shows and what this page shows", (Paragraph(words), Table(columns, rows, prose=True))
    )
