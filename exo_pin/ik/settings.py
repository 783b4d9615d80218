"""Settings: one frozen object selects the solver and holds its tolerances, weights and number of steps."""

from __future__ import annotations

from dataclasses import dataclass, field

from exo_pin.arguments import count, number

_MOST_STEPS = 1_000_000
"""Of an iteration, and of its further seeds: beyond, a number is a slip."""


@dataclass(frozen=True, kw_only=True)
class Dls:
    """Damped least squares, joint limits kept as constraints of every step.

    Attributes:
        tolerance: A frame has converged when every position error [m] and rotation error [rad] is below it.
        max_iterations: Steps for one frame from one start.
        restarts: Further seeds for a frame that got stuck; they are used only where they reach the target,
            so that a frame out of reach stays near its neighbour.
        warm_start: True: each frame starts from the answer of the one before, and where a subtree has too few
            joints for its targets, none of them jumps (docs/ik.md); False: each frame starts from the
            seed, independent of its neighbours.
        damping: Weight of a motion away from the sample before [m/rad]: the noise of the feet [m] divided by
            how far a joint moves between two samples [rad]. 0 for exact targets; 0.05 keeps the joints calm
            when feet with 3 mm of noise pull a nearly straight leg at 100 Hz, and hardly delays a bent one.
        position_weight: Weight of a position error [1/m] against the others.
        rotation_weight: Weight of a rotation error [1/rad] against the others.
    """

    tolerance: float = 1e-9
    max_iterations: int = 200
    restarts: int = 8
    warm_start: bool = True
    damping: float = 0.0
    position_weight: float = 1.0
    rotation_weight: float = 1.0

    def __post_init__(self) -> None:
        number("Dls.tolerance", self.tolerance, above=0.0)
        count("Dls.max_iterations", self.max_iterations, 1, _MOST_STEPS)
        number("Dls.position_weight", self.position_weight, above=0.0)
        number("Dls.rotation_weight", self.rotation_weight, above=0.0)
        count("Dls.restarts", self.restarts, 0, _MOST_STEPS)
        number("Dls.damping", self.damping, least=0.0)


@dataclass(frozen=True, kw_only=True)
class Auto:
    """The closed form where a leg has one, every answer checked, and damped least squares for the rest.

    Attributes:
        tolerance: A frame has converged when every position error [m] and rotation error [rad] is below it.
        dls: For what the closed form cannot answer; its tolerance is replaced by this one, and its damping
            has no effect on legs: there no sample waits for the one before.
    """

    tolerance: float = 1e-9
    dls: Dls = field(default_factory=Dls)

    def __post_init__(self) -> None:
        number("Auto.tolerance", self.tolerance, above=0.0)


@dataclass(frozen=True, kw_only=True)
class ClosedForm:
    """The closed form alone, checked; a target out of reach gets a straight leg and is flagged.

    Attributes:
        tolerance: A frame has converged when every position error [m] and rotation error [rad] is below it.
    """

    tolerance: float = 1e-9

    def __post_init__(self) -> None:
        number("ClosedForm.tolerance", self.tolerance, above=0.0)


Settings = Auto | ClosedForm | Dls
