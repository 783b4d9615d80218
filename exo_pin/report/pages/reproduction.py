"""The paper's figures from our data, with a table of what each shows; every number is computed in the run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy.names import Speed
from exo_pin.clinic import published_band
from exo_pin.crosscheck import errors_by_step
from exo_pin.gait import Gait, leg_cycles
from exo_pin.kinematics import deviation_from_parallel, joint_frames
from exo_pin.report.document.blocks import Block, Document, Figure, Paragraph, Section, Table
from exo_pin.report.draw import ik_loop, skeleton
from exo_pin.report.draw.drawing import Drawing
from exo_pin.report.sections import angles, figure6
from exo_pin.report.sections.paper_points import overview
from exo_pin.robot import Robot

_PAPER = (
    "Chen, Zhang, Zhu: Kinematics analysis and three-dimensional simulation of the rehabilitation lower "
    "extremity exoskeleton robot (Xi'an Jiaotong University)"
)
_TOLERANCE = 1e-9
_SAMPLE = 0.3  # share of the walk at which the loop's steps are shown
_SPEED: Speed = "free"


@dataclass(frozen=True, kw_only=True)
class RenderedPictures:
    """Pictures that a browser rendered: PNG bytes, empty without a browser."""

    model: bytes = b""
    poses: bytes = b""


def reproduction(
    robot: Robot,
    gait: Gait,
    *,
    recording: Gait | None = None,
    recording_name: str = "",
    rendered: RenderedPictures | None = None,
    when: str = "",
) -> Document:
    """The paper's Figures 1 to 6 from this package.

    Args:
        robot: The exoskeleton with 12 joints, made for a body.
        gait: The normative walk at free speed for that body.
        recording: A recorded walk with its events, for Figures 4 and 6.
        recording_name: What the recording is called.
        rendered: Pictures of the model and of ten poses.
        when: The moment of the run, in words.
    """
    pictures = rendered or RenderedPictures()
    cases = figure6.recovered_curves(robot, gait, recording=recording, recording_name=recording_name)
    sections = (
        overview(recording_name if recording is not None else "", rendered=bool(pictures.model)),
        _frames(robot),
        _loop(robot, gait),
        _model(robot, pictures),
        _curves(gait, recording, recording_name),
        _poses(robot, gait, pictures),
        figure6.section(gait, recording, cases),
    )
    subtitle = f"{_PAPER}. {when}".strip()
    return Document("The paper's figures, reproduced with exo_pin", subtitle, sections)


def _frames(robot: Robot) -> Section:
    def cell(values: np.ndarray) -> list[str]:
        return ["-" if np.isnan(x) else f"{x + 0.0:.3f}" for x in values]

    rows = [[name, *cell(p), *cell(axis)] for name, p, axis in joint_frames(robot)]
    away = deviation_from_parallel(robot)
    words = (
        f"At q = 0 the {len(rows)} local frames and the world are parallel: the largest difference of any "
        f"rotation matrix's entry from the identity is {away:.1g}. The world's origin is on the ground "
        "midway between the feet; x forward, y left, z up."
    )
    table = Table(
        ("frame", "x m", "y m", "z m", "axis x", "axis y", "axis z"),
        rows,
        "Origins in the world and axes of positive rotation",
    )
    note = (
        "Positive is the movement's name (flexion, adduction, internal rotation, dorsiflexion, inversion) on "
        "both sides, so the axes of adduction, rotation and inversion are mirrored."
    )
    caption = "Fig. 1. Three frames coincide in each hip, two in each ankle."
    figure = Figure((skeleton.frames_drawing(robot),), caption, columns=2)
    return Section("Fig. 1: coordinate frames", (Paragraph(words), figure, table, Paragraph(note, "note")))


def _loop(robot: Robot, gait: Gait) -> Section:
    sample = int(_SAMPLE * len(gait))
    errors = errors_by_step(robot, gait, sample, tolerance=_TOLERANCE)
    drawings = (ik_loop.diagram(_TOLERANCE), ik_loop.convergence(errors, _TOLERANCE, 100 * _SAMPLE))
    caption = (
        f"Fig. 2. Left: the loop. Right: the larger of all foot errors starting from mid-range, "
        f"{errors[0]:.2g} at first and {errors[-1]:.1e} after {len(errors) - 1} corrections."
    )
    note = (
        "Damped least squares with a damping that follows the residual (Sugihara 2011). The paper calls an "
        "analytic solution difficult; this leg has one, since its three hip axes intersect (Pieper), and "
        "Fig. 6 uses both."
    )
    return Section(
        "Fig. 2: the loop of inverse kinematics",
        (Figure(drawings, caption, columns=2), Paragraph(note, "note")),
    )


def _model(robot: Robot, pictures: RenderedPictures) -> Section:
    body = robot.body
    size = f"stature {body.stature:.2f} m, " if body is not None else ""
    words = (
        f"{robot.name}: {len(robot.joints)} driven joints, {size}hip centres {robot.placement[2, 3]:.3f} m "
        "above the ground at q = 0."
    )
    if pictures.model:
        drawing = Drawing("fig3_model", "The three-dimensional model", png=pictures.model)
        return Section(
            "Fig. 3: the model",
            (Paragraph(words), Figure((drawing,), "Fig. 3. Rendered by the player.", columns=1)),
        )
    why = "A line drawing: no browser rendered the model in this run (it needs Chromium)."
    figure = Figure((skeleton.model_drawing(robot),), f"Fig. 3. {why}", columns=2)
    return Section("Fig. 3: the model", (Paragraph(words), figure))


def _curves(gait: Gait, recording: Gait | None, name: str) -> Section:
    found = leg_cycles(gait)
    apart = float(np.degrees(np.abs(found[0].q - found[1].q).max()))
    words = f"Source: {gait.source}. Cycle of {gait.duration:.3f} s. Its two legs differ by {apart:.1g} deg."
    band = angles.band_words(published_band(_SPEED)).strip().removeprefix("Grey band: ")
    drawings = _named(angles.charts(found, band=published_band(_SPEED)), "fig4")
    blocks: list[Block] = [Paragraph(words), Figure(drawings, f"Fig. 4. The input gait. Band: {band}")]
    if recording is not None:
        mine = leg_cycles(recording)
        how = "; ".join(leg.note for leg in mine) or "no heel strikes in it, so it has no cycle"
        shown = _named(angles.charts(mine, band=published_band(_SPEED)), "fig4_recording")
        blocks.append(Figure(shown, f"{name} before the same band. {how}."))
    return Section("Fig. 4: the input gait", tuple(blocks))


def _poses(robot: Robot, gait: Gait, pictures: RenderedPictures) -> Section:
    drawing, note = skeleton.poses_chart(robot, gait)
    size = "" if robot.body is None else f" A body of {robot.body.stature:.2f} m."
    blocks: list[Block] = [Figure((drawing,), f"Fig. 5. {note}{size}", columns=1)]
    if pictures.poses:
        picture = Drawing("fig5_rendered", "Ten poses, rendered", png=pictures.poses)
        caption = "The same ten poses, at 0, 10 .. 90 % of the cycle, rendered by the player."
        blocks.append(Figure((picture,), caption, columns=1))
    return Section("Fig. 5: ten poses of a cycle", tuple(blocks))


def _named(drawings: tuple[Drawing, ...], prefix: str) -> tuple[Drawing, ...]:
    return tuple(Drawing(f"{prefix}_{d.name}", d.title, d.svg, d.png) for d in drawings)
