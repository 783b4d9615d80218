"""A robot in a user's own meshcat window: drawn once, then posed live or by a meshcat animation."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import pinocchio as pin

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.arguments import count, real, text
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait
from exo_pin.robot import Robot
from exo_pin.robot.floating_base import base_poses
from exo_pin.viewer.drawing_commands import Command, place
from exo_pin.viewer.scenes.scene import ROOT, Belt, Chain, JointNode, Scene
from exo_pin.viewer.scenes.wearer import upper_body
from exo_pin.viewer.views import scene

_FRAMES_PER_SECOND = 30.0
"""meshcat counts the times of an animation in frames; a key may lie between two of them."""

_TURNAROUND = 1e-6
"""The belt's slats go back by their distance within this time [s]: too short for a picture."""

_MOST_REPETITIONS = 1_000_000

Track = tuple[str, str, Array, Array]
"""Of a node: property, its type as three.js names it, times `(n,)` [s], values `(n, k)`."""


def draw(
    vis: Any,
    robot: Robot,
    gait: Gait | None = None,
    *,
    path: str = "exo",
    wearer: bool = True,
    belt: bool = False,
    traces: bool = False,
) -> MeshcatRobot:
    """Draw a robot into a window of the meshcat package, as it stands or at the first sample of a walk.

    Several robots stand side by side below paths of their own: `vis[path].set_transform(T)` moves one.

    Args:
        vis: The user's `meshcat.Visualizer`, or a part of it, e.g. `vis["lab"]`.
        robot: The exoskeleton, or any robot with two legs, onto which a walk is retargeted.
        gait: The walk for `animate`; None: the robot stands.
        path: Node below `vis` that holds all drawings; what was there is replaced.
        wearer: Whether to draw the person, if the robot was made for one and the figure is installed.
        belt: Whether to draw the treadmill of a walk on the spot.
        traces: Whether to draw the paths of the feet.

    Raises:
        DescriptionError: `vis` is no window of meshcat, the path is empty, or belt or traces have no walk.
        ExoPinError: As in `viewer.scene`.
    """
    if not hasattr(getattr(vis, "window", None), "send") or not hasattr(vis, "path"):
        raise DescriptionError(f"vis is a {type(vis).__name__}; a meshcat.Visualizer is accepted")
    if not text("path", path).strip("/"):
        raise DescriptionError("path is empty; the name of a node is accepted")
    if gait is None and (belt or traces):
        raise DescriptionError("a treadmill and paths of feet are those of a walk: give a gait")
    node = vis[path.strip("/")]
    shown = scene(robot, _standing() if gait is None else gait, wearer=wearer)
    chains, mill = shown.facts.chains, shown.facts.marks.belt if belt else None
    base = base_poses(shown.arrays[chains[0].base][:1].astype(float))[0]
    drawn = MeshcatRobot(node, robot, gait, wearer, chains, mill, base)
    node.delete()
    kept = [chain.root for chain in drawn.chains]
    kept += [f"{ROOT}/treadmill"] * belt + [f"{ROOT}/traces"] * traces
    drawn.send(command for command in _drawings(shown) if _below(command["path"], kept))
    drawn.send(_poses(shown))
    return drawn


@dataclass(eq=False)
class MeshcatRobot:
    """A robot in a meshcat window.

    Attributes:
        vis: The part of the window below which it hangs.
        robot: The robot.
        gait: The walk that it was drawn with, or None.
        wearer: Whether its person was wanted.
        chains: The robot's nodes, and its person's.
        belt: The treadmill's slats, if they are drawn.
        base: Where the last pose had the robot's root `(4, 4)`.
    """

    vis: Any
    robot: Robot
    gait: Gait | None
    wearer: bool
    chains: tuple[Chain, ...]
    belt: Belt | None
    base: Array

    def set(self, q: npt.ArrayLike, base: npt.ArrayLike | None = None) -> None:
        """Show a pose at once.

        Args:
            q: Joint values `(J,)` in the order of `robot.joints` [rad, m].
            base: T_world_pelvis `(4, 4)` as in `kinematics.poses`; None: where the last pose had it.

        Raises:
            DescriptionError: A shape does not fit, or a number is not finite.
        """
        values = real("q", q, (len(self.robot.joints),))
        if base is not None:
            self.base = real("base", base, (4, 4))
        angles = dict(zip(self.robot.joints, values.tolist(), strict=True))
        self.send(_pose(self.chains[0], angles, self.base))
        for person in self.chains[1:]:
            self.send(self._person(person, angles))

    def animate(
        self, gait: Gait | None = None, *, into: Any = None, play: bool = True, repetitions: int = 1
    ) -> Any:
        """Hand a walk to the window as a meshcat animation, with its play bar.

        A window has one animation: for several robots, hand the one that this method returns to the next
        robot's call as `into`.

        Args:
            gait: The walk; None: the one that the robot was drawn with.
            into: A `meshcat.animation.Animation` to which this walk is added; None: a new one.
            play: Whether it starts at once.
            repetitions: How often it is played.

        Returns:
            The `meshcat.animation.Animation`.

        Raises:
            DescriptionError: There is no walk, or repetitions is no whole number from 1 on.
            ExoPinError: As in `viewer.scene`.
        """
        from meshcat.animation import Animation, AnimationClip, AnimationTrack

        repetitions = count("repetitions", repetitions, 1, _MOST_REPETITIONS)
        gait = self.gait if gait is None else gait
        if gait is None:
            raise DescriptionError("the robot was drawn without a walk: give a gait")
        animation = Animation() if into is None else into
        for path, tracks in self._tracks(scene(self.robot, gait, wearer=self.wearer)).items():
            clip = AnimationClip(fps=_FRAMES_PER_SECOND)
            for name, kind, times, values in tracks:
                frames = (times * _FRAMES_PER_SECOND).tolist()
                clip.tracks[name] = AnimationTrack(name, kind, frames, values.tolist())
            animation.clips[self.vis[path.removeprefix(f"{ROOT}/")].path] = clip
        self.vis.set_animation(animation, play=play, repetitions=repetitions)
        return animation

    def send(self, commands: Iterable[Command]) -> None:
        """Send drawing commands, whose paths are those of a scene, to this part of the window.

        Args:
            commands: As in `Scene.commands`.
        """
        root = self.vis.path.lower()
        for command in commands:
            self.vis.window.send(_Sent(command | {"path": root + command["path"].removeprefix(ROOT)}))

    def _person(self, person: Chain, angles: Mapping[str, float]) -> Iterator[Command]:
        """The person's trunk and arms on the pelvis."""
        body = self.robot.body
        if body is not None:
            hips = np.array([[angles.get(f"{side}_hip_flexion", 0.0) for side in SIDES]])
            arms, trunk = upper_body(body, hips, self.base[None])
            names = [joint.name for joint in person.joints]
            yield from _pose(person, dict(zip(names, arms[0].tolist(), strict=True)), base_poses(trunk)[0])

    def _tracks(self, shown: Scene) -> dict[str, list[Track]]:
        """Path of a node -> how it moves."""
        arrays = shown.arrays
        time = arrays["time"].astype(float) - float(arrays["time"][0])
        closing = shown.facts.duration if shown.facts.periodic else None
        tracks: dict[str, list[Track]] = {}
        for chain in self.chains:
            base, q = arrays[chain.base].astype(float), arrays[chain.q].astype(float)
            tracks[chain.root] = [
                _track("position", "vector3", time, base[:, :3], closing),
                _track("quaternion", "quaternion", time, base[:, 3:], closing),
            ]
            for joint, values in zip(chain.joints, q.T, strict=True):
                tracks[joint.path] = [_joint_track(joint, time, values, closing)]
        if self.belt is not None and shown.facts.marks.belt is not None:
            slats = _slats(shown.facts.marks.belt, shown.facts.duration)
            tracks |= {path: [slats] for path in self.belt.paths}
        return tracks


