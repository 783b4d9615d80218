"""The files of one command: each is read once, and each marker trial is solved once."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.anatomy.names import LengthUnit, Sex

if TYPE_CHECKING:
    from exo_pin.anatomy.person import Person
    from exo_pin.formats import Content, TrialFile
    from exo_pin.markers import Reconstruction


class OpenedFiles:
    """Trial files by path; a command has one in its arguments.

    Attributes:
        length_unit: Of the points of marker trials, as the user states it; None: as the file does. Forces and
            torques beside a trial keep their own.
    """

    def __init__(self) -> None:
        self.length_unit: LengthUnit | None = None
        self._files: dict[Path, TrialFile] = {}
        self._walks: dict[tuple[object, ...], Reconstruction] = {}
        self._person: Person | None = None

    def open(self, path: str | Path, content: Content | None = None) -> TrialFile:
        """The content of a file, read at the first call; arguments and errors as of `formats.open_trial`."""
        from exo_pin.formats import open_trial

        path = Path(path)
        if path not in self._files:
            file = open_trial(path, content)
            beside = content in ("forces", "torques") and not file.takes_length_unit
            self._files[path] = (
                file.with_length_unit(self.length_unit) if self.length_unit and not beside else file
            )
        return self._files[path]

    def person(self, known: Callable[[], Person]) -> Person:
        """The person of the command's trial, found out at the first call."""
        if self._person is None:
            self._person = known()
        return self._person

    def reconstruct(
        self,
        path: str | Path,
        *,
        static: str | None = None,
        markers: str | None = None,
        model: str | None = None,
        mapping: tuple[tuple[str, str], ...] = (),
        mass: float | None = None,
        sex: Sex = "male",
    ) -> Reconstruction:
        """The walk of a marker trial.

        Args:
            path: The trial.
            static: File of a standing trial.
            markers: Name or file of the marker set; None: the best match.
            model: The OpenSim model that the trial's person was scaled to.
            mapping: Pairs of a marker's own name and its name in the set.
            mass: Of the person [kg]; None: by stature.
            sex: Whose segment masses.

        Raises:
            FormatError: A file cannot be read, or its markers make no walk.
            UnknownNameError: There is no such marker set, or no marker of a mapped name.
        """
        from exo_pin.markers import load_walk

        key = (Path(path), static, markers, model, mapping, mass, sex)
        if key not in self._walks:
            self._walks[key] = load_walk(
                self.open(path, "markers"),
                static=None if static is None else self.open(static, "markers"),
                markers=markers,
                model=model,
                mapping=dict(mapping),
                mass=mass,
                sex=sex,
            )
        return self._walks[key]
