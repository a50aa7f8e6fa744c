"""Smooth noise: what keeps a person from ever doing the same thing twice, the same on every run."""

from __future__ import annotations

import numpy as np

from mlmg_runtime.arrays import FloatArray

_N_WAVES = 7


class Noise:
    """A source of chance for one clip: a seed gives the same numbers again if asked in the same order."""

    def __init__(self, seed: int) -> None:
        """Start at the beginning of what `seed` gives."""
        self._random = np.random.Generator(np.random.PCG64(seed))

    def drift(self, times_s: FloatArray, size: float, period_s: float) -> FloatArray:
        """Return slow wandering about 0, shape (n_frames,); see `drifts`."""
        return self.drifts(times_s, size, period_s, 1)[:, 0]

    def drifts(self, times_s: FloatArray, size: float, period_s: float, n_signals: int) -> FloatArray:
        """Return slow wandering about 0: waves of random periods and phases, shape (n_frames, n_signals).

        Parameters
        ----------
        times_s : array, shape (n_frames,).
        size : the root mean square over a long time.
        period_s : the typical period; those drawn lie within a factor of two.
        """
        shape = (1, n_signals, _N_WAVES)
        period = period_s * 2.0 ** self._random.uniform(-1.0, 1.0, shape)
        phase = self._random.uniform(0.0, 2.0 * np.pi, shape)
        waves = np.sin(2.0 * np.pi * times_s[:, None, None] / period + phase)
        return np.asarray(size * np.sqrt(2.0 / _N_WAVES) * waves.sum(axis=-1))

    def jitter(self, size: float, n: int) -> FloatArray:
        """Return `n` independent numbers about 0, evenly spread with the given root mean square."""
        return np.asarray(self._random.uniform(-1.0, 1.0, n) * size * np.sqrt(3.0))
