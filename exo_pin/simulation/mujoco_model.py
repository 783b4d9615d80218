"""The robot as a MuJoCo model: its own URDF with a free pelvis, spheres at the sole corners and a floor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from exo_pin.anatomy import CORNERS
from exo_pin.arguments import number
from exo_pin.control.held_legs import ARMATURE
from exo_pin.errors import DescriptionError, UnknownNameError
from exo_pin.physics import GRAVITY
from exo_pin.robot import Robot

_SPHERE = 0.010
"""Radius of the spheres at the sole corners [m]; the lowest point of each is the corner."""

FLOOR = "floor"
"""Name of the ground."""

_OPTIONS = '<mujoco><compiler fusestatic="false" discardvisual="{discard}"/></mujoco>'


@dataclass(frozen=True)
class Floor:
    """The ground.

    Attributes:
        friction: Coulomb coefficient between sole and floor.
        time_constant: Of the contact's spring and damper (MuJoCo's solref) [s].
        damping_ratio: Of the contact; 1 is critical.

    Raises:
        DescriptionError: A number is not within its range.
    """

    friction: float = 0.8
    time_constant: float = 0.01
    damping_ratio: float = 1.0

    def __post_init__(self) -> None:
        number("friction", self.friction, least=0.0, most=10.0)
        number("time_constant", self.time_constant, above=0.0, most=1.0)
        number("damping_ratio", self.damping_ratio, above=0.0, most=100.0)


def mujoco_spec(
    robot: Robot,
    *,
    floor: Floor | None = None,
    timestep: float = 0.001,
    visuals: bool = False,
    free: bool = True,
) -> Any:
    """The editable MuJoCo model (`mujoco.MjSpec`) of a robot.

    Args:
        robot: With the sole corners of `CORNERS`.
        floor: The ground.
        timestep: Of the simulation [s].
        visuals: Whether it keeps the URDF's visual shapes, which a simulation does not need.
        free: Whether the root moves freely, whatever `robot.base` is; else it is fixed in the world.

    Raises:
        DescriptionError: MuJoCo does not accept the robot, or the timestep is not within 1 us to 0.1 s.
        UnknownNameError: A sole corner is missing.
    """
    import mujoco

    number("timestep [s]", timestep, least=1e-6, most=0.1)

    floor = floor or Floor()
    try:
        spec = mujoco.MjSpec.from_string(_with_options(robot.urdf, visuals=visuals))
    except ValueError as error:
        raise DescriptionError(f"{robot.name}: MuJoCo does not accept its URDF") from error
    spec.option.timestep = timestep
    spec.option.gravity = [0.0, 0.0, -GRAVITY]
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.impratio = 10.0
    # a state that went bad would be put back to the start in silence
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    spec.option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    for geom in spec.geoms:
        geom.contype = geom.conaffinity = 0
    if free:
        _root(spec).add_freejoint(name="pelvis_free")
    _add_soles(spec, floor)
    spec.worldbody.add_geom(
        name=FLOOR,
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0.0, 0.0, 1.0],
        contype=0,
        conaffinity=1,
        friction=[floor.friction, 0.005, 0.0001],
        solref=[floor.time_constant, floor.damping_ratio],
    )
    for joint in spec.joints:
        if joint.type != mujoco.mjtJoint.mjJNT_FREE:
            driven = robot.effort[robot.joints.index(joint.name)] > 0.0
            joint.armature = ARMATURE if driven else 0.0
            joint.damping, joint.frictionloss = (
                np.zeros((3, 1)),
                0.0,
            )  # every damper is computed outside the engine
            joint.actfrclimited = mujoco.mjtLimited.mjLIMITED_FALSE  # so are the motors' limits
    return spec


def mujoco_model(robot: Robot, *, floor: Floor | None = None, timestep: float = 0.001) -> Any:
    """The compiled MuJoCo model (`mujoco.MjModel`); arguments and errors as for `mujoco_spec`."""
    return compiled(mujoco_spec(robot, floor=floor, timestep=timestep), robot)


def compiled(spec: Any, robot: Robot) -> Any:
    """MuJoCo's model of a specification.

    Raises:
        DescriptionError: MuJoCo does not accept the robot.
    """
    try:
        return spec.compile()
    except ValueError as error:
        raise DescriptionError(f"{robot.name}: MuJoCo does not accept it ({error})") from error


def _with_options(urdf: str, *, visuals: bool) -> str:
    """The URDF with MuJoCo's own element in its root: no link is merged into its parent."""
    end = urdf.index(">", urdf.index("<robot")) + 1
    return urdf[:end] + _OPTIONS.format(discard=str(not visuals).lower()) + urdf[end:]


def _root(spec: Any) -> Any:
    """The body that carries all others."""
    return spec.worldbody.first_body()


def _add_soles(spec: Any, floor: Floor) -> None:
    """A massless sphere at each sole corner, which meets the floor alone."""
    import mujoco

    for name in CORNERS:
        corner = spec.body(name)
        if corner is None:
            raise UnknownNameError("sole corner", name, [body.name for body in spec.bodies])
        corner.add_geom(
            name=name,
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[_SPHERE, 0.0, 0.0],
            pos=[0.0, 0.0, _SPHERE],
            mass=0.0,
            contype=1,
            conaffinity=0,
            condim=3,
            friction=[floor.friction, 0.005, 0.0001],
            solref=[floor.time_constant, floor.damping_ratio],
        )
