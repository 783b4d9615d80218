"""The scene compiler: a robot and a gait become a `Scene`, which any transport can show."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from exo_pin.anatomy import CORNERS, FEET, SIDES
from exo_pin.gait import Gait
from exo_pin.robot import Robot
from exo_pin.viewer import curves, furniture
from exo_pin.viewer.facts import Box, Chain, Facts, Group, Marks, Scene
from exo_pin.viewer.links import Linkage, linkage
from exo_pin.viewer.motion import Motion, motion
from exo_pin.viewer.protocol import Command

Array = NDArray[np.float64]

ROOT = "/exo_pin"
"""Every node of ours hangs below this one."""

TRACE_POINTS = 400
"""A foot's path is drawn through at most this many points."""

_TOP = 0.34  # the backpack ends this far above the hips [m]


def scene(
    robot: Robot,
    gait: Gait,
    *,
    reference: Gait | None = None,
    reference_title: str = "source",
    title: str = "12-DoF exoskeleton gait",
    support: str = "carried",
    notes: Iterable[str] = (),
    speed: float = 1.0,
) -> Scene:
    """Everything that the viewer shows of a walk, as one value.

    Args:
        robot: The exoskeleton.
        gait: The motion to show, e.g. what inverse kinematics recovered.
        reference: Curves to draw dashed beside it, e.g. the source's.
        reference_title: What the dashed curves are.
        title: Heading of the page.
        support: `"carried"`: the balance support moves the pelvis so that the standing foot stays on the
            ground; `"still"`: it holds the pelvis as in the paper.
        notes: Sentences to print under the plots.
        speed: Playback speed at first; 1 is as it happened.

    Raises:
        UnknownNameError: The robot lacks a joint or frame of a walker, or there is no such support.
    """
    shown = motion(robot, gait, support)
    exo = linkage(robot.urdf, f"{ROOT}/exo")
    commands, marks = _world(robot, gait, shown, exo)
    facts = Facts(
        title=title,
        subtitle=_subtitle(gait),
        notes=tuple(dict.fromkeys((*notes, *_notes(shown, exo)))),
        duration=gait.duration,
        start=float(gait.time[0]),
        periodic=gait.periodic,
        stance=shown.stance,
        contact="contact (estimated)" if shown.estimated else "foot contact",
        reference="" if reference is None else reference_title,
        chains=(Chain("exo", exo.root, exo.links, exo.turns, "q", "base"),),
        plots=curves.groups(robot, reference=reference is not None),
        groups=_groups(marks),
        marks=marks,
        boxes=_boxes(shown),
        follow=shown.support.overground,
        speed=speed,
        shadowless=tuple(f"{ROOT}/{name}" for name in ("traces", "marks", "floor")),
        lights=furniture.PLAIN_LIGHTS,
    )
    arrays = _samples(robot, shown, exo) | curves.arrays(gait, reference)
    return Scene(facts, tuple(commands), {name: _narrow(name, rows) for name, rows in arrays.items()})


def flat_poses(T: Array) -> Array:
    """Poses `(n, 4, 4)` as `(n, 7)`: x y z [m], unit quaternion x y z w that never jumps to its negative."""
    rows = np.array([pin.SE3ToXYZQUAT(pin.SE3(pose)) for pose in T])
    turned = np.einsum("nk,nk->n", rows[1:, 3:], rows[:-1, 3:]) < 0
    rows[1:, 3:] *= np.cumprod(np.where(turned, -1.0, 1.0))[:, None]
    return rows


def _world(robot: Robot, gait: Gait, shown: Motion, exo: Linkage) -> tuple[list[Command], Marks]:
    """All drawings, and the nodes among them that the page moves."""
    commands = [*furniture.studio(), *exo.commands]
    belt, ground = None, 0.0
    if not shown.support.overground:
        mill = _treadmill(shown, gait)
        commands += furniture.treadmill(f"{ROOT}/treadmill", mill)
        belt, ground = furniture.belt(f"{ROOT}/treadmill", mill), -furniture.DECK
    commands += furniture.floor(f"{ROOT}/floor", ground, float(np.abs(shown.base[:, :2, 3]).max()) + 4.0)
    commands += furniture.centre_of_mass(f"{ROOT}/marks/com")
    contact = {}
    for k, side in enumerate(SIDES):
        contact[side] = f"{exo.links[FEET[k]]}/contact/sole"
        commands += furniture.contact_sole(contact[side], *_sole(robot, shown, side))
        path, color = _thinned(shown.feet[:, k, :3, 3]), furniture.SIDE_COLORS[side]
        commands.append(furniture.trace(f"{ROOT}/traces/{side}", path, color, closed=gait.periodic))
    return commands, Marks(f"{ROOT}/marks/com/ball", f"{ROOT}/marks/com/disc", 0.003, contact, belt)


