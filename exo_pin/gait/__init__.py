"""A walk as data: angles over time, contact events, and the normative walk at five speeds."""

from exo_pin.gait.event import EVENT_KINDS, Event
from exo_pin.gait.events import zeni
from exo_pin.gait.normative import SPEEDS, normative_gait
from exo_pin.gait.walk import Gait

__all__ = ["EVENT_KINDS", "SPEEDS", "Event", "Gait", "normative_gait", "zeni"]
