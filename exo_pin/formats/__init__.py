"""Files of motion laboratories: joint angles, markers, torques and force plates, each read once."""

from exo_pin.formats.loading import (
    TORQUE_SUFFIXES,
    is_markers,
    knee_preset,
    load_forces,
    load_gait,
    load_markers,
    load_torques,
    save_gait,
    save_torques,
)
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.registry import FORMATS, MARKER_FORMATS, Content, Format, open_trial, written_format
from exo_pin.formats.sign_presets import PRESETS
from exo_pin.formats.tables import Poses, load_poses, save_poses
from exo_pin.formats.trial_file import TrialFile
from exo_pin.gait.trial import ForcePlate, Markers

__all__ = [
    "FORMATS",
    "MARKER_FORMATS",
    "PRESETS",
    "TORQUE_SUFFIXES",
    "Content",
    "ForcePlate",
    "Format",
    "Markers",
    "Poses",
    "ReadOptions",
    "TrialFile",
    "is_markers",
    "knee_preset",
    "load_forces",
    "load_gait",
    "load_markers",
    "load_poses",
    "load_torques",
    "open_trial",
    "save_gait",
    "save_poses",
    "save_torques",
    "written_format",
]
