"""Forward kinematics: poses and motion of the links, the centre of mass, contact with the ground."""

from exo_pin.kinematics.center_of_mass import CenterOfMass, center_of_mass
from exo_pin.kinematics.contact import Contacts, contacts, events, with_events
from exo_pin.kinematics.motion import accelerations, attitude, jacobian, poses, velocities
from exo_pin.kinematics.plate_contacts import plate_events, with_plates
from exo_pin.kinematics.walk_numbers import spatiotemporal

__all__ = [
    "CenterOfMass",
    "Contacts",
    "accelerations",
    "attitude",
    "center_of_mass",
    "contacts",
    "events",
    "jacobian",
    "plate_events",
    "poses",
    "spatiotemporal",
    "velocities",
    "with_events",
    "with_plates",
]
