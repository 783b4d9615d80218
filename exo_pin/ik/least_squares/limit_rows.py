"""Rates of a motion as linear rows, and the equations that they lead to: banded for pieces, full for a cycle.

`LocalRows` couple only neighbouring samples; `CycleRows` are those of a Fourier series, in which every sample
counts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.arrays import Array, Index
from exo_pin.ik.least_squares.rate_rows import Clock


@dataclass(frozen=True, eq=False)
class _Band:
    """The order of the unknowns: n samples of J joints each.

    Attributes:
        nodes: The samples (P, w) that each coupling connects.
        place: Where each sample stands among the equations (n,).
        joints: Number of joints J.
        half_width: Number of diagonals below the main one.
    """

    nodes: Index
    place: Index
    joints: int
    half_width: int

    @classmethod
    def of(cls, nodes: Index, samples: int, joints: int) -> _Band:
        """The order with the narrower band.

        Args:
            nodes: The samples (P, w) that each coupling connects.
            samples: Number of samples n.
            joints: Number of joints J.
        """
        straight, folded = np.arange(samples), np.empty(samples, dtype=np.int64)
        folded[: (samples + 1) // 2] = np.arange(0, samples, 2)
        folded[(samples + 1) // 2 :] = np.arange(1, samples, 2)[::-1]  # both ends of a cycle side by side
        widths = [int(np.ptp(place[nodes], axis=1).max(initial=0)) for place in (straight, folded)]
        place = folded if widths[1] < widths[0] else straight
        return cls(nodes, place, joints, joints * (min(widths) + 1) - 1)

    @property
    def samples(self) -> int:
        """Number of samples n."""
        return len(self.place)

    def gathered(self, local: Array) -> Array:
        """Sums (J, n) of what each coupling gives its samples (J, P, w)."""
        out = np.zeros((self.samples, self.joints))
        for a in range(self.nodes.shape[1]):
            np.add.at(out, self.nodes[:, a], local[..., a].T)
        return np.asarray(out.T)

    def solution(self, blocks: Array, coupling: Array, right: Array) -> Array:
        """X (J, n) of the equations.

        Args:
            blocks: Between the joints of a sample (J, J, n), symmetric.
            coupling: Between the samples of a coupling, the same joint (J, P, w, w), symmetric.
            right: Right-hand sides (J, n).
        """
        from scipy.linalg import solveh_banded

        size, n = right.shape
        band = np.zeros((min(self.half_width, size * n - 1) + 1, size * n))  # band[i - j, j] = H[i, j]
        at = size * self.place
        for i in range(size):
            for j in range(i + 1):
                band[i - j, at + j] = blocks[i, j]
        for a in range(self.nodes.shape[1]):
            for b in range(self.nodes.shape[1]):
                row, column = at[self.nodes[:, a]], at[self.nodes[:, b]]
                lower = row >= column
                for j in range(size):
                    values = coupling[j, lower, a, b]
                    np.add.at(band, (row[lower] - column[lower], column[lower] + j), values)
        g = np.empty((n, size))
        g[self.place] = right.T
        x = solveh_banded(band, g.ravel(), lower=True, overwrite_ab=True, check_finite=False)
        return np.asarray(x.reshape(n, size)[self.place].T)


@dataclass(frozen=True, eq=False)
class LocalRows:
    """Rates over their limits on P pieces between neighbouring samples.

    Attributes:
        weights: Of the samples of each piece (J, P, k, w).
        band: Which samples those are, and the order of the equations.
    """

    weights: Array
    band: _Band

    @classmethod
    def of(cls, clock: Clock, velocity: Array, acceleration: Array) -> LocalRows:
        """The rows of a motion.

        Args:
            clock: Its times.
            velocity: Limits (J,).
            acceleration: Limits (J,).
        """
        pieces = clock.pieces()
        rows = [
            pieces.velocity / velocity[:, None, None, None],
            pieces.acceleration / acceleration[:, None, None, None],
        ]
        band = _Band.of(pieces.nodes, len(clock.time), len(velocity))
        return cls(np.concatenate(rows, axis=2), band)

    def rates(self, x: Array) -> Array:
        """Rates over their limits (J, P k) of a motion (J, n)."""
        found = np.einsum("jpka,jpa->jpk", self.weights, x[:, self.band.nodes])
        return np.asarray(found.reshape(len(x), -1))

    def forces(self, f: Array) -> Array:
        """The transpose of `rates`: (J, P k) to (J, n)."""
        local = np.einsum("jpka,jpk->jpa", self.weights, f.reshape(self.weights.shape[:3]))
        return self.band.gathered(local)

    def solution(self, blocks: Array, stiffness: Array, right: Array) -> Array:
        """X (J, n) of the equations.

        Args:
            blocks: Between the joints of a sample (J, J, n), symmetric.
            stiffness: Of each row (J, P k).
            right: Right-hand sides (J, n).
        """
        w, each = self.weights, stiffness.reshape(self.weights.shape[:3])
        coupling = np.einsum("jpka,jpkb->jpab", w * each[..., None], w)
        return self.band.solution(blocks, coupling, right)


@dataclass(frozen=True, eq=False)
class CycleRows:
    """Rates over their limits at m points of a cycle's Fourier series.

    Attributes:
        weights: Of all samples (J, m, n).
    """

    weights: Array

    @classmethod
    def of(cls, clock: Clock, velocity: Array, acceleration: Array) -> CycleRows:
        """The rows of a cycle; arguments as for `LocalRows.of`."""
        first, second = clock.cycle()
        rows = [first / velocity[:, None, None], second / acceleration[:, None, None]]
        return cls(np.concatenate(rows, axis=1))

    def rates(self, x: Array) -> Array:
        """Rates over their limits (J, m) of a motion (J, n)."""
        return np.asarray((self.weights @ x[..., None])[..., 0])

    def forces(self, f: Array) -> Array:
        """The transpose of `rates`: (J, m) to (J, n)."""
        return np.asarray((f[:, None] @ self.weights)[:, 0])

    def solution(self, blocks: Array, stiffness: Array, right: Array) -> Array:
        """X (J, n) of the equations; arguments as for `LocalRows.solution`."""
        from scipy.linalg import cho_factor, cho_solve

        size, n = right.shape
        whole, k = np.zeros((size, n, size, n)), np.arange(n)
        whole[:, k, :, k] = blocks.transpose(2, 0, 1)
        for j in range(size):
            rows = self.weights[j]
            whole[j, :, j] += (rows.T * stiffness[j]) @ rows
        factor = cho_factor(whole.reshape(size * n, -1), lower=True, overwrite_a=True, check_finite=False)
        return np.asarray(cho_solve(factor, right.ravel(), check_finite=False).reshape(size, n))
