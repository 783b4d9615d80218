"""Reference kinematics, derived twice, and inverse dynamics in NumPy, without Pinocchio and without the URDF.

1. `recursion`: the paper's Eq. (1) to (6) over its family tree of links, Rodrigues' formula for each joint.
2. `modified_dh`: Craig's modified Denavit-Hartenberg table of each leg.

`inverse_dynamics` carries the recursion on to velocities, accelerations, forces and moments.
`of_device` takes either to a device with fewer or further joints.

Both know only a `Body` and the meaning of the joint names. All frames are parallel to the pelvis at q = 0.
"""

from exo_pin.dh.device_tree import of_device
from exo_pin.dh.leg_chain import chain
from exo_pin.dh.modified_dh_table import DHRow, ends, modified_dh, table
from exo_pin.dh.newton_euler_recursion import JointState, Needed, PelvisState, inverse_dynamics
from exo_pin.dh.recursion import Link, recursion, tree

__all__ = [
    "DHRow",
    "JointState",
    "Link",
    "Needed",
    "PelvisState",
    "chain",
    "ends",
    "inverse_dynamics",
    "modified_dh",
    "of_device",
    "recursion",
    "table",
    "tree",
]
