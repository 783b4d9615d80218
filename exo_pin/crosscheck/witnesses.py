"""Forward kinematics four ways: the independent models of `dh` and yourdfpy against Pinocchio."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Callable, Sequence
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from exo_pin import dh
from exo_pin.anatomy import FEET, JOINTS
from exo_pin.arguments import names, real, word
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.kinematics import poses
from exo_pin.robot import Robot

FK_TOLERANCE = 1e-12
"""Largest difference between two ways of forward kinematics [m, and of a rotation matrix's entries]."""

_SAMPLES = 200
"""Configurations that yourdfpy computes: it takes a millisecond for each."""

_GRID = 6
"""Decimals of the angles given to yourdfpy: its scene graph ignores rotations, and changes of them, below
1e-8 rad."""


Witness = Literal["recursion", "dh", "yourdfpy"]


def forward(
    robot: Robot, q: npt.ArrayLike, *, witnesses: Sequence[Witness] = get_args(Witness)
) -> dict[str, float]:
    """Largest difference to Pinocchio of each witness: positions [m] and rotation matrices' entries.

    Args:
        robot: A robot made from a `Body`.
        q: Configurations (n, nq) [rad]; at most 200 of them, evenly chosen and rounded to
            a microradian, are given to yourdfpy.
        witnesses: Those that are asked; yourdfpy alone takes a second.

    Returns:
        `recursion`, `dh` and, where it is installed, `yourdfpy`: over every joint's link, locked joints
        too, and both feet.

    Raises:
        UnknownNameError: There is no such witness.
        DescriptionError: The robot is not an exoskeleton of this package, the shape of q does not fit, or a
            number is not finite.
    """
    if robot.body is None or robot.base != "fixed":
        raise DescriptionError("the witness needs a robot that load_robot made with a fixed base")
    q = real("q", q, ("n", robot.nq))
    if not len(q):
        raise DescriptionError("q holds no configuration")
    wanted = [word("witness", name, get_args(Witness)) for name in names("witnesses", witnesses)]
    few = q[np.unique(np.linspace(0, len(q) - 1, _SAMPLES).astype(int))]
    body, order = robot.body, robot.hip_order

    def by(witness: Callable[..., dict[str, Array]], q: Array) -> dict[str, Array]:
        angles = dict(zip(robot.joints, robot.angles(q).T, strict=True))
        return dh.of_device(body, angles, hip_order=order, witness=witness)

    known: dict[str, tuple[Array, Callable[[Array], dict[str, Array]]]] = {
        "recursion": (q, lambda q: by(dh.recursion, q)),
        "dh": (q, lambda q: by(dh.modified_dh, q)),
        "yourdfpy": (np.round(few, _GRID), lambda q: _by_scene(robot, q)),
    }
    found = {}
    for name in wanted:
        samples, witness = known[name]
        with contextlib.suppress(ModuleNotFoundError):  # yourdfpy is optional
            found[name] = _difference(robot, samples, witness(samples))
    return found


def _difference(robot: Robot, q: Array, poses_of: dict[str, Array]) -> float:
    """Largest difference in any entry of any pose relative to the pelvis (or to the stand of its slides)."""
    links = tuple(poses_of)
    ours = poses(robot, q, links, base=np.eye(4))
    return float(max(np.abs(poses_of[link] - ours[:, k]).max() for k, link in enumerate(links)))


def _by_scene(robot: Robot, q: Array) -> dict[str, Array]:
    """Poses by yourdfpy, an independent reader of the same URDF."""
    import yourdfpy  # 0.5 s, needed here only

    scene = yourdfpy.URDF.load(io.BytesIO(robot.urdf.encode()), load_meshes=False)
    links = {joint: scene.joint_map[joint].child for joint in (*robot.joints, *JOINTS)}
    links |= {foot: foot for foot in FEET}
    out = {name: np.empty((len(q), 4, 4)) for name in links}
    for k, row in enumerate(q):
        scene.update_cfg(dict(zip(robot.joints, row, strict=True)))
        for name, link in links.items():
            out[name][k] = scene.get_transform(link, scene.base_link)
    return out