def _treadmill(shown: Motion, gait: Gait) -> furniture.Treadmill:
    low, high = float(shown.corners[..., 0].min()), float(shown.corners[..., 0].max())
    length = max(high - low + 0.75, 1.5)
    return furniture.Treadmill((low + high) / 2 + 0.05, length, 0.0, shown.support.belt_speed, gait.duration)


def _sole(robot: Robot, shown: Motion, side: str) -> tuple[tuple[float, float], tuple[float, float, float]]:
    """Length and width of a foot's sole [m] and its middle, seen from the foot's frame."""
    mine = [k for k, name in enumerate(CORNERS) if name.startswith(side)]
    T = shown.feet[0, SIDES.index(side)]
    corners = (shown.corners[0, mine] - T[:3, 3]) @ T[:3, :3]  # in the foot's own axes
    heel, front = float(corners[:, 0].min()), float(corners[:, 0].max())
    if robot.body is not None:  # the corners end at the ball of the foot, the plate at the toes
        front = heel + robot.body.leg(side).foot_length
    return (front - heel + 0.007, float(np.ptp(corners[:, 1])) + 0.009), ((heel + front) / 2, 0.0, 0.006)


def _thinned(points: Array) -> Array:
    step = -(-len(points) // TRACE_POINTS)
    return points[::step]


def _subtitle(gait: Gait) -> str:
    kind = "cycle" if gait.periodic else "recording"
    return ", ".join(filter(None, (gait.source, f"{gait.duration:.2f} s {kind}")))


def _notes(shown: Motion, exo: Linkage) -> list[str]:
    notes = [shown.support.note]
    if shown.estimated:
        notes.append("The gait has no contact events: contact is estimated from the lowest sole corners.")
    if exo.skipped:
        notes.append(f"{exo.skipped} visuals of the URDF are meshes and are not drawn.")
    return notes


def _groups(marks: Marks) -> tuple[Group, ...]:
    soles = tuple(path.rsplit("/", 1)[0] for path in marks.contact.values())
    groups = [
        Group("Exoskeleton", (f"{ROOT}/exo",)),
        Group("Foot contact", soles),
        Group("Foot paths", (f"{ROOT}/traces",)),
        Group("Centre of mass", (f"{ROOT}/marks",)),
    ]
    return tuple(groups if marks.belt is None else [*groups, Group("Treadmill", (f"{ROOT}/treadmill",))])


def _boxes(shown: Motion) -> dict[str, Box]:
    """What the cameras frame: the whole figure, and the feet."""
    y, z = shown.base[0, 1:3, 3].tolist()
    here = shown.corners[: len(shown.corners) if not shown.support.overground else 1, :, 0]
    low, high = float(here.min()) - 0.05, float(here.max()) + 0.12
    bottom, top = (0.0 if shown.support.overground else -furniture.DECK), z + _TOP
    middle = (low + high) / 2
    return {
        "whole": Box((middle, y, (bottom + top) / 2), (high - low, 0.75, top - bottom)),
        "feet": Box((middle, y, 0.12), (high - low, 0.6, 0.4)),
    }


def _samples(robot: Robot, shown: Motion, exo: Linkage) -> dict[str, Array]:
    angles = dict(zip(robot.joints, shown.q.T, strict=True))
    still = np.zeros(len(shown.time))
    q = np.stack([angles.get(turn.name, still) for turn in exo.turns], axis=1)
    return {"time": shown.time, "q": q, "base": flat_poses(shown.base), "com": shown.com}


def _narrow(name: str, rows: Array) -> NDArray[np.floating[Any]]:
    """Times stay float64: a long recording counts milliseconds behind thousands of seconds."""
    data: NDArray[np.floating[Any]] = rows.astype(np.float64 if name.endswith("time") else np.float32)
    data.flags.writeable = False
    return data
