"""The reader interface: a trial file, read once, and the records that its content is turned into."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from exo_pin.anatomy.names import LengthUnit, SignPreset
from exo_pin.anatomy.person import Person
from exo_pin.errors import FormatError
from exo_pin.formats.read_options import ReadOptions
from exo_pin.gait import Gait
from exo_pin.gait.further_angles import FurtherAngles
from exo_pin.gait.torques import Torques
from exo_pin.gait.trial import ForcePlate, Markers
from exo_pin.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class TrialFile:
    """The content of one file, in memory; no method reads the file again.

    A format is a subclass with its content as fields. It overrides the methods for what its files can hold;
    the others refuse.

    Attributes:
        path: The file, for messages and sources.
    """

    path: Path

    __repr__ = short_repr

    @property
    def needs_inverse_kinematics(self) -> bool:
        """Whether the file holds markers and no joint angles: `exo_pin.markers.load_walk` makes its walk."""
        return False

    @property
    def takes_length_unit(self) -> bool:
        """Whether the user may state the unit of its lengths; formats in metres leave no choice."""
        return False

    def with_length_unit(self, unit: LengthUnit) -> TrialFile:
        """The same content, its lengths in a unit that the user states.

        Raises:
            FormatError: The format leaves no choice.
        """
        why = f"a unit of length ({unit}) is for marker trials (.c3d, .trc); this file is in metres"
        raise FormatError(self.path, why)

    def gait(self, options: ReadOptions) -> Gait:
        """The walk by its joint angles.

        Raises:
            FormatError: There are none, or they are unusable; with reason and, in texts, line.
            UnknownNameError: An option names no preset, joint, unit or order.
        """
        raise FormatError(self.path, "holds no joint angles")

    def markers(self) -> Markers:
        """The marker trial, with events and force plates where the file has them.

        Raises:
            FormatError: There are no markers, or they are unusable.
        """
        raise FormatError(self.path, "holds no markers")

    def person(self, model: Path | None = None) -> Person:
        """What the file says of the person's body; nothing for most formats.

        Args:
            model: The OpenSim model (.osim) that the file belongs to.

        Raises:
            FormatError: The model cannot be read.
        """
        return Person()

    def further_angles(self) -> FurtherAngles | None:
        """Angles beside the 12 joints (pelvis, foot progression ...) by a model in the file, or None."""
        return None

    def session(self) -> dict[str, str]:
        """Who was recorded, where and when, in the file's words; what it does not state is left out."""
        return {}

    def torques(self, preset: SignPreset | None = None, mass: float | None = None) -> Torques:
        """Joint torques.

        Args:
            preset: Sign convention of the model they were computed with.
            mass: Of the person [kg], for moments per kg; None: as the file has it.

        Raises:
            FormatError: There are none, or their signs or scale are not known.
            UnknownNameError: There is no such preset.
        """
        raise FormatError(self.path, "holds no joint torques")

    def force_plates(self) -> tuple[ForcePlate, ...]:
        """Ground reaction forces, by plate.

        Raises:
            FormatError: There are none.
        """
        raise FormatError(self.path, "holds no ground reaction forces")
