"""The names that everything is addressed by: sides, movements, joints, feet and sole corners."""

SIDES = ("left", "right")

MOVEMENTS = (
    "hip_flexion",
    "hip_adduction",
    "hip_rotation",
    "knee_flexion",
    "ankle_dorsiflexion",
    "ankle_inversion",
)
"""Movements of a leg; the name is the positive direction on both sides (hip_rotation: internal)."""

JOINTS = tuple(f"{side}_{movement}" for side in SIDES for movement in MOVEMENTS)
"""The 12 joints in the order of `Gait.q`."""

FEET = ("left_foot", "right_foot")
"""Frames on the sole under each ankle."""

CORNERS = tuple(
    f"{side}_{part}_{edge}" for side in SIDES for part in ("heel", "ball") for edge in ("medial", "lateral")
)
"""Contact corners of the soles: heel and ball of the foot, four a foot."""

HIP_ORDERS = {
    "clinical": ("hip_flexion", "hip_adduction", "hip_rotation"),
    "yaw_roll_pitch": ("hip_rotation", "hip_adduction", "hip_flexion"),
}
"""Order of the three hip joints from the pelvis outwards: ISB and gait laboratories, or humanoids."""


def joint(side: str, movement: str) -> str:
    """The joint's name, e.g. `left_knee_flexion`."""
    return f"{side}_{movement}"
