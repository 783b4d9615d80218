"""Marker trials as walks: inverse kinematics of the markers on a body scaled from them."""

from exo_pin.markers.marker_sets import SETS, find_set
from exo_pin.markers.model_set import model_set
from exo_pin.markers.recognition import Recognised, recognise
from exo_pin.markers.reconstruction import Reconstruction, load_walk, reconstruct
from exo_pin.markers.set_file import load_set
from exo_pin.markers.spots import MarkerSet, Spot

__all__ = [
    "SETS",
    "MarkerSet",
    "Recognised",
    "Reconstruction",
    "Spot",
    "find_set",
    "load_set",
    "load_walk",
    "model_set",
    "recognise",
    "reconstruct",
]
