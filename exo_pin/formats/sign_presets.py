"""Presets: column names and sign conventions of laboratories and model families."""

from __future__ import annotations

from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import MOVEMENTS, SIDES, joint
from exo_pin.anatomy.names import Movement, Side, SignPreset
from exo_pin.arrays import Array
from exo_pin.errors import UnknownNameError

_ONE_SIDED = 0.9
"""Part of the knee's excursion that must lie on one side of 0 before its sign is taken from it."""

_LEAST_FLEXION = np.radians(15)
"""A walk bends the knee more than this; smaller angles could be flexion or hyperextension [rad]."""

Point = tuple[float, float, float]


class Preset(NamedTuple):
    """Column names and signs of joint angles.

    Attributes:
        name: Its name in `--preset`.
        columns: Per movement, what a side's column is called: `{s}` stands for l or r, `{S}` for L or R,
            `{side}` for left or right.
        signs: Per movement, +1 where positive is what our name says, else -1.
        mid_hip: OpenSim models: midway between the hip centres in the pelvis's own frame, OpenSim axes [m]:
            the generic model's, because a file of coordinates does not carry the scaled one.
        source: Where the convention comes from.
    """

    name: SignPreset
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

OPENSIM_PRESETS = tuple(name for name, entry in PRESETS.items() if entry.mid_hip is not None)
"""The presets of OpenSim's models."""


def find_preset(name: str, known: tuple[str, ...] = tuple(PRESETS)) -> Preset:
    """The preset of that name; raises `UnknownNameError`."""
    entry = next((entry for entry in PRESETS.values() if entry.name == name), None)
    if entry is None or name not in known:
        raise UnknownNameError("preset", name, known)
    return entry


def preset_of_knee(sign: int) -> Preset:
    """The OpenSim preset whose knee is positive in flexion (sign +1) or in extension (-1)."""
    return next(PRESETS[name] for name in OPENSIM_PRESETS if PRESETS[name].knee == sign)


def inferred_preset(knees: Array) -> tuple[Preset, float] | None:
    """Find the OpenSim preset whose knee sign makes `(n, 2)` knee angles [rad] those of a walk.

    Returns:
        The preset and the part (0 to 1) of the excursion on its side, or None if that is not clear: less
        than 90 % on one side, or knees that never bend 15 degrees.
    """
    up, down = max(float(knees.max()), 0.0), max(float(-knees.min()), 0.0)
    if max(up, down) < _LEAST_FLEXION or max(up, down) < _ONE_SIDED * (up + down):
        return None
    return preset_of_knee(1 if up > down else -1), max(up, down) / (up + down)
