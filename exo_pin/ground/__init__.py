"""A walk on its ground: which foot stands, how the pelvis is supported, where everything is."""

from exo_pin.ground.alignment import aligned, alignment_note
from exo_pin.ground.placement import PlacedWalk, place, place_walk, toe_angles, transformed
from exo_pin.ground.stance import Intervals, estimated_stance, lowest_corners, stance_from_events, standing
from exo_pin.ground.support import DEEPEST_SINK, STYLES, Support, belt_speed, support

__all__ = [
    "DEEPEST_SINK",
    "STYLES",
    "Intervals",
    "PlacedWalk",
    "Support",
    "aligned",
    "alignment_note",
    "belt_speed",
    "estimated_stance",
    "lowest_corners",
    "place",
    "place_walk",
    "stance_from_events",
    "standing",
    "support",
    "toe_angles",
    "transformed",
]
