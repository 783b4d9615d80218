"""Writers of the files that laboratories' programs write and this package only reads, for tests."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from exo_pin.anatomy import JOINTS, SIDES

ISB = Rotation.from_matrix([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
"""x forward, y left, z up -> x forward, y up, z right."""


def angles(gait, side):
    """Movement -> `(n,)` [deg]."""
    return {
        name.removeprefix(f"{side}_"): np.degrees(gait.q[:, k])
        for k, name in enumerate(JOINTS)
        if side in name
    }


def pig(gait):
    """Plug-in Gait's outputs `(n, 3)` [deg], without what a gait has not."""
    out = {}
    for side in SIDES:
        a, letter, zero = angles(gait, side), side[0].upper(), np.zeros(len(gait))
        hip = (a["hip_flexion"], a["hip_adduction"], a["hip_rotation"])
        out[f"{letter}HipAngles"] = np.stack(hip, axis=1)
        out[f"{letter}KneeAngles"] = np.stack([a["knee_flexion"], zero + 1, zero], axis=1)
        out[f"{letter}AnkleAngles"] = np.stack([a["ankle_dorsiflexion"], -a["ankle_inversion"], zero], axis=1)
    return out


def nexus_section(title, rate, frames, quantities, unit, sep=",", prefix="Anna:"):
    """Lines of a section: name -> `(n, 3)`."""
    names = [sep * 2 + (sep * 3).join(f"{prefix}{name}" for name in quantities)]
    axes = [sep.join(["Frame", "Sub Frame", *("XYZ" * len(quantities))])]
    units = [sep * 2 + sep.join([unit] * 3 * len(quantities))]
    values = np.hstack(list(quantities.values()))
    cells = [
        [str(f), "0", *("" if np.isnan(x) else repr(float(x)) for x in row)]
        for f, row in zip(frames, values, strict=True)
    ]
    point = "." if sep == "," else ","
    rows = [sep.join(cell.replace(".", point) for cell in row) for row in cells]
    return [title, f"{rate}", *names, *axes, *units, *rows, ""]


def nexus(gait, rate=100, first=1, sep=",", more=()):
    """An export with model outputs (and pelvis frame) and other sections before them."""
    frames = np.arange(first, first + len(gait))
    lines = list(more) + nexus_section("Model Outputs", rate, frames, pig(gait), "deg", sep)
    return "\n".join(lines) + "\n"


def gcd(gait, period=1.1, scalars=True, deviation=False):
    """Mean cycles of a periodic gait whose right foot strikes at half of the left one's cycle."""
    names = {"hip_flexion": "HipFlexExt", "hip_adduction": "HipAbAdduct", "hip_rotation": "HipRotation"}
    names |= {"knee_flexion": "KneeFlexExt", "ankle_dorsiflexion": "DorsiPlanFlex"}
    lines = ["#!DST-0.1 GCD a laboratory 1.00", "$REFERENCE", "AVERAGE:1:4"]
    for side in SIDES:
        if scalars:
            lines += [f"!{side.title()}StrideTime", f"{period}", f"!{side.title()}FootOff", "62"]
            lines += [f"!{side.title()}OppositeFootContact", "50", f"!{side.title()}PelvicTilt", "10"]
        for movement, name in names.items():
            values = angles(gait, side)[movement]
            values = np.roll(values, -len(values) // 2) if side == "right" else values
            rows = [f"{x!r} 1.5" if deviation else f"{x!r}" for x in np.append(values, values[0]).tolist()]
            lines += [f"!{side.title()}{name}", *rows]
    return "\n".join([*lines, ""])


def mvnx(gait, rate=60, contacts=True, head='<?xml version="1.0" encoding="UTF-8"?>', first=0):
    """A recording of the legs: orientations of the segments, and from them MVN's joint angles."""
    pelvis = Rotation.from_matrix(gait.base[:, :3, :3])
    segments, joints = {"Pelvis": pelvis}, {}
    for side in reversed(SIDES):
        s = 1 if side == "right" else -1
        a, above = {k: np.radians(v) for k, v in angles(gait, side).items()}, pelvis
        turns = {
            "UpperLeg": ("Hip", "YXZ", [-a["hip_flexion"], s * a["hip_adduction"], s * a["hip_rotation"]]),
            "LowerLeg": ("Knee", "YXZ", [a["knee_flexion"], 0 * a["knee_flexion"], 0 * a["knee_flexion"]]),
            "Foot": (
                "Ankle",
                "YXZ",
                [-a["ankle_dorsiflexion"], s * a["ankle_inversion"], 0 * a["knee_flexion"]],
            ),
        }
        for segment, (name, order, turn) in turns.items():
            below = above * Rotation.from_euler(order, np.stack(turn, axis=1))
            z, x, y = (ISB * above.inv() * below * ISB.inv()).as_euler("ZXY", degrees=True).T
            mirrored = [-s * x, s * y, -z if name == "Knee" else z]
            joints[f"j{side.title()}{name}"] = np.stack(mirrored, axis=1)
            segments[f"{side.title()}{segment}"], above = below, below
    orientation = np.stack([r.as_quat()[:, [3, 0, 1, 2]] for r in segments.values()], axis=1)
    position = np.repeat(gait.base[:, None, :3, 3], len(segments), axis=1)
    down = (
        np.stack([gait.stance(side) for side in SIDES for _ in range(2)], axis=1).astype(int)
        if contacts
        else None
    )
    lines = [head, '<mvnx xmlns="http://www.xsens.com/mvn/mvnx" version="4"><mvn version="2019.0.0"/>']
    lines += [f'<subject label="a" frameRate="{rate}"><segments>']
    lines += [f'<segment label="{name}"><points><point label="p"/></points></segment>' for name in segments]
    lines += ["</segments><joints>", *(f'<joint label="{name}"/>' for name in joints), "</joints>"]
    if contacts:
        names = [f"{side.title()}Foot_{part}" for side in SIDES for part in ("Heel", "Toe")]
        lines += ["<footContactDefinition>", *(f'<contactDefinition label="{name}"/>' for name in names)]
        lines += ["</footContactDefinition>"]
    lines += ["<frames>", '<frame time="0" type="identity"><orientation>1 0 0 0</orientation></frame>']
    text = lambda values: " ".join(f"{x:.9f}" for x in np.ravel(values))  # noqa: E731
    for k in range(len(gait)):
        lines += [f'<frame time="{round(1000 * k / rate)}" index="{first + k}" type="normal">']
        lines += [
            f"<orientation>{text(orientation[k])}</orientation><position>{text(position[k])}</position>"
        ]
        shown = text([v[k] for v in joints.values()])
        lines += [f"<footContacts>{' '.join(map(str, down[k]))}</footContacts>"] if contacts else []
        lines += [f"<velocity>1 2 3</velocity><jointAngle>{shown}</jointAngle></frame>"]
    return "\n".join([*lines, "</frames></subject></mvnx>", ""])
