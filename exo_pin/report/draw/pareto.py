"""The Pareto front of the choices of joints as SVG: sole error against number of motors."""

from __future__ import annotations

import math
from html import escape

from exo_pin.compare.joint_choices import JointChoices

_WIDTH, _HEIGHT, _LEFT, _RIGHT, _TOP, _BOTTOM = 760, 430, 70, 150, 46, 54
_FLOOR = 0.5
"""Losses below this [mm] are drawn on the axis: the scale is logarithmic."""

_LETTERS = 52
"""Of a walk's name have room in the heading."""

_SHORT = {
    "hip_flexion": "hip flexion",
    "hip_adduction": "adduction",
    "hip_rotation": "rotation",
    "knee_flexion": "knee",
    "ankle_dorsiflexion": "ankle",
    "ankle_inversion": "inversion",
}


def pareto_svg(choices: JointChoices, *, name: str = "") -> str:
    """All 64 choices as dots, the best for each number of motors joined and named by what it adds.

    Args:
        choices: The losses of all choices.
        name: What the walk is called; the beginning of its source if left out.
    """
    top = max(1e3 * loss for loss in choices.losses.values())
    parts = [*_axes(top), *_dots(choices, top), *_front(choices, top)]
    called = name or choices.walk.gait.source or "gait"
    called = called if len(called) <= _LETTERS else f"{called[:_LETTERS]} …"
    title = escape(f"Which joints are worth their motor: {called}")
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {_HEIGHT}" '
        'font-family="sans-serif" font-size="12" fill="#333">'
    )
    ground = f'<rect width="{_WIDTH}" height="{_HEIGHT}" fill="#fff"/>'
    heading = f'<text x="{_LEFT}" y="24" font-size="14">{title}</text>'
    return "\n".join([head, ground, heading, *parts, "</svg>"]) + "\n"


def _x(motors: float) -> float:
    return round(_LEFT + 16 + motors / 12 * (_WIDTH - _LEFT - _RIGHT - 16), 1)


def _y(loss: float, top: float) -> float:
    """Logarithmic from `_FLOOR` to the largest loss [mm]."""
    share = math.log(max(loss, _FLOOR) / _FLOOR) / math.log(1.2 * top / _FLOOR)
    return round(_HEIGHT - _BOTTOM - share * (_HEIGHT - _TOP - _BOTTOM), 1)


def _axes(top: float) -> list[str]:
    parts = []
    for mm in (0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500):
        if mm > 1.2 * top:
            break
        y, label = _y(mm, top), f"{mm:g}" if mm > _FLOOR else "&#8804; 0.5"
        parts.append(f'<path d="M{_LEFT} {y}H{_WIDTH - _RIGHT}" stroke="#ddd"/>')
        parts.append(f'<text x="{_LEFT - 8}" y="{y + 4}" text-anchor="end">{label}</text>')
    for motors in range(0, 13, 2):
        x = _x(motors)
        parts.append(f'<text x="{x}" y="{_HEIGHT - _BOTTOM + 20}" text-anchor="middle">{motors}</text>')
    middle = (_LEFT + _WIDTH - _RIGHT) / 2
    parts.append(f'<text x="{middle}" y="{_HEIGHT - 14}" text-anchor="middle">motors, both legs</text>')
    y = (_TOP + _HEIGHT - _BOTTOM) / 2
    parts.append(
        f'<text transform="translate(20 {y}) rotate(-90)" text-anchor="middle">sole error, rms [mm]</text>'
    )
    return parts


def _dots(choices: JointChoices, top: float) -> list[str]:
    return [
        f'<circle cx="{_x(2 * len(chosen))}" cy="{_y(1e3 * loss, top)}" r="3.5" fill="#9ab" opacity="0.7"/>'
        for chosen, loss in choices.losses.items()
    ]


def _front(choices: JointChoices, top: float) -> list[str]:
    front = choices.pareto
    points = [(_x(motors), _y(1e3 * loss, top)) for motors, _, loss in front]
    line = " ".join(f"{x},{y}" for x, y in points)
    parts = [f'<polyline points="{line}" fill="none" stroke="#c33" stroke-width="2"/>']
    before: set[str] = set()
    for (x, y), (_, chosen, loss) in zip(points, front, strict=True):
        added, gone = [m for m in chosen if m not in before], before - set(chosen)
        words = [f"+ {_SHORT[m]}" for m in added] + [f"- {_SHORT[m]}" for m in sorted(gone)]
        text = escape(f"{1e3 * loss:.1f} {' '.join(words)}".strip())
        parts.append(f'<circle cx="{x}" cy="{y}" r="5" fill="#c33"/>')
        parts.append(f'<text x="{x + 9}" y="{y - 7}">{text}</text>')
        before = set(chosen)
    return parts
