"""Sign conventions of laboratories and model families: one entry in PRESETS each."""

from __future__ import annotations

from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import MOVEMENTS, SIDES, joint
from exo_pin.anatomy.names import Movement, Side
from exo_pin.arrays import Array
from exo_pin.errors import UnknownNameError

ONE_SIDED = 0.9
"""Part of the knee's excursion that must lie on one side of 0 before its sign is believed."""

BENT = np.radians(15)
"""A walk bends the knee more than this; smaller angles could be flexion or hyperextension [rad]."""

Point = tuple[float, float, float]


class Preset(NamedTuple):
    """What must be known of a laboratory or a model to read its angles.

    Attributes:
        name: What the user calls it.
        columns: Per movement, what a side's column is called: `{s}` stands for l or r, `{S}` for L or R,
            `{side}` for left or right.
        signs: Per movement, +1 where positive is what our name says, else -1.
        mid_hip: OpenSim models: midway between the hip centres in the pelvis's own frame, OpenSim axes [m]:
            the generic model's, because a file of coordinates does not carry the scaled one.
        source: Who says so.
    """

    name: str
    columns: tuple[str, ...]
    signs: tuple[int, ...]
    mid_hip: Point | None
    source: str

    @property
    def knee(self) -> int:
        """+1 if the knee is positive in flexion, -1 if negative."""
        return self.signs[MOVEMENTS.index("knee_flexion")]

    @property
    def mapping(self) -> dict[str, str]:
        """Column -> joint, as `load_gait(mapping=...)` takes it; a leading minus turns the sign."""
        return {
            ("-" if sign < 0 else "") + self.column(side, movement): joint(side, movement)
            for side in SIDES
            for movement, sign in zip(MOVEMENTS, self.signs, strict=True)
        }

    def column(self, side: Side, movement: Movement) -> str:
        """What the preset calls a joint."""
        template = self.columns[MOVEMENTS.index(movement)]
        return template.format(s=side[0], S=side[0].upper(), side=side)


_OPENSIM = (
    "hip_flexion_{s}",
    "hip_adduction_{s}",
    "hip_rotation_{s}",
    "knee_angle_{s}",
    "ankle_angle_{s}",
    "subtalar_angle_{s}",
)
_PIG = (
    "{S}HipAngles_X",
    "{S}HipAngles_Y",
    "{S}HipAngles_Z",
    "{S}KneeAngles_X",
    "{S}AnkleAngles_X",
    "{S}AnkleAngles_Y",
)
_OURS = tuple(f"{{side}}_{movement}" for movement in MOVEMENTS)

PRESETS = MappingProxyType(
    {
        preset.name: preset
        for preset in (
            Preset("exo_pin", _OURS, (1, 1, 1, 1, 1, 1), None, "the joints' names are their signs"),
            Preset(
                "opensim-gait2392",
                _OPENSIM,
                (1, 1, 1, -1, 1, 1),
                (-0.0707, -0.0661, 0.0),
                "Delp 1990 and its descendants gait2354 and gait2392 (.osim files, joint hip_r)",
            ),
            Preset(
                "opensim-rajagopal",
                _OPENSIM,
                (1, 1, 1, 1, 1, 1),
                (-0.056276, -0.07849, 0.0),
                "Rajagopal 2016 and its descendants (Rajagopal2016.osim, joint hip_r)",
            ),
            Preset(
                "vicon-pig",
                _PIG,
                (1, 1, 1, 1, 1, -1),  # the ankle's Y is eversion: so its segment frames say
                None,
                "Plug-in Gait's model outputs, each sign checked against the segment frames of a recording",
            ),
        )
    }
)
"""Name -> preset."""

OPENSIM = tuple(name for name, entry in PRESETS.items() if entry.mid_hip is not None)
"""The presets of OpenSim's models."""


def preset(name: str, known: tuple[str, ...] = tuple(PRESETS)) -> Preset:
    """The preset of that name; raises `UnknownNameError`."""
    if name not in known:
        raise UnknownNameError("preset", name, known)
    return PRESETS[name]


def inferred(knees: Array) -> tuple[Preset, float] | None:
    """Find the OpenSim preset whose knee sign makes `(n, 2)` knee angles [rad] those of a walk.

    Returns:
        The preset and the part (0 to 1) of the excursion on its side, or None if that is not clear: less
        than 90 % on one side, or knees that never bend 15 degrees.
    """
    up, down = max(float(knees.max()), 0.0), max(float(-knees.min()), 0.0)
    if max(up, down) < BENT or max(up, down) < ONE_SIDED * (up + down):
        return None
    sign = 1 if up > down else -1
    return next(PRESETS[name] for name in OPENSIM if PRESETS[name].knee == sign), max(up, down) / (up + down)
