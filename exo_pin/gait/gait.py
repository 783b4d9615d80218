"""`Gait`: joint angles over time, the pelvis's motion and the foot contacts of a walk."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arguments import MOST_SAMPLES, count, number
from exo_pin.arrays import Array, Mask
from exo_pin.errors import GaitError, known_name
from exo_pin.frozen_fields import set_fields
from exo_pin.gait import rigid_poses, time_series
from exo_pin.gait.event import Event, stance
from exo_pin.gait.validation import (
    check_angles,
    check_events,
    check_poses,
    check_time,
    duration,
    frozen,
    read_only,
)
from exo_pin.html_summary import joint_panels, table

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import DataArray

_ON_GRID = 1e-6
"""A sample this little before the recording's start, in samples, is on it."""


@dataclass(frozen=True, eq=False, repr=False)
class Gait:
    """Joint angles over time, in the order of `JOINTS` and the clinical hip convention.

    A periodic gait stores [0, T): the sample at T is the sample at 0 and is never stored. Its base returns
    to the same place after every cycle (walking on the spot, as on a treadmill).

    Array-likes are accepted and copied; the arrays of a gait are read-only.

    Attributes:
        time: `(n,)` strictly increasing [s]; a periodic gait starts at 0 and is evenly sampled.
        q: `(n, 12)` joint angles [rad].
        base: `(n, 4, 4)` pose of the pelvis in the world, or None if the pelvis does not move [m].
        events: Foot contacts, sorted by time.
        periodic: Whether the walk repeats.
        source: Where the numbers come from, in words.
        remarks: What reading the file held, corrected or ignored, a plain sentence each.

    Raises:
        GaitError: If shapes, time, angles, base or events are unusable; the message says which and where.
    """

    time: Array
    q: Array
    _: KW_ONLY
    base: Array | None = None
    events: tuple[Event, ...] = ()
    periodic: bool = False
    source: str = ""
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        set_fields(
            self,
            time=frozen(self.time, "time"),
            q=frozen(self.q, "q"),
            base=None if self.base is None else frozen(self.base, "base"),
            periodic=bool(self.periodic),
            source=str(self.source),
            remarks=tuple(self.remarks),
        )
        check_time(self.time, self.periodic)
        check_angles(self.q, len(self.time))
        if self.base is not None:
            check_poses(self.base, len(self.time), "base")
        set_fields(self, events=tuple(sorted(self.events, key=lambda event: event.time)))
        check_events(self.events, self.time, self.periodic)

    def __repr__(self) -> str:
        base = "a base" if self.base is not None else "no base"
        kind = "periodic" if self.periodic else "not periodic"
        size = f"{len(self)} samples, {self.duration:.3f} s, {kind}, {base}, {len(self.events)} events"
        return f"<Gait {size}, source={self.source!r}>"

    def _repr_html_(self) -> str:
        """The angles as a row of panels, for notebooks."""
        facts = {"samples": len(self), "duration [s]": self.duration, "source": self.source}
        return joint_panels(self.time, np.degrees(self.q), "deg") + table(facts)

    def __len__(self) -> int:
        """Number of samples n."""
        return len(self.time)

    def __getitem__(self, joint: str) -> Array:
        """Angles `(n,)` of one joint by its name, e.g. `gait["right_knee_flexion"]` [rad].

        Raises:
            UnknownNameError: There is no such joint.
        """
        return self.q[:, JOINTS.index(known_name("joint", joint, JOINTS))]

    @property
    def duration(self) -> float:
        """Length in time [s]: the period T of a periodic gait, else last minus first sample."""
        return duration(self.time, self.periodic)

    @cached_property
    def dq(self) -> Array:
        """`(n, 12)` joint velocities [rad/s].

        Periodic gaits: exact for band-limited curves (spectral); else second-order differences.
        """
        return read_only(time_series.derivative(self.time, self.q, 1, self._period))

    @cached_property
    def ddq(self) -> Array:
        """`(n, 12)` joint accelerations [rad/s^2], made as `dq` is; it amplifies noise: filter recordings."""
        return read_only(time_series.derivative(self.time, self.q, 2, self._period))

    @cached_property
    def base_velocity(self) -> Array | None:
        """`(n, 6)` velocity of the pelvis, linear first, world axes [m/s, rad/s], or None."""
        if self.base is None:
            return None
        flat = self.base.reshape(len(self), 16)
        dT = time_series.derivative(self.time, flat, 1, self._period).reshape(-1, 4, 4)
        omega = rigid_poses.angular_velocity(self.base[:, :3, :3], dT[:, :3, :3])
        return read_only(np.hstack([dT[:, :3, 3], omega]))

    @cached_property
    def base_acceleration(self) -> Array | None:
        """`(n, 6)` acceleration of the pelvis, linear first, world axes [m/s^2, rad/s^2], or None."""
        if self.base is None or self.base_velocity is None:
            return None
        linear = time_series.derivative(self.time, self.base[:, :3, 3], 2, self._period)
        angular = time_series.derivative(self.time, self.base_velocity[:, 3:], 1, self._period)
        return read_only(np.hstack([linear, angular]))

    def to_pandas(self) -> DataFrame:
        """A pandas `DataFrame`: a column for each joint [rad] and of a moving pelvis, time as index [s].

        Periodic, source and events are in its `attrs`. Needs the extra `tables`.
        """
        from exo_pin.gait.data_frames import frame_of

        events = [(event.side, event.kind, event.time) for event in self.events]
        attrs = {"periodic": self.periodic, "source": self.source, "events": events}
        return frame_of(self.time, self.q, self.base, attrs)

    def to_xarray(self) -> DataArray:
        """An xarray `DataArray` [rad] with the dimensions time and joint; needs the extra `tables`."""
        from exo_pin.gait.data_frames import array_of

        return array_of(self.time, self.q, {"periodic": self.periodic, "source": self.source})

    @classmethod
    def from_pandas(cls, frame: DataFrame) -> Gait:
        """The walk of a `DataFrame` as `to_pandas` makes it; raises `GaitError` where columns are missing."""
        from exo_pin.gait.data_frames import columns_of

        return cls(**columns_of(frame))

    def resampled(self, n: int) -> Gait:
        """The same walk with `n` evenly spaced samples.

        Periodic gaits are interpolated by their Fourier series, others by C1 cubic Hermite pieces. The base
        is interpolated with them, entry by entry, and every pose is then put back on the nearest rotation.

        Raises:
            GaitError: If `n` is less than 2, or more than a million.
        """
        n = count("number of samples", n, 2, MOST_SAMPLES, error=GaitError)
        start, span = self.time[0], self.duration
        time = start + span * np.arange(n) / n if self.periodic else np.linspace(start, self.time[-1], n)
        return self._at(time)

    def sampled(self, rate: float) -> Gait:
        """The same walk as a camera of that rate [Hz] would see it; interpolated as by `resampled`.

        A recording has its samples at whole multiples of 1 / rate, as far as they lie within it; a gait that
        repeats has the number that comes nearest to the rate.

        Raises:
            GaitError: That would be fewer than 2 samples, or more than a million.
        """
        rate = number("rate", rate, error=GaitError)
        if not 2 <= self.duration * rate + 1 <= MOST_SAMPLES:
            raise GaitError(f"sampled at {rate:g} Hz: 2 to {MOST_SAMPLES} samples are accepted")
        if self.periodic:
            return self.resampled(max(round(self.duration * rate), 2))
        first, last = np.ceil(self.time[0] * rate - _ON_GRID), np.floor(self.time[-1] * rate + _ON_GRID)
        time = np.clip(np.arange(first, last + 1) / rate, self.time[0], self.time[-1])
        if len(time) < 2:
            raise GaitError(f"sampled at {rate:g} Hz: no two samples lie within the recording")
        events = tuple(event for event in self.events if time[0] <= event.time <= time[-1])
        return replace(self, events=events)._at(time)

    def _at(self, time: Array) -> Gait:
        """The same walk at other times, for periodic gaits those of an evenly divided cycle."""
        q = time_series.resampled(self.time, self.q, time, self.periodic)
        base = None
        if self.base is not None:
            flat = time_series.resampled(self.time, self.base.reshape(-1, 16), time, self.periodic)
            base = rigid_poses.nearest_pose(flat.reshape(len(time), 4, 4))
        return replace(self, time=time, q=q, base=base)

    def repeated(self, k: int) -> Gait:
        """`k` cycles of a periodic gait as one longer periodic gait, events included.

        Raises:
            GaitError: If the gait is not periodic, `k` is less than 1, or more than a million samples result.
        """
        if not self.periodic:
            raise GaitError("a gait that is not periodic cannot be repeated: its ends do not meet")
        k = count("number of cycles", k, 1, MOST_SAMPLES // len(self), error=GaitError)
        n, T = len(self), self.duration
        time = T * np.arange(k * n) / n
        base = None if self.base is None else np.tile(self.base, (k, 1, 1))
        events = (replace(event, time=event.time + i * T) for i in range(k) for event in self.events)
        return replace(self, time=time, q=np.tile(self.q, (k, 1)), base=base, events=tuple(events))

    def mirrored(self) -> Gait:
        """The walk seen in a mirror: left and right change places, the base goes through the x-z plane."""
        mirror = np.diag([1.0, -1.0, 1.0, 1.0])
        other = dict(zip(SIDES, reversed(SIDES), strict=True))
        return replace(
            self,
            q=np.roll(self.q, len(JOINTS) // 2, axis=1),  # same number left and right = mirror image
            base=None if self.base is None else mirror @ self.base @ mirror,
            events=tuple(replace(event, side=other[event.side]) for event in self.events),
        )

    def slowed(self, f: float) -> Gait:
        """The same walk `f` times slower, from the same first time on (`f < 1` is faster).

        Raises:
            GaitError: If `f` is not a positive finite number.
        """
        f = number("factor", f, above=0.0, error=GaitError)
        start = float(self.time[0])
        events = (replace(event, time=start + f * (event.time - start)) for event in self.events)
        return replace(self, time=start + f * (self.time - start), events=tuple(events))

    def stance(self, side: Side) -> Mask:
        """`(n,)` whether the foot is on the ground, from the events: heel strike until toe-off.

        Raises:
            GaitError: If the side has no events, or they do not take turns (then contact is unknown).
            UnknownNameError: If there is no such side.
        """
        return stance(self.time, self.events, side, periodic=self.periodic)

    @property
    def _period(self) -> float | None:
        return self.duration if self.periodic else None
