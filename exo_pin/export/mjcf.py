"""The exoskeleton as a MuJoCo scene (MJCF): floor, contacts, motors, sensors, keyframes, visual shapes."""

from __future__ import annotations

from typing import Any, Literal, get_args

import numpy as np

from exo_pin import arguments
from exo_pin.anatomy import CORNERS, MOVEMENTS
from exo_pin.arrays import Array
from exo_pin.control.servo import DAMPING, STIFFNESS
from exo_pin.devices import SLIDES, movement_of
from exo_pin.export.exact_numbers import exact_xml
from exo_pin.gait import Gait
from exo_pin.gait.quaternions import quaternions
from exo_pin.ground import place_walk
from exo_pin.robot import Robot
from exo_pin.robot.floating_base import FREE
from exo_pin.simulation import mujoco_spec

Actuators = Literal["motor", "servo"]

_KEYS = 10
"""Keyframes of a walk, evenly over it."""

_HIDDEN = 3
"""MuJoCo's group of shapes that a viewer shows on demand: collision shapes and sole spheres."""

_SUPPORT_SPRING = (-220.0, -22.0)
"""Stiffness [1/s^2] and damping [1/s] of the weld that holds the pelvis: 2e4 N/m for 90 kg (a choice)."""


def mjcf(
    robot: Robot, gait: Gait | None = None, *, actuators: Actuators = "motor", support: bool = False
) -> str:
    """The exoskeleton as a MuJoCo scene, numbers in full digits.

    The root is the pelvis, free to move; of a device whose pelvis slides on a stand it is the stand, fixed.
    The file needs no other file. Keyframes: `stand`, and with a gait `walk_0` to `walk_9` over it.

    Args:
        robot: With the sole corners of `CORNERS`.
        gait: The walk of the keyframes.
        actuators: `"motor"`: control is a torque [N m]; `"servo"`: control is an angle [rad], held by the
            stiffness and damping of the controller `pd`.
        support: Whether a mocap body `support` holds the pelvis by a soft weld, and the pelvis follows it.

    Raises:
        DescriptionError: MuJoCo does not accept the robot.
        UnknownNameError: A sole corner is missing, or there are no such actuators.
    """
    arguments.word("actuators", actuators, get_args(Actuators))
    held = robot.device is not None and bool(robot.device.slides)
    spec = mujoco_spec(robot, visuals=True, free=not held)
    spec.option.disableflags = 0
    spec.worldbody.first_body().pos = robot.placement[:3, 3]
    _name_shapes(spec)
    _add_actuators(spec, robot, actuators)
    _add_sensors(spec, robot)
    _add_light(spec)
    if support and not held:
        _add_support(spec, robot)
    _add_keys(spec, robot, gait, held=held)
    return exact_xml(spec)


def _name_shapes(spec: Any) -> None:
    """Names for the shapes of the URDF, by which their exact numbers are found again."""
    for body in spec.bodies:
        for k, geom in enumerate(body.geoms):
            if geom.name in ("", None):
                geom.name = f"{body.name}_shape_{k}"
            if geom.group == 0 and body.name != "world":
                geom.group = _HIDDEN


def _add_actuators(spec: Any, robot: Robot, kind: Actuators) -> None:
    """One actuator for each driven joint, named as it is."""
    import mujoco

    for name, effort, lower, upper in zip(robot.joints, robot.effort, robot.lower, robot.upper, strict=True):
        if effort <= 0.0:
            continue
        motor = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        motor.forcerange = [-effort, effort]
        motor.forcelimited = True
        motor.ctrllimited = True
        if kind == "motor" or movement_of(name) not in MOVEMENTS:
            motor.ctrlrange = [-effort, effort]
            continue
        k = MOVEMENTS.index(movement_of(name))
        motor.ctrlrange = [lower, upper]
        motor.biastype = mujoco.mjtBias.mjBIAS_AFFINE
        motor.gainprm[0] = STIFFNESS[k]
        motor.biasprm[1], motor.biasprm[2] = -STIFFNESS[k], -DAMPING[k]


