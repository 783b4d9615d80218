"""Forward kinematics: poses and motion of the links, the centre of mass, contact with the ground."""

from exo_pin.kinematics.center_of_mass import CenterOfMass, center_of_mass
from exo_pin.kinematics.curve_outliers import CurveOutlier, curve_outliers
from exo_pin.kinematics.event_differences import EventDifference, disagreements, event_differences
from exo_pin.kinematics.foot_markers import foot_markers
from exo_pin.kinematics.frame_motion import accelerations, jacobian, velocities
from exo_pin.kinematics.joint_frames import deviation_from_parallel, joint_frames
from exo_pin.kinematics.joint_rates import JointRates, joint_rates, smoothed_curves
from exo_pin.kinematics.motion import attitude, poses, positions
from exo_pin.kinematics.plate_contacts import PlateStep, plate_events, plate_steps, with_plates
from exo_pin.kinematics.sole_contact import Contacts, contacts, events, with_events
from exo_pin.kinematics.stance_slide import (
    LARGE_SLIDE,
    SoleSlide,
    StanceSlide,
    largest_slide,
    slide_doubts,
    sole_slide,
    stance_slides,
)
from exo_pin.kinematics.walk_numbers import WalkNumbers, spatiotemporal, walk_numbers, walking_speed
from exo_pin.kinematics.walk_plausibility import plausibility

__all__ = [
    "LARGE_SLIDE",
    "CenterOfMass",
    "Contacts",
    "CurveOutlier",
    "EventDifference",
    "JointRates",
    "PlateStep",
    "SoleSlide",
    "StanceSlide",
    "WalkNumbers",
    "accelerations",
    "attitude",
    "center_of_mass",
    "contacts",
    "curve_outliers",
    "deviation_from_parallel",
    "disagreements",
    "event_differences",
    "events",
    "foot_markers",
    "jacobian",
    "joint_frames",
    "joint_rates",
    "largest_slide",
    "plate_events",
    "plate_steps",
    "plausibility",
    "poses",
    "positions",
    "slide_doubts",
    "smoothed_curves",
    "sole_slide",
    "spatiotemporal",
    "stance_slides",
    "velocities",
    "walk_numbers",
    "walking_speed",
    "with_events",
    "with_plates",
]