@dataclass(frozen=True, eq=False)
class _Sent:
    """A command as meshcat's window takes it."""

    command: Command

    def lower(self) -> Command:
        """The command in meshcat's protocol."""
        return self.command


def _standing() -> Gait:
    """Straight legs; a gait has two samples or more."""
    return Gait(np.array([0.0, 1.0]), np.zeros((2, len(JOINTS))))


def _below(path: str, roots: Iterable[str]) -> bool:
    return any(path == root or path.startswith(f"{root}/") for root in roots)


def _drawings(shown: Scene) -> Iterator[Command]:
    """All drawings of a scene without the green soles; nodes that show the same as another among them."""
    soles = [path.rsplit("/", 1)[0] for path in shown.facts.marks.contact.values()]
    objects = {command["path"]: command for command in shown.commands if command["type"] == "set_object"}
    yield from (command for command in shown.commands if not _below(command["path"], soles))
    for path, source in shown.facts.twins:
        yield objects[source] | {"path": path}


def _poses(shown: Scene) -> Iterator[Command]:
    """The first sample of all chains."""
    for chain in shown.facts.chains:
        names = [joint.name for joint in chain.joints]
        q = dict(zip(names, shown.arrays[chain.q][0].tolist(), strict=True))
        yield from _pose(chain, q, base_poses(shown.arrays[chain.base][:1].astype(float))[0])


def _pose(chain: Chain, q: Mapping[str, float], T: Array) -> Iterator[Command]:
    """The commands that pose a chain; a joint without a value is at zero."""
    yield place(chain.root, T)
    for joint in chain.joints:
        yield place(joint.path, _turned(joint, q.get(joint.name, 0.0)))


def _turned(joint: JointNode, value: float) -> Array:
    """Pose (4, 4) of a joint's node."""
    T, axis = np.eye(4), np.array(joint.axis)
    if joint.kind == "prismatic":
        T[:3, 3] = value * axis
    else:
        T[:3, :3] = pin.AngleAxis(value, axis).toRotationMatrix()
    return T


def _joint_track(joint: JointNode, time: Array, values: Array, closing: float | None) -> Track:
    """How the node of a joint moves."""
    axis = np.array(joint.axis)
    if joint.kind == "prismatic":
        return _track("position", "vector3", time, values[:, None] * axis, closing)
    half = values[:, None] / 2
    return _track("quaternion", "quaternion", time, np.hstack([np.sin(half) * axis, np.cos(half)]), closing)


def _track(name: str, kind: str, time: Array, values: Array, closing: float | None) -> Track:
    """Keys at the samples; those of a periodic walk lead back to the first sample."""
    if closing is None:
        return name, kind, time, values
    return name, kind, np.append(time, closing), np.vstack([values, values[:1]])


def _slats(belt: Belt, duration: float) -> Track:
    """Slats move back by one pitch and start again, which looks like a belt."""
    period = belt.pitch / belt.speed if belt.speed > 0.0 else np.inf
    starts = np.arange(0.0, duration, period) if period < np.inf else np.zeros(1)
    ends = np.minimum(starts + period - _TURNAROUND, duration)
    times = np.column_stack([starts, ends]).ravel()
    moved = np.column_stack([0.0 * starts, -belt.speed * (ends - starts)]).ravel()
    return "position", "vector3", times, np.column_stack([moved, 0.0 * moved, 0.0 * moved])
