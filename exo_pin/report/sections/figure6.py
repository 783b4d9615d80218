"""The paper's Fig. 6: recovered against given joint curves, from exact and from noisy feet."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import MOVEMENTS, SIDES
from exo_pin.crosscheck import Recovery, recover, recover_noisy
from exo_pin.gait import Gait
from exo_pin.report.document.blocks import Block, Figure, Paragraph, Section, Table
from exo_pin.report.draw import svg, walk_charts
from exo_pin.report.draw.chart import Chart, Curve, draw
from exo_pin.report.draw.drawing import Drawing
from exo_pin.robot import Robot

_NOISE = (1e-3, 3e-3, 5e-3)
"""Standard deviation of each coordinate of a foot [m]."""

_DAMPING = 0.05
"""Of the second solution for noisy feet [m/rad], as `ik.Dls` recommends for 3 mm."""


class RecoveredCurves(NamedTuple):
    """What was recovered and how, in words, and the angles."""

    title: str
    recovery: Recovery


def recovered_curves(
    robot: Robot, gait: Gait, *, recording: Gait | None, recording_name: str
) -> list[RecoveredCurves]:
    """Every case: own feet twice, the recording, and noisy feet without and with damping.

    Args:
        robot: The exoskeleton.
        gait: The normative walk.
        recording: A recorded walk; None leaves its case out.
        recording_name: What the recording is called.
    """
    iteration = ik.Dls(tolerance=ik.Dls().tolerance)
    found = [
        RecoveredCurves("own feet, iteration (the paper's case)", recover(robot, gait, settings=iteration)),
        RecoveredCurves("own feet, closed form", recover(robot, gait)),
    ]
    if recording is not None:
        found.append(RecoveredCurves(recording_name, recover(robot, recording)))
    return found + [_noisy(robot, gait, sd, damping) for damping in (0.0, _DAMPING) for sd in _NOISE]


def _noisy(robot: Robot, gait: Gait, sd: float, damping: float) -> RecoveredCurves:
    how = f", damping {damping:g} m/rad" if damping else ""
    return RecoveredCurves(
        f"feet with {1e3 * sd:g} mm noise{how}", recover_noisy(robot, gait, sd, damping=damping)
    )


def section(gait: Gait, recording: Gait | None, cases: list[RecoveredCurves]) -> Section:
    """Charts of the recovered curves, and the table of their errors.

    Args:
        gait: The normative walk.
        recording: The recorded walk, if one was recovered.
        cases: Of `recovered_curves`.
    """
    first, *others = cases
    blocks: list[Block] = [
        Figure(
            _over(gait, first, "fig6_own"),
            f"Fig. 6. {first.title[:1].upper()}{first.title[1:]}: exact by construction.",
        )
    ]
    if recording is not None:
        outside = int((~others[1].recovery.within).sum())
        caption = (
            f"{others[1].title}. Its angles make the feet on our model; {outside} of {len(recording)} "
            "samples need angles outside the joint limits: there the solution is the posture within them "
            "that puts the feet in the same place, or as near as possible."
        )
        blocks.append(Figure(_over(recording, others[1], "fig6_recording"), caption))
    damped = cases[-len(_NOISE) :]
    raw = cases[-2 * len(_NOISE) : -len(_NOISE)]
    for group, name in ((raw, "each sample by itself"), (damped, f"damped ({_DAMPING:g} m/rad)")):
        caption = f"Left leg, from feet with 1, 3 and 5 mm of noise in each coordinate, {name}."
        blocks.append(Figure(_noise_charts(gait, group, "raw" if group is raw else "damped"), caption))
    blocks += [_errors(cases), Paragraph(_WHY, "note")]
    return Section("Fig. 6: recovered against given joint curves", tuple(blocks))


_WHY = (
    "Noise is white, normal, the same in every run (seeded); rotations of the feet are exact. Near the "
    "straight knee a foot's position hardly determines the knee's angle: the knee errs by "
    "sqrt(2 dL L / (Lt Ls)) when the leg's length L errs by dL (thigh Lt, shank Ls), so millimetres become "
    "degrees there, and a foot beyond the straight leg's reach cannot be met. The damping holds each sample "
    "to the one before; it misses the noisy feet on purpose, so hardly a sample counts as met."
)


def _errors(cases: list[RecoveredCurves]) -> Table:
    columns = ("case", *(m.replace("_", " ") for m in MOVEMENTS), "largest", "feet mm", "met", "out of reach")
    rows = []
    for title, recovery in cases:
        track = recovery.track
        far = int((track.reach_slack < -1e-9).any(axis=1).sum())
        rows.append(
            [
                title,
                *(_degrees(x) for x in recovery.rms_by_movement().values()),
                _degrees(max(recovery.largest_by_movement().values())),
                f"{1e3 * float(track.position_error.max()):.2g}",
                f"{int(track.converged.sum())} of {len(track)}",
                str(far),
            ]
        )
    caption = (
        "Errors of the recovered angles [deg]: rms by movement over both legs and all samples, and the "
        "largest; largest miss of a foot [mm]; samples whose feet were met; samples with a foot out of reach"
    )
    return Table(columns, rows, caption)


def _degrees(angle: float) -> str:
    value = float(np.degrees(angle))
    return f"{value:.2f}" if value >= 0.005 else f"{value:.0e}"


def _over(gait: Gait, case: RecoveredCurves, name: str) -> tuple[Drawing, ...]:
    """Given (solid) and recovered (dotted) angles over time, both legs."""
    drawings = []
    time, given = walk_charts.over_time(gait, np.degrees(case.recovery.given.q))
    _, q = walk_charts.over_time(gait, np.degrees(case.recovery.gait.q))
    for k, movement in enumerate(MOVEMENTS):
        curves = []
        for s, side in enumerate(SIDES):
            column = k + s * len(MOVEMENTS)
            curves.append(Curve(time, given[:, column], svg.SIDE_COLOURS[side], f"{side}, given", width=2.6))
            label = "recovered" if s == 0 else ""
            curves.append(Curve(time, q[:, column], svg.INK, label, dash="1.5 3", width=1.6))
        title = walk_charts.MOVEMENT_TITLES[movement]
        chart = Chart(title=title, x_label="time [s]", curves=tuple(curves), least=20.0)
        drawings.append(Drawing(f"{name}_{movement}", title, draw(chart)))
    return tuple(drawings)


def _noise_charts(gait: Gait, cases: list[RecoveredCurves], name: str) -> tuple[Drawing, ...]:
    """Hip, knee and ankle flexion of the left leg: given, and recovered from three noises."""
    shades = ("#f0a35e", "#c96a9b", "#7b62c9")
    drawings = []
    for movement in ("hip_flexion", "knee_flexion", "ankle_dorsiflexion"):
        k = MOVEMENTS.index(movement)
        curves = []
        for case, sd, shade in zip(reversed(cases), reversed(_NOISE), reversed(shades), strict=True):
            q = np.degrees(case.recovery.gait.q[:, k])
            curves.append(Curve(gait.time, q, shade, f"{1e3 * sd:g} mm", width=1.2))
        curves.append(Curve(gait.time, np.degrees(gait.q[:, k]), svg.INK, "given", width=1.4))
        title = walk_charts.MOVEMENT_TITLES[movement]
        chart = Chart(title=title, x_label="time [s]", curves=tuple(curves), least=20.0)
        drawings.append(Drawing(f"fig6_noise_{name}_{movement}", title, draw(chart)))
    return tuple(drawings)
