"""Names: sides, movements, joints, feet, sole corners and other closed vocabularies.

Words from a closed vocabulary have a `Literal` type here, so that type checkers find a wrong one.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal, get_args

from exo_pin.errors import UnknownNameError

Side = Literal["left", "right"]
Movement = Literal[
    "hip_flexion", "hip_adduction", "hip_rotation", "knee_flexion", "ankle_dorsiflexion", "ankle_inversion"
]
ClinicalAngle = Literal[
    "pelvis_tilt",
    "pelvis_obliquity",
    "pelvis_rotation",
    "hip_flexion",
    "hip_adduction",
    "hip_rotation",
    "knee_flexion",
    "knee_adduction",
    "knee_rotation",
    "ankle_dorsiflexion",
    "ankle_inversion",
    "foot_progression",
]
"""An angle of a gait laboratory's page: pelvis against the laboratory, joints, foot against the way.

Positive: pelvis tilted forward, its side up, its side forward; knee in varus, internal; foot toe-in.
"""
HipOrder = Literal["clinical", "yaw_roll_pitch"]
"""Order of the three hip joints from the pelvis outwards: ISB and gait laboratories, or humanoids."""
Base = Literal["fixed", "floating"]
"""Whether the pelvis is held in place or moves with six degrees of freedom."""
KneeBranch = Literal["front", "behind"]
"""Side of the line from hip to ankle on which a knee bends: in front, as a person's, or as a bird's."""
EventKind = Literal["heel_strike", "toe_off"]
"""Initial contact of a foot, or the moment it leaves the ground."""
Masses = Literal["wearer", "device", "both"]
"""Whose mass moves: the person's alone, the exoskeleton's alone, or both."""
Reaction = Literal["measured", "predicted", "planned"]
"""Where the ground reaction comes from: force plates, an assumption, or the plan of the walk."""
PlausibilityWord = Literal["plausible", "doubtful"]
"""The verdict on a walk as it was read."""
Manner = Literal["walk", "run"]
"""Whether a foot always stands, or both are in the air between two contacts."""
Sex = Literal["male", "female"]
Speed = Literal["very_slow", "slow", "free", "fast", "very_fast"]
"""A speed of the normal walk (Schwartz 2008)."""
PelvisMotion = Literal["recorded", "device"]
"""What moves the pelvis: the recorded walk, or the device as its own slides allow."""
PassiveJoints = Literal["held", "released"]
"""Whether joints without a motor are held at zero or move freely."""
KneeRule = Literal["stop", "bend"]
"""What a device does where a recorded knee hyperextends: hold it at its stop, or bend it to keep the foot."""
FitWord = Literal["fits", "concession", "no"]
ConcessionKind = Literal["knee held at its stop", "cadence", "amplitude"]
SupportStyle = Literal["carried", "still"]
"""How the balance support moves the pelvis in a picture: with the walk, or not at all."""
SizeOrigin = Literal[
    "command line",
    "body file",
    "file's header",
    "joint centres",
    "markers",
    "model",
    "stature table",
    "mass table",
    "default",
]
"""Where a size of a body comes from; `exo_pin.anatomy.person.Measure.detail` has more."""
AngleUnit = Literal["deg", "rad"]
LengthUnit = Literal["mm", "cm", "m"]
Vertical = Literal["+x", "+y", "+z", "-x", "-y", "-z"]
"""The axis of a laboratory that points up."""
PelvisRotation = Literal["tilt", "list", "rotation"]
"""A rotation of OpenSim's pelvis about its z, x or y."""
SignPreset = Literal["exo_pin", "opensim-gait2392", "opensim-rajagopal", "vicon-pig"]
"""Sign convention of a laboratory or a model family."""

Segment = Literal["pelvis", "thigh", "shank", "foot"]
"""A segment of the body that markers sit on."""
HipRegression = Literal["davis", "harrington"]
"""How hip centres follow from the pelvis's markers: Davis 1991 or Harrington 2007."""

SIDES: tuple[Side, ...] = ("left", "right")
"""Both sides, in the order of every array that holds one entry a leg."""

OTHER_SIDE: Mapping[Side, Side] = MappingProxyType({"left": "right", "right": "left"})
"""Side -> the other one."""

MOVEMENTS: tuple[Movement, ...] = (
    "hip_flexion",
    "hip_adduction",
    "hip_rotation",
    "knee_flexion",
    "ankle_dorsiflexion",
    "ankle_inversion",
)
"""Movements of a leg; the name is the positive direction on both sides (hip_rotation: internal)."""

CLINICAL_ANGLES: tuple[ClinicalAngle, ...] = get_args(ClinicalAngle)

HIP_REGRESSIONS: tuple[HipRegression, ...] = get_args(HipRegression)

SIGN_PRESETS: tuple[SignPreset, ...] = get_args(SignPreset)

JOINTS = tuple(f"{side}_{movement}" for side in SIDES for movement in MOVEMENTS)
"""The 12 joints in the order of `Gait.q`."""

FEET = ("left_foot", "right_foot")
"""Frames on the sole under each ankle."""

CORNERS = tuple(
    f"{side}_{part}_{edge}" for side in SIDES for part in ("heel", "ball") for edge in ("medial", "lateral")
)
"""Contact corners of the soles: heel and ball of the foot, four a foot."""

HIP_ORDERS: dict[HipOrder, tuple[Movement, Movement, Movement]] = {
    "clinical": ("hip_flexion", "hip_adduction", "hip_rotation"),
    "yaw_roll_pitch": ("hip_rotation", "hip_adduction", "hip_flexion"),
}
"""The hip's joints from the pelvis outwards, in each order of the hip."""


def joint(side: Side, movement: Movement) -> str:
    """The joint's name, e.g. `left_knee_flexion`.

    Raises:
        UnknownNameError: Side or movement is unknown.
    """
    if side not in SIDES:
        raise UnknownNameError("side", side, SIDES)
    if movement not in MOVEMENTS:
        raise UnknownNameError("movement", movement, MOVEMENTS)
    return f"{side}_{movement}"
