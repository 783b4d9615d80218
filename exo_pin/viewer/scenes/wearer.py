"""The wearer: a translucent person whose legs hang on the exoskeleton's own links.

The figure is `human_description` of example-robot-data (BSD-2-Clause, Gepetto team), welded, thinned and
scaled to the body, trunk and limbs by its girth. Thighs, shanks and feet hang on the exoskeleton's links, so
hips, knees and ankles coincide with its joints by construction. The upper body is illustration: the trunk
stays nearly upright, and the arms swing with the opposite hip.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pinocchio as pin

from exo_pin.anatomy import JOINTS, SIDES, Body, Leg
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.viewer.drawing_commands import Command, mesh, place, translucent
from exo_pin.viewer.meshes import solids
from exo_pin.viewer.meshes.solids import Solid, sphere, translation
from exo_pin.viewer.scenes.actor import Actor, flat_poses
from exo_pin.viewer.scenes.person_figure import part, scaled
from exo_pin.viewer.scenes.scene import Chain, Group, JointNode

_SKIN = (0.80, 0.62, 0.50, 0.45)
"""Colour and opacity."""

_PLATE = 0.022
"""The foot stands on the exoskeleton's foot plate, so far above its sole [m]."""

_SPREAD = np.radians(11.0)
"""The arms are held so far away from the waist ring."""

_THIGH, _SHANK, _HEAD = 0.439, 0.44, 0.8315  # the figure's own sizes [m]: hip to knee, to ankle, hip to crown
_HIP = np.array([0.023, 0.0, -0.1])  # its hip centre seen from its pelvis, without the sideways part
_LUMBAR = -_HIP
_SHOULDER = np.array([0.008, 0.182, 0.324])  # seen from the lumbar joint; nearer to the chest than 0.21
_UPPER_ARM = 0.276


def wearer(
    body: Body, links: Mapping[str, str], root: str, gait: Gait, base: Array, *, like: Actor | None = None
) -> Actor:
    """The person of a body in a walk.

    Args:
        body: Sizes.
        links: Link name -> path of the exoskeleton's nodes.
        root: Path for the upper body; its last part is the name of the figure.
        gait: The walk.
        base: `(n, 4, 4)` pose of the pelvis as shown.
        like: The same person in another walk, whose shapes are shown again.

    Raises:
        ExoPinError: example-robot-data is not installed.
    """
    size, name = _size(body), root.rpartition("/")[2]
    middle = {"pelvis": f"{links['pelvis']}/wearer", "trunk": f"{root}/look"}
    left, right = (_limbs(links, root, side) for side in SIDES)
    paths = (*middle.values(), *left.values(), *right.values())
    chain, placements = _arms(root, size, body.girth)
    hips = gait.q[:, [JOINTS.index(f"{side}_hip_flexion") for side in SIDES]]
    arms, trunk = upper_body(body, hips - hips.mean(axis=0), base)
    mirrored = [place(path, _mirrored(body, part)) for part, path in right.items()]
    if like is None:
        shapes = _middle(size, body.girth) | _limb_shapes(body, size)
        pictures = [_picture(path, shapes[part]) for part, path in (middle | left).items()]
        twins = tuple((right[part], left[part]) for part in left)
    else:
        pictures, drawn = [], like.group.paths[: len(middle) + len(left)]
        twins = tuple(zip(paths, (*drawn, *drawn[len(middle) :]), strict=True))
    return Actor(
        commands=(*pictures, *mirrored, *placements),
        chain=chain,
        arrays={f"{name}_q": arms, f"{name}_base": trunk},
        group=Group("Wearer", paths),
        twins=twins,
    )


def upper_body(body: Body, hips: Array, base: Array) -> tuple[Array, Array]:
    """Arms and trunk of the person on a moving pelvis (illustration).

    Args:
        body: Sizes.
        hips: `(n, 2)` left and right hip flexion from its mean [rad].
        base: `(n, 4, 4)` pose of the pelvis.

    Returns:
        Shoulder and elbow of both sides `(n, 4)` [rad], and the trunk's pose `(n, 7)`.
    """
    return _swing(hips), _trunk(base, _size(body))


def _size(body: Body) -> float:
    """How large the upper body is, beside the figure's."""
    return (body.stature - body.leg_length) / _HEAD


def _limbs(links: Mapping[str, str], root: str, side: Side) -> dict[str, str]:
    """Part of a limb -> its node."""
    arm = f"{root}/{side}_upper_arm/turn"
    return {
        "thigh": f"{links[f'{side}_thigh']}/wearer",
        "shank": f"{links[f'{side}_shank']}/wearer",
        "foot": f"{links[f'{side}_sole_plate']}/wearer",
        "upper_arm": f"{arm}/look",
        "forearm": f"{arm}/{side}_forearm/turn/look",
    }


def _picture(path: str, solid: Solid) -> Command:
    return translucent(path, mesh(solid.vertices, solid.faces, solid.normals), _SKIN)


