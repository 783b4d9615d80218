"""Gait data: angles over time, events, cycles, spatiotemporal parameters, reference values."""

from exo_pin.gait.cycles import Cycles, cycles
from exo_pin.gait.event import EVENT_KINDS, Event
from exo_pin.gait.gait import Gait
from exo_pin.gait.half_strides import StrideEstimate, stride_estimate, walk_estimate
from exo_pin.gait.leg_cycles import LegCycle, leg_cycles
from exo_pin.gait.manner import manner
from exo_pin.gait.normative import SPEEDS, normative_gait, normative_sd, speed_named
from exo_pin.gait.plausibility import Plausibility, implausibilities
from exo_pin.gait.published_ranges import Norm, against_normal, normal
from exo_pin.gait.spatiotemporal import Number, spatiotemporal
from exo_pin.gait.stance_times import stance_times
from exo_pin.gait.strides import Stride, side_with_more_strides, strides
from exo_pin.gait.torques import Torques
from exo_pin.gait.zeni_method import zeni

__all__ = [
    "EVENT_KINDS",
    "SPEEDS",
    "Cycles",
    "Event",
    "Gait",
    "LegCycle",
    "Norm",
    "Number",
    "Plausibility",
    "Stride",
    "StrideEstimate",
    "Torques",
    "against_normal",
    "cycles",
    "implausibilities",
    "leg_cycles",
    "manner",
    "normal",
    "normative_gait",
    "normative_sd",
    "side_with_more_strides",
    "spatiotemporal",
    "speed_named",
    "stance_times",
    "stride_estimate",
    "strides",
    "walk_estimate",
    "zeni",
]
