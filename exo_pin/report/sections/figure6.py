"""The paper's Fig. 6: recovered against given joint curves, exact cases and others."""

from __future__ import annotations

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import MOVEMENTS, SIDES
from exo_pin.gait import Gait
from exo_pin.report.document.blocks import Block, Drawing, Figure, Section, Table, Words
from exo_pin.report.draw import panels, svg
from exo_pin.report.draw.chart import Chart, Curve, draw
from exo_pin.report.sections.noise import CALM, NOISES, Answer, exact, noisy
from exo_pin.robot import Robot


def answers(robot: Robot, gait: Gait, recording: Gait | None, name: str) -> list[Answer]:
    """Every case: own feet twice, the recording if there is one, and noise without and with damping."""
    found = [
        exact(robot, gait, "own feet, iteration (the paper's case)", ik.Dls(tolerance=ik.Dls().tolerance)),
        exact(robot, gait, "own feet, closed form"),
    ]
    if recording is not None:
        found.append(exact(robot, recording, name))
    found += [noisy(robot, gait, sd) for sd in NOISES]
    return found + [noisy(robot, gait, sd, damping=CALM) for sd in NOISES]


def recovered(gait: Gait, recording: Gait | None, answers: list[Answer]) -> Section:
    """Charts of what `answers` found, and the table of errors."""
    first, *others = answers
    blocks: list[Block] = [
        Figure(
            _over(gait, first, "fig6_own"),
            f"Fig. 6. {first.title[:1].upper()}{first.title[1:]}: exact by construction.",
        )
    ]
    if recording is not None:
        outside = int((~others[1].within).sum())
        caption = (
            f"{others[1].title}. Its angles make the feet on our model; {outside} of {len(recording)} "
            "samples ask for angles outside the joint limits: there the answer is the posture within them "
            "that puts the feet in the same place, or as near as can be."
        )
        blocks.append(Figure(_over(recording, others[1], "fig6_recording"), caption))
    calm = answers[-len(NOISES) :]
    raw = answers[-2 * len(NOISES) : -len(NOISES)]
    for group, name in ((raw, "each sample by itself"), (calm, f"damped ({CALM:g} m/rad)")):
        caption = f"Left leg, from feet with 1, 3 and 5 mm of noise in each coordinate, {name}."
        blocks.append(Figure(_noise_charts(gait, group, "raw" if group is raw else "damped"), caption))
    blocks += [_errors(answers), Words(_WHY, "note")]
    return Section("Fig. 6: recovered against given joint curves", tuple(blocks))


_WHY = (
    "Noise is white, normal, the same in every run (seeded); rotations of the feet are exact. Near the "
    "straight knee a foot's position hardly tells the knee's angle: the knee errs by sqrt(2 dL L / (Lt Ls)) "
    "when the leg's length L errs by dL (thigh Lt, shank Ls), so millimetres become degrees there, and a "
    "foot beyond the straight leg's reach cannot be met. The damping holds each sample to the one before; it "
    "misses the noisy feet on purpose, so hardly a sample counts as met."
)


def _errors(answers: list[Answer]) -> Table:
    columns = ("case", *(m.replace("_", " ") for m in MOVEMENTS), "largest", "feet mm", "met", "out of reach")
    rows = []
    for answer in answers:
        track = answer.track
        far = int((track.reach_slack < -1e-9).any(axis=1).sum())
        rows.append(
            [
                answer.title,
                *(_degrees(x) for x in answer.rms().values()),
                _degrees(max(answer.largest().values())),
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


def _over(gait: Gait, answer: Answer, name: str) -> tuple[Drawing, ...]:
    """Given (solid) and recovered (dotted) angles over time, both legs."""
    drawings = []
    time, given = panels.over_time(gait, np.degrees(answer.given))
    _, q = panels.over_time(gait, np.degrees(answer.q))
    for k, movement in enumerate(MOVEMENTS):
        curves = []
        for s, side in enumerate(SIDES):
            column = k + s * len(MOVEMENTS)
            curves.append(Curve(time, given[:, column], svg.COLOURS[side], f"{side}, given", width=2.6))
            label = "recovered" if s == 0 else ""
            curves.append(Curve(time, q[:, column], svg.INK, label, dash="1.5 3", width=1.6))
        title = panels.TITLES[movement]
        chart = Chart(title=title, x_label="time [s]", curves=tuple(curves), least=20.0)
        drawings.append(Drawing(f"{name}_{movement}", title, draw(chart)))
    return tuple(drawings)


def _noise_charts(gait: Gait, answers: list[Answer], name: str) -> tuple[Drawing, ...]:
    """Hip, knee and ankle flexion of the left leg: given, and recovered from three noises."""
    shades = ("#f0a35e", "#c96a9b", "#7b62c9")
    drawings = []
    for movement in ("hip_flexion", "knee_flexion", "ankle_dorsiflexion"):
        k = MOVEMENTS.index(movement)
        curves = []
        for answer, sd, shade in zip(reversed(answers), reversed(NOISES), reversed(shades), strict=True):
            curves.append(Curve(gait.time, np.degrees(answer.q[:, k]), shade, f"{1e3 * sd:g} mm", width=1.2))
        curves.append(Curve(gait.time, np.degrees(answers[0].given[:, k]), svg.INK, "given", width=1.4))
        title = panels.TITLES[movement]
        chart = Chart(title=title, x_label="time [s]", curves=tuple(curves), least=20.0)
        drawings.append(Drawing(f"fig6_noise_{name}_{movement}", title, draw(chart)))
    return tuple(drawings)
