"""A robot and a gait as a scene, or as a view that shows itself in a notebook."""

from __future__ import annotations

import html as markup
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from exo_pin.anatomy import FEET
from exo_pin.anatomy.names import SupportStyle
from exo_pin.arguments import count
from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait, Torques, normative_gait
from exo_pin.retarget import Retargeted, retarget
from exo_pin.robot import Robot, load_robot
from exo_pin.short_repr import short_repr
from exo_pin.viewer.page.packing import html
from exo_pin.viewer.scenes.compiler import exoskeleton_scene, robot_scene
from exo_pin.viewer.scenes.kinetics import Kinetics
from exo_pin.viewer.scenes.scene import Scene
from exo_pin.viewer.scenes.staging import SceneOptions

_TALLEST = 100_000  # pixels of a frame
_LEFT_OUT = "Reference curves and torques belong to the exoskeleton; they are not shown on another robot."


def scene(
    robot: Robot,
    gait: Gait,
    *,
    reference: Gait | None = None,
    reference_title: str = "source",
    compare: Gait | None = None,
    compare_title: str = "compared",
    torques: Torques | None = None,
    kinetics: Kinetics | None = None,
    title: str = "12-DoF exoskeleton gait",
    support: SupportStyle = "carried",
    wearer: bool = True,
    notes: Iterable[str] = (),
    speed: float = 1.0,
) -> Scene:
    """Everything that the viewer shows of a walk, as one value.

    A robot with the frames of `FEET` is an exoskeleton and walks the gait as it is (`exoskeleton_scene`). To
    any other robot with two legs (from `load_urdf`) the gait of the default body is retargeted first
    (`robot_scene`); it has no reference curves, torques and wearer, and a note says so where they were given.
    For another body, retarget the gait and show it with `retargeted`.

    Args:
        robot: The exoskeleton, or any robot with two legs.
        gait: The motion to show, e.g. what inverse kinematics recovered.
        reference: Curves to draw dashed beside it, e.g. the source's.
        reference_title: What the dashed curves are.
        compare: A second walk, shown as a ghost, its curves dotted.
        compare_title: What the ghost is.
        torques: Joint torques on the walk's clock, for a further tab of plots.
        kinetics: Forces, torques and powers on the walk's clock, e.g. `Kinetics.of_dynamics(torques(...))`:
            arrows, arcs and more tabs.
        title: Heading of the page.
        support: `"carried"`: the balance support moves the pelvis so that the standing foot stays on the
            ground; `"still"`: it holds the pelvis as in the paper.
        wearer: Whether to draw the person, if the robot was made for one.
        notes: Sentences to print under the plots.
        speed: Playback speed at first; 1 is as it happened.

    Raises:
        UnknownNameError: The robot lacks a joint or frame of a walker, or there is no such support.
        GaitError: The torques belong to another time.
        DescriptionError: Another robot has no two legs.
        ExoPinError: The wearer's figure is not installed.
    """
    is_exoskeleton = set(FEET) <= set(robot.frames)
    own = not (reference is None and torques is None and kinetics is None)
    left_out = (_LEFT_OUT,) if own and not is_exoskeleton else ()
    options = SceneOptions(title, support, compare, compare_title, (*notes, *left_out), speed)
    if not is_exoskeleton:
        return robot_scene(retarget(gait, robot), options)
    return exoskeleton_scene(
        robot,
        gait,
        options,
        reference=reference,
        reference_title=reference_title,
        torques=torques,
        kinetics=kinetics,
        wearer=wearer,
    )


def retargeted(
    walk: Retargeted,
    *,
    compare: Gait | None = None,
    compare_title: str = "compared",
    title: str = "",
    support: SupportStyle = "carried",
    notes: Iterable[str] = (),
    speed: float = 1.0,
) -> Scene:
    """Everything that the viewer shows of a walk on another robot (see `robot_scene`).

    Args:
        walk: The retargeted walk.
        compare: A second walk of a person, retargeted too and shown as a ghost, its curves dotted.
        compare_title: What the ghost is.
        title: Heading of the page; the robot's own if empty.
        support: `"carried"` or `"still"`, as in `scene`.
        notes: Sentences to print under the plots.
        speed: Playback speed at first; 1 is as it happened.

    Raises:
        UnknownNameError: There is no such support.
    """
    return robot_scene(walk, SceneOptions(title, support, compare, compare_title, tuple(notes), speed))


@dataclass(frozen=True, eq=False)
class View:
    """A walk that shows itself in a notebook.

    Attributes:
        page: The offline page.
        height: Of the frame [px].
    """

    page: str
    height: int

    __repr__ = short_repr

    def save(self, path: str | Path) -> None:
        """Write the page to a file that any browser opens."""
        Path(path).write_text(self.page, "utf-8")

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{markup.escape(self.page)}" sandbox="allow-scripts allow-downloads" '
            f'style="width:100%;height:{self.height}px;border:0" title="exo_pin"></iframe>'
        )


def view(robot: Robot | Gait, gait: Gait | None = None, *, height: int = 640, **options: Any) -> View:
    """Look at a walk in a notebook.

    Args:
        robot: The exoskeleton, or any robot with two legs from `load_urdf`; a gait alone walks on the
            exoskeleton of the average body.
        gait: The walk; the normal one if left out.
        height: Of the frame [px].
        **options: Further options of `viewer.scene`, e.g. `reference=` or `torques=`.

    Raises:
        DescriptionError: The height is no whole number of pixels from 1 to 100 000, or two gaits are given.
        ExoPinError: As in `scene`.
    """
    height = count("height", height, 1, _TALLEST)
    if isinstance(robot, Gait):
        if gait is not None:
            raise DescriptionError("view takes one gait, or a robot and a gait")
        return View(html(scene(load_robot(), robot, **options)), height)
    return View(html(scene(robot, normative_gait() if gait is None else gait, **options)), height)
