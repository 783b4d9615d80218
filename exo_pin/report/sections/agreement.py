"""Sections on how far to trust a report: residuals of inverse kinematics, cross-checks."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.crosscheck import BENT_KNEE, FK_TOLERANCE, IK_TOLERANCE, Check
from exo_pin.gait import Gait
from exo_pin.report.document.blocks import Figure, Paragraph, Section, Table
from exo_pin.report.draw import svg
from exo_pin.report.draw.chart import Chart, Curve, Level, draw
from exo_pin.report.draw.drawing import Drawing

_WITNESSES = {
    "recursion": "the paper's recursion",
    "dh": "modified Denavit-Hartenberg table",
    "yourdfpy": "yourdfpy, reading the same URDF",
}


def inverse(gait: Gait, verdict: Check) -> Section:
    """The round trip from the walk's feet back to its angles."""
    found, track = verdict.recovery, verdict.recovery.track
    rows = [
        ["frames", str(len(track)), ""],
        ["frames with all angles within the limits", str(int(found.within.sum())), ""],
        ["frames whose feet were reached", str(int(track.converged.sum())), ""],
        ["largest position error, within limits", f"{found.largest_position_error:.1e}", "m"],
        ["largest rotation error, within limits", f"{found.largest_rotation_error:.1e}", "rad"],
        [
            f"largest angle error, within limits, knee bent > {np.degrees(BENT_KNEE):g} deg",
            f"{np.degrees(found.largest_angle_error):.1e}",
            "deg",
        ],
        ["closed form against iteration, largest difference", f"{np.degrees(verdict.agreement):.1e}", "deg"],
        ["frames with a joint on its limit", str(int(track.active_limits.any(axis=1).sum())), ""],
        ["least reach to spare", _spare(track.reach_slack), "mm"],
        ["solved by", ", ".join(sorted(set(track.answered_by))), ""],
    ]
    words = (
        "The feet of the walk's own angles on this model are the targets; inverse kinematics finds angles "
        "within the limits. Where the walk leaves the limits (a knee beyond its stop), the solution is "
        "another posture with the same feet, if one exists."
    )
    decades = np.log10(np.maximum(track.position_error, 1e-17))
    chart = Chart(
        title="Position error of the feet, log10 of [m]",
        x_label="time [s]",
        curves=tuple(
            Curve(gait.time, decades[:, k], svg.SIDE_COLOURS[side], side)
            for k, side in enumerate(("left", "right"))
        ),
        levels=(Level(float(np.log10(IK_TOLERANCE)), svg.GREY, "tolerance"),),
        y_range=(-18.0, max(-6.0, float(decades.max()) + 1)),
        width=900,
        height=200,
    )
    drawing = Drawing("ik_error", chart.title, draw(chart))
    table = Table(("inverse kinematics", "value", "unit"), rows)
    return Section(
        "Inverse kinematics", (Paragraph(words), Figure((drawing,), columns=1, screen=True), table)
    )


def _spare(slack: Array) -> str:
    """The least of it in millimetres; a leg without a driven knee has none."""
    known = slack[np.isfinite(slack)]
    return f"{1e3 * float(known.min()):.1f}" if len(known) else "-"


def agreement(verdict: Check) -> Section:
    """Forward kinematics computed in four ways, and the joint limits."""
    rows = [
        [
            _WITNESSES.get(name, name),
            f"{value:.1e}",
            f"{FK_TOLERANCE:.0e}",
            "ok" if value <= FK_TOLERANCE else "NOT OK",
        ]
        for name, value in verdict.fk.items()
    ]
    named = ", ".join(
        f"{name} ({verdict.limits[name].samples_outside} frames)" for name in verdict.joints_outside
    )
    words = f"Outside the limits: {named}." if named else "No joint leaves its limits."
    columns = ("forward kinematics against Pinocchio", "largest difference", "accepted", "")
    note = (
        "Over the walk and 1000 random configurations; positions in metres and entries of rotation matrices."
    )
    return Section("Cross-checks", (Table(columns, rows), Paragraph(note, "note"), Paragraph(words)))
