"""The scene of a simulated walk: the run, beside the walk that it was to follow or beside a second run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from exo_pin.cli import show

if TYPE_CHECKING:
    from exo_pin.simulation import Run
    from exo_pin.viewer import Scene

_RIGID = (
    "The soles are rigid: the first peak of the ground reaction is about 40 % higher than people's. "
    "Torques are those of motors at the joints, not forces at the cuffs."
)


_LONG = 6.0
"""A longer run is shown with half the samples a second, so that its page stays small [s]."""


def scene(run: Run, what: str, *, other: Run | None = None) -> Scene:
    """The run with its forces beside a ghost; beside a second run the walk to follow is dashed.

    Args:
        run: What was simulated.
        what: The walk and the device, in words.
        other: A second run as the ghost; None: the walk that was to be followed.

    Raises:
        GaitError: A run ended at once.
    """
    from exo_pin import simulation, viewer
    from exo_pin.simulation.run_gaits import RATE

    rate = RATE if run.time[-1] <= _LONG else RATE / 2
    walk, plan = simulation.walked(run, rate=rate), simulation.wanted(run, rate=rate)
    options = viewer.SceneOptions(
        title=f"{what}, simulated: {run.verdict.word} - exo_pin",
        support="still",  # the simulated pelvis is shown where it was
        compare=plan if other is None else simulation.walked(other, rate=rate),
        compare_title="the walk to follow" if other is None else f"{_name(other)}: {other.verdict.word}",
        beside=other is not None,
        notes=(*_notes(run), *(() if other is None else _notes(other)), _RIGID),
    )
    return viewer.exoskeleton_scene(
        run.robot,
        walk,
        options,
        reference=None if other is None else plan,  # else the ghost's curves are the same
        reference_title="the walk to follow",
        kinetics=viewer.Kinetics.of_run(run, rate),
    )


def _name(run: Run) -> str:
    patient = "no patient" if run.patient is None else run.patient.name
    return show.plain(f"{run.controller}, {patient}")


def _notes(run: Run) -> tuple[str, ...]:
    return (f"{_name(run)}: {run.verdict.word}: {run.verdict.why}.",)