def _add_sensors(spec: Any, robot: Robot) -> None:
    """Angle, speed, torque of each joint; an inertial sensor at the pelvis; force of each sole corner."""
    import mujoco

    kind = mujoco.mjtSensor
    joint, site = mujoco.mjtObj.mjOBJ_JOINT, mujoco.mjtObj.mjOBJ_SITE
    for name in robot.joints:
        for what, sensed in (("angle", kind.mjSENS_JOINTPOS), ("speed", kind.mjSENS_JOINTVEL)):
            spec.add_sensor(name=f"{name}_{what}", type=sensed, objtype=joint, objname=name)
        spec.add_sensor(name=f"{name}_torque", type=kind.mjSENS_JOINTACTFRC, objtype=joint, objname=name)
    spec.body("pelvis").add_site(name="imu", size=[0.01, 0.01, 0.01], group=_HIDDEN)
    for what, sensed in (
        ("attitude", kind.mjSENS_FRAMEQUAT),
        ("gyro", kind.mjSENS_GYRO),
        ("accelerometer", kind.mjSENS_ACCELEROMETER),
    ):
        spec.add_sensor(name=f"pelvis_{what}", type=sensed, objtype=site, objname="imu")
    for corner in CORNERS:
        sphere = spec.geom(corner)
        spec.body(corner).add_site(
            name=f"{corner}_pad", pos=sphere.pos, size=1.2 * sphere.size, group=_HIDDEN
        )
        spec.add_sensor(name=f"{corner}_force", type=kind.mjSENS_TOUCH, objtype=site, objname=f"{corner}_pad")


def _add_light(spec: Any) -> None:
    """A sun, a floor with squares, a plain sky, and a camera that follows from the side."""
    import mujoco

    spec.stat.center, spec.stat.extent = [0.0, 0.0, 0.8], 1.8
    spec.visual.headlight.ambient = [0.45, 0.45, 0.45]
    sun = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
    spec.worldbody.add_light(name="sun", type=sun, pos=[1.0, -1.0, 3.0], dir=[-0.3, 0.3, -1.0])
    spec.body("pelvis").add_camera(
        name="side",
        mode=mujoco.mjtCamLight.mjCAMLIGHT_TRACKCOM,
        pos=[1.2, -2.8, 0.2],
        xyaxes=[0.92, 0.39, 0.0, -0.04, 0.10, 1.0],
    )
    kind, drawn = mujoco.mjtTexture, mujoco.mjtBuiltin
    light, dark = [0.90, 0.91, 0.93], [0.82, 0.84, 0.87]
    squares = {"type": kind.mjTEXTURE_2D, "builtin": drawn.mjBUILTIN_CHECKER, "height": 256}
    spec.add_texture(name="squares", width=256, rgb1=light, rgb2=dark, **squares)
    high, low = [0.96, 0.97, 0.98], [0.80, 0.85, 0.90]
    sky = {"type": kind.mjTEXTURE_SKYBOX, "builtin": drawn.mjBUILTIN_GRADIENT, "height": 1536}
    spec.add_texture(name="sky", width=256, rgb1=high, rgb2=low, **sky)
    floor = spec.add_material(name="squares", texrepeat=[1, 1], texuniform=True)
    floor.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "squares"
    spec.geom("floor").material = "squares"


def _add_support(spec: Any, robot: Robot) -> None:
    """A body that the user moves, and a soft weld from it to the pelvis."""
    import mujoco

    spec.worldbody.add_body(name="support", mocap=True, pos=robot.placement[:3, 3])
    weld = spec.add_equality(name="support", type=mujoco.mjtEq.mjEQ_WELD, objtype=mujoco.mjtObj.mjOBJ_BODY)
    weld.name1, weld.name2 = "support", "pelvis"
    weld.solref = _SUPPORT_SPRING


def _add_keys(spec: Any, robot: Robot, gait: Gait | None, *, held: bool) -> None:
    """`stand`, and the walk at even times."""
    model = spec.compile()  # tells where each joint stands in qpos
    columns = np.array([int(model.joint(name).qposadr[0]) for name in robot.joints])
    frames = [("stand", robot.placement, np.zeros(len(robot.joints)))]
    if gait is not None:
        placed = place_walk(robot, gait)
        at = np.linspace(0, len(gait), _KEYS, endpoint=False).astype(int)
        frames += [(f"walk_{k}", placed.base[i], placed.q[i]) for k, i in enumerate(at)]
    for name, T, q in frames:
        joints = _with_slides(robot, T, q) if held else q
        qpos = np.zeros(model.nq)
        if not held:
            qpos[:3], qpos[3:FREE] = T[:3, 3], quaternions(T[None, :3, :3])[0]
        qpos[columns] = joints
        angles = dict(zip(robot.joints, joints, strict=True))
        ctrl = [angles[a.name] if a.biasprm[1] else 0.0 for a in map(model.actuator, range(model.nu))]
        spec.add_key(name=name, qpos=qpos, ctrl=ctrl)


def _with_slides(robot: Robot, T: Array, q: Array) -> Array:
    """Joint values whose slides carry the pelvis to where the walk has it, as far as they go."""
    q = q.copy()
    for axis, slide in enumerate(SLIDES):
        if slide in robot.joints:
            column = robot.joints.index(slide)
            way = T[axis, 3] - robot.placement[axis, 3]
            q[column] = np.clip(way, robot.lower[column], robot.upper[column])
    return q
