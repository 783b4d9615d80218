"""A .mot or .sto file: joint coordinates, inverse dynamics or ground reaction forces."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from exo_pin.anatomy.names import SignPreset
from exo_pin.anatomy.person import Person
from exo_pin.formats.opensim.coordinates import coordinates_gait, knee_preset
from exo_pin.formats.opensim.external_forces import force_plates
from exo_pin.formats.opensim.inverse_dynamics import inverse_dynamics
from exo_pin.formats.opensim.osim_person import model_person
from exo_pin.formats.opensim.storage import Storage, read_storage
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.trial_file import TrialFile
from exo_pin.gait import Gait
from exo_pin.gait.torques import Torques
from exo_pin.gait.trial import ForcePlate


@dataclass(frozen=True, eq=False)
class StorageFile(TrialFile):
    """A file in OpenSim's storage format.

    Attributes:
        storage: Its header and table.
    """

    storage: Storage

    def gait(self, options: ReadOptions) -> Gait:
        """The walk by its joint coordinates; errors as in `TrialFile.gait`."""
        return coordinates_gait(self.storage, options)

    def person(self, model: Path | None = None) -> Person:
        """The person by the model's mass and joint centres; errors as in `TrialFile.person`."""
        return Person() if model is None else model_person(model)

    def torques(self, preset: SignPreset | None = None, mass: float | None = None) -> Torques:
        """Generalised forces of inverse dynamics; arguments and errors as in `TrialFile.torques`."""
        return inverse_dynamics(self.storage, preset)

    def force_plates(self) -> tuple[ForcePlate, ...]:
        """Ground reaction forces; errors as in `TrialFile.force_plates`."""
        return force_plates(self.storage)

    def preset(self, model: Path | None = None) -> SignPreset:
        """The preset whose signs its coordinates have, as `gait` finds it; `model` is the .osim file.

        Raises:
            FormatError: There are no coordinates, or the sign of the knee is not clear.
        """
        return knee_preset(self.storage, model)


def open_storage(path: Path) -> StorageFile:
    """Read a .mot or .sto file; raises `FormatError`."""
    return StorageFile(path, read_storage(path))
