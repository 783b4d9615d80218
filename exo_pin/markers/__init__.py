"""Marker trials as walks: inverse kinematics of the markers on a body scaled from them."""

from exo_pin.markers.marker_sets import SETS, MarkerSet, Spot, marker_set
from exo_pin.markers.reconstruction import Reconstruction, load_walk, reconstruct

__all__ = ["SETS", "MarkerSet", "Reconstruction", "Spot", "load_walk", "marker_set", "reconstruct"]
