"""Inverse kinematics of a marker trial: scale a body, calibrate the marker places, solve every frame."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple, get_args

import numpy as np

from exo_pin import signals
from exo_pin.anatomy import Body
from exo_pin.anatomy.names import Sex, Vertical
from exo_pin.arguments import number, word
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, GaitError
from exo_pin.formats import Markers, TrialFile, load_markers
from exo_pin.gait import Gait
from exo_pin.gait.trial import UP_AXES, to_z_up, vertical_along
from exo_pin.markers.body_scale import first_sizes
from exo_pin.markers.calibration import CalibratedBody, calibrated, some_frames
from exo_pin.markers.marker_fit import fit_poses
from exo_pin.markers.marker_noise import calmed
from exo_pin.markers.marker_places import MarkerPlaces
from exo_pin.markers.marker_sets import find_set
from exo_pin.markers.model_fit import model_body
from exo_pin.markers.model_set import model_set
from exo_pin.markers.person_sizes import body_of, check_lengths
from exo_pin.markers.recognition import Recognised, fewest_on, recognise
from exo_pin.markers.spots import MarkerSet
from exo_pin.markers.trial_doubts import misfit_doubts, range_doubts, side_doubts
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class Reconstruction:
    """A walk made of markers.

    Attributes:
        gait: The walk, its base in the world with z up.
        body: The body that was scaled to the markers.
        marker_set: Name of the set.
        names: The k markers that were used, by the set's names.
        error: `(n, k)` distance of each marker from its place on the body [m]; NaN where it was not seen.
        filled: Coordinates that were filled in short gaps.
        doubts: Reasons to doubt that the markers were understood; empty where there are none.
    """

    gait: Gait
    body: Body
    marker_set: str
    names: tuple[str, ...]
    error: Array
    filled: int
    doubts: tuple[str, ...] = ()

    __repr__ = short_repr

    @property
    def rms(self) -> Array:
        """`(n,)` root mean square over the markers of each frame [m]."""
        return np.asarray(np.sqrt(np.nanmean(self.error**2, axis=1)))

    @property
    def worst(self) -> Array:
        """`(n,)` largest error of each frame [m]."""
        return np.asarray(np.nanmax(self.error, axis=1))

    @property
    def total_rms(self) -> float:
        """Over all markers and frames [m]."""
        return float(np.sqrt(np.nanmean(self.error**2)))

    def by_marker(self) -> dict[str, float]:
        """Marker -> its root mean square error [m]."""
        return dict(zip(self.names, np.sqrt(np.nanmean(self.error**2, axis=0)).tolist(), strict=True))


def load_walk(
    path: str | Path | TrialFile,
    *,
    static: str | Path | TrialFile | None = None,
    markers: str | None = None,
    model: str | Path | None = None,
    mapping: Mapping[str, str] = MappingProxyType({}),
    mass: float | None = None,
    sex: Sex = "male",
) -> Reconstruction:
    """Read a marker trial (.trc, .c3d) and make a walk of it; other arguments as in `reconstruct`.

    Args:
        path: The trial, or what `exo_pin.formats.open_trial` has read of it.
        static: The same of a standing trial.
        markers: Name of the marker set, or its TOML file.
        model: The OpenSim model (.osim) that was scaled to the person: its markers and lengths are used.
        mapping: The trial's own name of a marker -> the set's.
        mass: Of the person [kg].
        sex: Whose segment masses.

    Raises:
        FormatError: The file cannot be read, or its markers make no walk.
        UnknownNameError: There is no such marker set, or no marker of a mapped name.
    """
    trial = load_markers(path).renamed(mapping)
    standing = None if static is None else load_markers(static).renamed(mapping)
    try:
        chosen = _chosen(markers, model)
        return reconstruct(trial, static=standing, markers=chosen, mass=mass, sex=sex)
    except FormatError:
        raise
    except GaitError as error:
        raise FormatError(path.path if isinstance(path, TrialFile) else path, str(error)) from error


def _chosen(markers: str | None, model: str | Path | None) -> str | MarkerSet | None:
    if model is None:
        return markers
    if markers is not None:
        raise GaitError(
            f"a marker set ({markers}) and a model ({Path(model).name}) are given; one is accepted"
        )
    return model_set(model)


def reconstruct(
    trial: Markers,
    *,
    static: Markers | None = None,
    markers: str | MarkerSet | None = None,
    mass: float | None = None,
    sex: Sex = "male",
) -> Reconstruction:
    """Joint angles and pelvis from markers by least squares, on a body scaled to them.

    The pelvis, the feet's scale and the longest distance from hip to ankle give the body's first sizes; where
    markers sit is taken from the set, and within its spread from the data. Both are calibrated on the
    static trial where there is one, else from the trial itself.

    Args:
        trial: The markers; z, y or x up.
        static: A standing trial of the same person and the same markers.
        markers: The marker set, its name, or its TOML file; None: the one whose markers are there.
        mass: Of the person [kg]; from the leg's length and a body-mass index of 22 if left out.
        sex: Whose segment masses.

    Raises:
        GaitError: Markers are missing, or never seen; the message says which.
        UnknownNameError: There is no such marker set.
    """
    word("sex", sex, get_args(Sex))
    if mass is not None:
        number("mass", mass, above=0.0, error=GaitError)
    if len(trial) < 2:
        raise GaitError("one frame is a posture, no walk; it can be the standing trial (--static) of another")
    known = find_set(markers) if isinstance(markers, str) else markers
    every = _seen_names(trial) + (() if static is None else _seen_names(static))
    chosen = recognise(dict.fromkeys(every), known).chosen
    moving = _paths(trial, chosen)
    model = _calibrated(moving, None if static is None else _paths(static, chosen), trial, static)
    places = model.places.only(moving.paths)
    start, stop = _seen(places, moving.paths)
    used = {name: moving.paths[name][start:stop] for row in places.names.values() for name in row}
    q, error, names = fit_poses(model.robot, places, used)
    gait = _gait(model.robot, q, moving, (start, stop))
    gait = dataclasses.replace(gait, remarks=(*gait.remarks, *model.remarks))
    body = body_of(model.sizes, mass=mass, sex=sex)
    made = Reconstruction(gait, body, moving.found.chosen.name, names, error, moving.filled)
    misfit = misfit_doubts(made.total_rms, made.by_marker())
    return dataclasses.replace(made, doubts=misfit + side_doubts(model.robot, q) + range_doubts(gait.q))


class _Paths(NamedTuple):
    """A trial as markers of a set: z up, short gaps filled.

    Attributes:
        found: The set and what is there of it.
        paths: Marker of the set -> `(n, 3)` path [m].
        trial: The trial with z up.
        filled: Coordinates that were filled.
    """

    found: Recognised
    paths: dict[str, Array]
    trial: Markers
    filled: int


def _calibrated(
    moving: _Paths, standing: _Paths | None, trial: Markers, static: Markers | None
) -> CalibratedBody:
    """The body by the static trial's sizes and both trials' frames, or by the trial alone."""
    chosen = moving.found.chosen
    if chosen.sizes is not None:
        return model_body(chosen, chosen.sizes, moving.paths)
    first = standing or moving
    sizes, pelvis = first_sizes(chosen, first.paths)
    check_lengths(sizes, (static or trial).unit)
    both = [moving] if standing is None else [standing, moving]
    frames = [{name: some_frames(path) for name, path in part.paths.items()} for part in both]
    names = [name for name in chosen.spots if any(name in part for part in frames)]
    counts = [len(next(iter(part.values()))) for part in frames]
    paths = {
        name: np.concatenate(
            [part.get(name, np.full((n, 3), np.nan)) for part, n in zip(frames, counts, strict=True)]
        )
        for name in names
    }
    return calibrated(chosen, sizes, pelvis, paths)


def _seen_names(trial: Markers) -> tuple[str, ...]:
    """Markers that are seen at least once."""
    return tuple(name for k, name in enumerate(trial.names) if not np.isnan(trial.position[:, k]).all())


def _paths(trial: Markers, chosen: MarkerSet) -> _Paths:
    """A set's markers' paths with z up and short gaps filled, the turned trial, how much was filled."""
    found = recognise(_seen_names(trial), chosen)
    turned = trial.turned(to_z_up(trial.up or _vertical(trial, found.chosen, found.own)))
    paths, filled = {}, 0
    for marker, given in found.own.items():
        done = signals.filled(turned.time, turned.of(given))
        paths[marker], filled = done.values, filled + done.filled
    calm = calmed(turned.time, paths)
    remarks = (*turned.remarks, found.sentence, *filter(None, [calm.remark]))
    return _Paths(found, calm.paths, dataclasses.replace(turned, remarks=remarks), filled)


def _vertical(trial: Markers, chosen: MarkerSet, own: Mapping[str, str]) -> Vertical:
    """The axis along which the pelvis is furthest above the feet."""
    groups: dict[bool, list[Array]] = {True: [], False: []}
    for marker, given in own.items():
        segment = chosen.spots[marker].segment
        if segment in ("pelvis", "foot"):
            groups[segment == "pelvis"].append(trial.of(given))
    above = np.nanmean(groups[True], axis=(0, 1)) - np.nanmean(groups[False], axis=(0, 1))
    up = vertical_along(above)
    if up is None:
        raise GaitError(
            f"which axis is up is not clear: the pelvis is {above} m from the feet; one of {UP_AXES}?"
        )
    return up


def _seen(places: MarkerPlaces, paths: Mapping[str, Array]) -> tuple[int, int]:
    """Start and stop of the longest run of frames in which every segment has its markers."""
    good = np.ones(len(next(iter(paths.values()))), dtype=bool)
    for link, names in places.names.items():
        count = sum(~np.isnan(paths[name][:, 0]) for name in names if name in paths)
        good &= count >= fewest_on(link)
    start, stop = signals.longest_run(good)
    if stop - start < 2:
        raise GaitError("no two frames in a row show the markers of every segment")
    return start, stop


def _gait(robot: Robot, q: Array, moving: _Paths, span: tuple[int, int]) -> Gait:
    (start, stop), trial, chosen = span, moving.trial, moving.found.chosen
    time = trial.time[start:stop]
    events = tuple(event for event in trial.events if time[0] <= event.time <= time[-1])
    source = f"{trial.source}: markers ({chosen.name}) by least squares on a body scaled to them"
    if stop - start < len(trial):
        source += f", frames {start} to {stop - 1} of {len(trial)}"
    remarks = trial.remarks
    if len(events) < len(trial.events):
        left = len(trial.events) - len(events)
        remarks += (f"{left} of {len(trial.events)} events lie in frames without markers and are left out",)
    like = Gait(time, np.zeros((len(time), 12)), events=events, source=source, remarks=remarks)
    return robot.to_gait(q, like)
