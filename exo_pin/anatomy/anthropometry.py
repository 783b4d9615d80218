"""Anthropometric tables: segment lengths by stature, masses and inertias by segment, with their sources.

Lengths are fractions of stature (Drillis & Contini 1966, in Winter, Biomechanics and Motor Control of Human
Movement); masses, centres of mass and radii of gyration are those of de Leva, J Biomech 29 (1996) 1223-1230.
The two are combined on purpose: their end points agree for thigh, shank and foot (joint centre to joint
centre, heel to toe). Dempster's masses are not mixed in: his thigh ends elsewhere (10.0 % against 14.2 %).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from exo_pin.anatomy.human import MASS_INDEX_RANGE, usual_mass
from exo_pin.anatomy.names import Movement, Sex

LENGTHS = {"thigh": 0.245, "shank": 0.246, "foot_length": 0.152}
"""Segment length / stature, Drillis & Contini 1966."""

DESIGN_LENGTHS = {
    "ankle_height": 0.039,
    "foot_width": 0.055,
    "hip_width": 0.0975,  # hip joint centres; 0.191 is the breadth over the trochanters
    "trunk": 0.288,  # mid-hip to mid-shoulder
    "head": 0.182,  # shoulder line to vertex
    "shoulder": 0.129,  # half of the shoulder breadth
    "upper_arm": 0.186,
    "forearm": 0.146,
    "hand": 0.108,
}
"""Length / stature: customary values without a source at hand, hence design defaults of this package."""

HIP_BREADTH = 0.191
"""Breadth over the trochanters / stature (Drillis & Contini 1966), of a person of the usual mass."""

WAIST_CLEARANCE = 0.04
"""Padding between body and waist ring, both sides together [m] (design default)."""

HEEL_FRACTION = 0.25
"""Heel behind the ankle / foot length (design default)."""

BALL_FRACTION = 0.45
"""Ball of the foot ahead of the ankle / foot length (design default)."""


class Segment(NamedTuple):
    """One body segment of de Leva's tables.

    Attributes:
        mass: Fraction of the body's mass.
        centre: Centre of mass from the proximal end, fraction of the segment's length.
        gyration: Radii of gyration about the sagittal (forward), transverse (sideways) and longitudinal
            axis through the centre of mass, fractions of the segment's length.
    """

    mass: float
    centre: float
    gyration: tuple[float, float, float]


DE_LEVA = {
    "male": {
        "head": Segment(0.0694, 0.5002, (0.303, 0.315, 0.261)),  # vertex to C7
        "trunk": Segment(0.4346, 0.4310, (0.384, 0.358, 0.197)),  # mid-shoulder to mid-hip
        "upper_arm": Segment(0.0271, 0.5772, (0.285, 0.269, 0.158)),
        "forearm": Segment(0.0162, 0.4574, (0.276, 0.265, 0.121)),
        "hand": Segment(0.0061, 0.3624, (0.288, 0.235, 0.184)),  # wrist to tip of the third finger
        "thigh": Segment(0.1416, 0.4095, (0.329, 0.329, 0.149)),
        "shank": Segment(0.0433, 0.4395, (0.251, 0.246, 0.102)),
        "foot": Segment(0.0137, 0.4415, (0.257, 0.245, 0.124)),  # heel to toe tip
    },
    "female": {
        "head": Segment(0.0668, 0.4841, (0.271, 0.295, 0.261)),
        "trunk": Segment(0.4257, 0.3782, (0.379, 0.361, 0.182)),
        "upper_arm": Segment(0.0255, 0.5754, (0.278, 0.260, 0.148)),
        "forearm": Segment(0.0138, 0.4559, (0.261, 0.257, 0.094)),
        "hand": Segment(0.0056, 0.3427, (0.244, 0.208, 0.154)),
        "thigh": Segment(0.1478, 0.3612, (0.369, 0.364, 0.162)),
        "shank": Segment(0.0481, 0.4352, (0.267, 0.263, 0.092)),
        "foot": Segment(0.0129, 0.4014, (0.299, 0.279, 0.139)),
    },
}
"""de Leva 1996, Table 4 and its alternative end points; head, trunk and arms make the upper body."""

HARDWARE_MASSES = {
    "pelvis_hardware": 6.0,
    "hip_hardware": 1.2,
    "thigh_hardware": 2.2,
    "shank_hardware": 1.6,
    "ankle_hardware": 0.6,
    "foot_hardware": 0.9,
}
"""Hardware of each link [kg] (hip: each of two links), a design choice: 21.4 kg, between the devices of
12 kg (Exo-H2, Indego) and 23 kg (Ekso, ReWalk) in JNER 2021, s12984-021-00815-5, table 1."""

LIMITS_DEG: dict[Movement, tuple[float, float]] = {
    "hip_flexion": (-30.0, 120.0),
    "hip_adduction": (-45.0, 30.0),
    "hip_rotation": (-45.0, 45.0),
    "knee_flexion": (0.0, 130.0),
    "ankle_dorsiflexion": (-50.0, 30.0),
    "ankle_inversion": (-25.0, 35.0),
}
"""Joint limits [deg], a design choice within clinical ranges of motion; the knee's 0 is a mechanical stop,
which makes the answer of inverse kinematics unique."""


def girth(stature: float, mass: float) -> float:
    """Breadth and depth of a body / those of a person of the same stature and the usual mass.

    At equal lengths and density every cross-section grows with the mass, so breadths, depths and girths grow
    with its square root. Measured exponents lie around it: 2/3 at the waist (Krakauer & Krakauer, PLoS ONE 7
    (2012) e39504), less where bone is near the skin. Joint centres do not move.

    Args:
        stature: Height of the person [m].
        mass: Mass of the person [kg].
    """
    lowest, highest = (index / (usual_mass(stature) / stature**2) for index in MASS_INDEX_RANGE)
    ratio = min(max(mass / usual_mass(stature), lowest), highest)
    return round(math.sqrt(ratio), 6)


def average_sizes(stature: float, mass: float, sex: Sex) -> dict[str, float]:
    """Sizes of the body [m] and masses of a leg [kg] by name, the same left and right.

    They are rounded to a micrometre and a milligram, so that files and URDF show plain numbers.

    Args:
        stature: Height of the person [m].
        mass: Mass of the person [kg].
        sex: `"male"` or `"female"`.
    """
    lengths = LENGTHS | DESIGN_LENGTHS
    names = ("thigh", "shank", "ankle_height", "foot_length", "foot_width", "hip_width")
    average = {name: lengths[name] * stature for name in names}
    average["heel"] = HEEL_FRACTION * average["foot_length"]
    average["ball"] = BALL_FRACTION * average["foot_length"]
    average["waist_width"] = HIP_BREADTH * stature * girth(stature, mass) + WAIST_CLEARANCE
    average |= {f"{name}_mass": DE_LEVA[sex][name].mass * mass for name in ("thigh", "shank", "foot")}
    return {name: round(value, 6) for name, value in average.items()}
