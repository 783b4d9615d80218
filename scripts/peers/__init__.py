"""Peers of exo_pin.ik, each used as its documentation recommends; one entry in PEERS per package.

A peer is a class with `name`, `package`, and either `batch(targets, seed)` for all frames at once or
`single(T_left, T_right, seed)` for one; both return joint angles in the order of Robot.joints, NaN where the
package says that it found none.
"""

from peers.eaik import Eaik
from peers.ikpy import Ikpy
from peers.mink import Mink
from peers.pink import Pink
from peers.pinocchio import Clik, ClikFullStep
from peers.toolbox import Toolbox
from peers.tracik import TracIk

PEERS = (Eaik, Toolbox, Clik, ClikFullStep, Mink, Pink, TracIk, Ikpy)
