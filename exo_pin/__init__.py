"""exo_pin: a person's walk becomes an exoskeleton's walk.

`_HOMES` is the one list of what is public; each name is imported when it is first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from exo_pin.version import __version__ as __version__

if TYPE_CHECKING:  # the same names again, for type checkers and editors
    from exo_pin import anatomy as anatomy
    from exo_pin import clinic as clinic
    from exo_pin import compare as compare
    from exo_pin import control as control
    from exo_pin import crosscheck as crosscheck
    from exo_pin import demand as demand
    from exo_pin import description as description
    from exo_pin import devices as devices
    from exo_pin import dh as dh
    from exo_pin import dynamics as dynamics
    from exo_pin import edit as edit
    from exo_pin import export as export
    from exo_pin import feasible as feasible
    from exo_pin import formats as formats
    from exo_pin import gait as gait
    from exo_pin import ground as ground
    from exo_pin import ik as ik
    from exo_pin import kinematics as kinematics
    from exo_pin import markers as markers
    from exo_pin import plot as plot
    from exo_pin import report as report
    from exo_pin import retarget as retarget
    from exo_pin import simulation as simulation
    from exo_pin import sizing as sizing
    from exo_pin import study as study
    from exo_pin import viewer as viewer
    from exo_pin import walking as walking
    from exo_pin.anatomy import FEET as FEET
    from exo_pin.anatomy import JOINTS as JOINTS
    from exo_pin.anatomy import Body as Body
    from exo_pin.errors import ConvergenceError as ConvergenceError
    from exo_pin.errors import DescriptionError as DescriptionError
    from exo_pin.errors import ExoPinError as ExoPinError
    from exo_pin.errors import FormatError as FormatError
    from exo_pin.errors import GaitError as GaitError
    from exo_pin.errors import LimitError as LimitError
    from exo_pin.errors import UnknownNameError as UnknownNameError
    from exo_pin.formats import Markers as Markers
    from exo_pin.formats import load_gait as load_gait
    from exo_pin.formats import load_markers as load_markers
    from exo_pin.formats import load_torques as load_torques
    from exo_pin.formats import save_gait as save_gait
    from exo_pin.gait import Event as Event
    from exo_pin.gait import Gait as Gait
    from exo_pin.gait import Torques as Torques
    from exo_pin.gait import normative_gait as normative_gait
    from exo_pin.kinematics import poses as poses
    from exo_pin.robot import Robot as Robot
    from exo_pin.robot import load_robot as load_robot
    from exo_pin.robot import load_urdf as load_urdf
    from exo_pin.simulation.simulate import simulate as simulate
    from exo_pin.viewer import view as view
    from exo_pin.walking import plan_walk as plan_walk

_HOMES = {
    "exo_pin": "anatomy clinic compare control crosscheck demand description devices dh dynamics edit export "
    "feasible formats gait ground ik kinematics markers plot report retarget simulation sizing study viewer "
    "walking",
    "exo_pin.anatomy": "Body FEET JOINTS",
    "exo_pin.errors": "ConvergenceError DescriptionError ExoPinError FormatError GaitError LimitError "
    "UnknownNameError",
    "exo_pin.formats": "Markers load_gait load_markers load_torques save_gait",
    "exo_pin.gait": "Event Gait Torques normative_gait",
    "exo_pin.kinematics": "poses",
    "exo_pin.robot": "Robot load_robot load_urdf",
    "exo_pin.simulation": "simulate",
    "exo_pin.viewer": "view",
    "exo_pin.walking": "plan_walk",
}
_HOME = {name: home for home, names in _HOMES.items() for name in names.split()}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> object:
    """Import a public name when it is first asked for (PEP 562)."""
    if name not in _HOME:
        raise AttributeError(f"module 'exo_pin' has no attribute {name!r}")
    if _HOME[name] == "exo_pin":
        return import_module(f"exo_pin.{name}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return __all__
