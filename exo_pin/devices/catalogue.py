"""The catalogue of devices: one record each."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from exo_pin.anatomy.names import JOINTS
from exo_pin.devices.actuator import DEFAULT_ACTUATORS, Actuator
from exo_pin.devices.device import Device, both
from exo_pin.devices.device_file import load
from exo_pin.errors import FormatError, UnknownNameError, same_name
from exo_pin.plugins import plugin, plugin_names

_CHOSEN = "Torques and speeds: a design choice, those of exo12 (no source gives them joint by joint)."
_TRAVEL = "Travel and speed of the pelvis's slides: a design choice, +-0.10 m and 1 m/s."
_FOOT = both("ankle_dorsiflexion", "ankle_inversion")
_FREE_FOOT = "The foot is free in LOPES; here the ankle is held at zero unless released."
_TRUNK_PITCH = "The trunk's pitch is left to the hips: it turns about the same axis as hip flexion."


def _loose(*slides: str) -> Mapping[str, Actuator]:
    """Slides without a motor."""
    return {slide: DEFAULT_ACTUATORS[slide]._replace(effort=0.0) for slide in slides}


EXO12 = Device(
    name="exo12",
    title="12-joint exoskeleton of the paper",
    joints=JOINTS,
    pelvis="held",
    source="Degrees of freedom: Chen, Zhang and Zhu. Torques and speeds: a design choice, above what a "
    "70 kg person's level walking at any of Schwartz's (2008) speeds needs; the paper gives none.",
    remarks=("The same arrangement as ATALANTE, 12 actuated joints (Gurriet 2018).",),
)
"""The exoskeleton of the paper: the device where none is named."""

LOKOMAT = Device(
    name="lokomat",
    title="LOKOMAT",
    joints=both("hip_flexion", "knee_flexion"),
    passive=both("ankle_dorsiflexion"),
    pelvis=("pelvis_up",),
    actuators=_loose("pelvis_up"),
    treadmill=(0.5 / 3.6, 3.2 / 3.6),
    masses=(0.0, 135.0),
    source="PMC9768983, table 3: DC motors at hip and knee, ankle passive, pelvis fixed, body-weight support "
    "with vertical and lateral movement of the centre of mass. Chen, Zhang and Zhu: ball screws. Users up to "
    "135 kg: exclusion criterion of the trial Energy consumption and cardiorespiratory load during "
    "robot-assisted gait training (strokecenter.org). " + _CHOSEN,
    remarks=(
        "Of the support's movements the record has the vertical one alone.",
        "The ankle is carried by foot lifters and moved by the treadmill; here it is held at zero unless "
        "released.",
        "Its treadmill runs at 0.5 to 3.2 km/h: no primary source of these two numbers was at hand; a device "
        "file can hold another range.",
        "No source at hand gives the ranges of its thigh, shank and pelvis.",
        _TRAVEL,
    ),
)

LOPES7 = Device(
    name="lopes7",
    title="LOPES, as the paper counts (7)",
    joints=both("hip_flexion", "hip_adduction", "knee_flexion"),
    passive=_FOOT,
    pelvis=("pelvis_up",),
    source="Chen, Zhang and Zhu: 7 degrees of freedom, hip flexion, hip adduction and knee of each leg and "
    "the pelvis up and down. " + _CHOSEN,
    remarks=("Its authors count 8: see lopes8. " + _FREE_FOOT, _TRAVEL),
)

LOPES8 = Device(
    name="lopes8",
    title="LOPES, as its authors count (8)",
    joints=both("hip_flexion", "hip_adduction", "knee_flexion"),
    passive=_FOOT,
    pelvis=("pelvis_forward", "pelvis_left", "pelvis_up"),
    actuators=_loose("pelvis_up"),
    source="Veneman et al. 2007, IEEE TNSRE 15(3):379: a freely translatable pelvis, driven forward and "
    "sideways, and two driven joints at the hip and one at the knee of each leg. " + _CHOSEN,
    remarks=(
        "The pelvis moves vertically too, without a motor. The paper counts 7: see lopes7.",
        _TRAVEL,
        _FREE_FOOT,
    ),
)

H2 = Device(
    name="h2",
    title="Exo-H2",
    joints=both("hip_flexion", "knee_flexion", "ankle_dorsiflexion"),
    passive=both("hip_adduction"),
    pelvis="free",
    ranges={"hip_adduction": (math.radians(-20.0), math.radians(20.0))},
    statures=(1.45, 1.95),
    masses=(0.0, 100.0),
    source="Bortole et al. 2015, JNER 12:54: six driven joints in the sagittal plane, passive movement of "
    "about 20 degrees at the hip in the frontal plane, 12 kg. JNER 2021, s12984-021-00815-5, table 1: users "
    "of 1.45 to 1.95 m and up to 100 kg. " + _CHOSEN,
    remarks=(
        "Worn over ground: the pelvis goes with the person.",
        "Its driven joints have mechanical stops, whose angles were not at hand: the body's ranges hold.",
        "Thigh and shank are telescopic bars, whose ranges were not at hand either.",
    ),
)

HK4 = Device(
    name="hk4",
    title="powered orthosis (ReWalk, Indego, Ekso)",
    joints=both("hip_flexion", "knee_flexion"),
    passive=both("ankle_dorsiflexion"),
    pelvis="free",
    statures=(1.55, 1.91),
    masses=(0.0, 113.0),
    thighs=(0.355, 0.47),
    hip_breadths=(0.0, 0.42),
    source="JNER 2021, s12984-021-00815-5, table 1: hips and knees driven; Ekso 23 kg, ReWalk 23.3 kg, "
    "Indego 12 kg. Users: Ekso 1.58 to 1.88 m, up to 100 kg; ReWalk 1.60 to 1.90 m, up to 100 kg; Indego "
    "1.55 to 1.91 m, up to 113 kg. Indego's trial NCT02202538: femur of 35.5 to 47 cm and hips of at most "
    "42 cm, measured in sitting. " + _CHOSEN,
    remarks=(
        "The record's ranges of users are Indego's, the widest of the three.",
        "Ekso takes hips of at most 42 cm too, upper legs of 51 to 61.4 cm and lower legs of 48 to 63.4 cm "
        "(inclusion criteria of the trial Performance attributes and user progression while using Ekso): "
        "lengths of another definition than hip centre to knee and knee to ankle, so they are not judged.",
        "Worn over ground: the pelvis goes with the person. The ankle is sprung in Ekso; here it is held at "
        "zero unless released.",
    ),
)

PLANAR5 = Device(
    name="planar5",
    title="planar five-link model",
    joints=both("hip_flexion", "knee_flexion"),
    pelvis=("pelvis_forward", "pelvis_up"),
    actuators=_loose("pelvis_forward", "pelvis_up"),
    source="Sagittal model of trunk, two thighs and two shanks, the feet rigid with the shanks. " + _CHOSEN,
    remarks=(_TRUNK_PITCH, _TRAVEL),
)

PLANAR7 = Device(
    name="planar7",
    title="planar seven-link model",
    joints=both("hip_flexion", "knee_flexion", "ankle_dorsiflexion"),
    pelvis=("pelvis_forward", "pelvis_up"),
    actuators=_loose("pelvis_forward", "pelvis_up"),
    source="Sagittal model of trunk, two thighs, two shanks and two feet. " + _CHOSEN,
    remarks=(_TRUNK_PITCH, _TRAVEL),
)

PLANAR9 = Device(
    name="planar9",
    title="planar nine-link model (with toes)",
    joints=both("hip_flexion", "knee_flexion", "ankle_dorsiflexion"),
    pelvis=("pelvis_forward", "pelvis_up"),
    actuators=_loose("pelvis_forward", "pelvis_up"),
    toes=True,
    source="Sagittal model of trunk, two thighs, two shanks, two feet and two toes: the reading with toes. "
    "Toe joint across the ball of the foot, its range and torque: a design choice. " + _CHOSEN,
    remarks=(
        _TRUNK_PITCH,
        _TRAVEL,
        "Authors differ on the nine links (toes, or arms and head); a gait of this package has no toe "
        "angles, so the toes stay at zero and the sole's pose is that of planar7.",
    ),
)

DEVICES: Mapping[str, Device] = MappingProxyType(
    {d.name: d for d in (EXO12, LOKOMAT, LOPES7, LOPES8, H2, HK4, PLANAR5, PLANAR7, PLANAR9)}
)
"""Every device by name."""


_PRODUCTS: Mapping[str, str] = MappingProxyType(
    {"Exo-H2": "h2", "Ekso": "hk4", "ReWalk": "hk4", "Indego": "hk4", "ATALANTE": "exo12"}
)
"""What people call devices of the catalogue, beside their names."""


def _known_name(text: str) -> str | None:
    """The name of the device that is meant, in any capitals."""
    product = same_name(text, _PRODUCTS)
    return same_name(text, DEVICES) or (None if product is None else _PRODUCTS[product])


def find(device: str | Device) -> Device:
    """The device of that name (capitals do not matter), or of that TOML file; a record is handed back.

    Names that are not known are looked up among the entry points `exo_pin.devices` of installed packages.

    Raises:
        DescriptionError: Another package's device cannot be loaded.
        UnknownNameError: There is no device of that name.
        FormatError: The file is a robot's description, no device, or has the name of a known one.
    """
    if isinstance(device, Device):
        return device
    name = _known_name(device)
    if name is not None:
        return DEVICES[name]
    if isinstance(device, str | Path) and Path(device).suffix.lower() == ".toml":
        own = load(device)
        if own.name in DEVICES:
            raise FormatError(device, f"name {own.name!r} is that of a device of exo_pin; take another")
        return own
    if isinstance(device, str | Path) and Path(device).suffix.lower() in (".urdf", ".xacro"):
        raise FormatError(
            device,
            "a robot's description is no device: a name or a TOML record is accepted (docs/devices.md); "
            "robots walk by `exo-pin retarget` and by --robot of replay, picture, film and report",
        )
    added = plugin("exo_pin.devices", str(device), Device)
    if added is None:
        raise UnknownNameError("device", device, (*DEVICES, *_PRODUCTS, *plugin_names("exo_pin.devices")))
    return added
