"""Clinical indices of a walk: its cycles as a laboratory draws them, normal bands, the Gait Profile Score."""

from exo_pin.clinic.band_file import load_band, save_band
from exo_pin.clinic.clinical_cycles import ClinicalCycles, clinical_cycles, normal_cycles
from exo_pin.clinic.compared_trial import Change, Trial, change
from exo_pin.clinic.gait_profile import NINE, GaitProfile, gait_profile
from exo_pin.clinic.normal_band import BandCurve, NormalBand, published_band, recorded_band

__all__ = [
    "NINE",
    "BandCurve",
    "Change",
    "ClinicalCycles",
    "GaitProfile",
    "NormalBand",
    "Trial",
    "change",
    "clinical_cycles",
    "gait_profile",
    "load_band",
    "normal_cycles",
    "published_band",
    "recorded_band",
    "save_band",
]