def _middle(size: float, girth: float) -> dict[str, Solid]:
    """Pelvis, and trunk with head; scales and offsets are those of the figure's URDF."""
    x, y, z = _LUMBAR - np.array([0.0, 0.0, 0.05])
    torso = part("torso", (0.005783, 0.005783, 0.009093), (0, 0, 0.223 - 0.3596))
    trunk = [
        scaled(part("abdomen", (0.0074,) * 3), (girth, girth, 1)),
        scaled(torso, (girth, girth**0.5, 1)),  # between the shoulders there is more bone
        part("head", (0.0056,) * 3, (0, 0, 0.473)),
        sphere(0.046).placed(translation(0, 0, 0.473)),
    ]
    pelvis = part("pelvis", (0.00643, 0.0059, 0.0059), (float(x), float(y), float(z)))
    return {
        "pelvis": scaled(pelvis, (size * girth, size * girth, size)),
        "trunk": scaled(solids.joined(trunk), (size,) * 3),
    }


def _limb_shapes(body: Body, size: float) -> dict[str, Solid]:
    """The left limbs, as long as the body's."""
    leg, wide = body.leg("left"), size * body.girth
    shank = solids.joined([part("lowerleg", (0.0063, 0.007, 0.0066)), sphere(0.035)])
    arm = solids.joined([part("upperarm", (0.0063, 0.0069, 0.006), (0, 0, 0.05)), sphere(0.052)])
    hand = part("hand", (0.0061,) * 3, (0, 0, -0.287))
    forearm = solids.joined([part("lowerarm", (0.0064,) * 3), sphere(0.034), hand])
    return {
        "thigh": scaled(
            part("upperleg", (0.0062, 0.0069, 0.0064), (0, 0, -0.05)), (wide, wide, leg.thigh / _THIGH)
        ),
        "shank": scaled(shank, (wide, wide, leg.shank / _SHANK)),
        "foot": _foot(leg),
        "upper_arm": scaled(arm, (wide, wide, size)),
        "forearm": scaled(forearm, (size,) * 3),
    }


def _foot(leg: Leg) -> Solid:
    """The foot, stretched between heel, toes and plate."""
    foot = part("foot", (0.0067,) * 3)
    low, high = foot.vertices.min(axis=0), foot.vertices.max(axis=0)
    wide = 0.92 * leg.foot_width / float(high[1] - low[1])
    long = leg.foot_length / float(high[0] - low[0])
    moved = scaled(foot, (long, wide, (leg.ankle_height - _PLATE) / -float(low[2])))
    return moved.placed(translation(-leg.heel - float(moved.vertices[:, 0].min()), 0, 0))


def _mirrored(body: Body, name: str) -> Array:
    """What turns a left part into a right one: mirrored, and stretched to the right leg's own sizes."""
    left, right = body.legs
    along = {
        "thigh": (1, 1, right.thigh / left.thigh),
        "shank": (1, 1, right.shank / left.shank),
        "foot": (
            right.foot_length / left.foot_length,
            right.foot_width / left.foot_width,
            (right.ankle_height - _PLATE) / (left.ankle_height - _PLATE),
        ),
    }.get(name, (1, 1, 1))
    return np.diag([*np.array(along) * (1, -1, 1), 1.0])


def _arms(root: str, size: float, girth: float) -> tuple[Chain, list[Command]]:
    """The upper body's chain: two shoulders and two elbows that flex."""
    joints, links, commands = [], {"trunk": root}, []
    for side, s in zip(SIDES, (1, -1), strict=True):
        upper, fore = f"{root}/{side}_upper_arm", f"{root}/{side}_upper_arm/turn/{side}_forearm"
        hang = translation(*(size * _SHOULDER * (1, s * girth**0.5, 1)))
        hang[:3, :3] = pin.rpy.rpyToMatrix(s * girth * _SPREAD, 0.0, 0.0)
        commands += [place(upper, hang), place(fore, translation(0, 0, -size * _UPPER_ARM))]
        for name, path in ((f"{side}_shoulder", upper), (f"{side}_elbow", fore)):
            joints.append(JointNode(name, f"{path}/turn", (0.0, -1.0, 0.0), "revolute"))
            links[name] = f"{path}/turn"
    name = root.rpartition("/")[2]
    return Chain(name, root, links, tuple(joints), f"{name}_q", f"{name}_base"), commands


def _swing(hips: Array) -> Array:
    """`(n, 4)` shoulder and elbow of both sides: with the opposite hip, about half as far (illustration)."""
    columns = []
    for swing in reversed(hips.T):
        columns += [0.55 * swing - 0.05, 0.40 + 0.25 * swing]
    return np.stack(columns, axis=1)


def _trunk(base: Array, size: float) -> Array:
    """`(n, 7)` pose of the trunk: on the pelvis, with a fifth of its roll and tilt."""
    trunk = base.copy()
    for T in trunk:
        T[:3, 3] += size * T[:3, :3] @ _LUMBAR
        roll, pitch, yaw = pin.rpy.matrixToRpy(T[:3, :3])
        T[:3, :3] = pin.rpy.rpyToMatrix(0.2 * roll, 0.2 * pitch, yaw)
    return flat_poses(trunk)
