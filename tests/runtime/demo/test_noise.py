import numpy as np
import pytest

from mlmg_runtime.demo.noise import Noise

TIMES = np.arange(60_000) / 30.0


def test_the_same_seed_gives_the_same_noise_and_another_another() -> None:
    first, again, other = (Noise(seed).drift(TIMES[:300], 1.0, 2.0) for seed in (5, 5, 6))
    assert np.array_equal(first, again)
    assert np.abs(first - other).max() > 0.5


def test_drift_is_as_large_as_asked_for_and_about_nought() -> None:
    drift = Noise(1).drifts(TIMES, 2.5, 3.0, 4)
    assert drift.shape == (60_000, 4)
    np.testing.assert_allclose(np.sqrt(np.mean(drift**2, axis=0)), 2.5, rtol=0.05)
    np.testing.assert_allclose(drift.mean(axis=0), 0.0, atol=0.05)


def test_drift_is_smooth() -> None:
    drift = Noise(2).drift(TIMES, 1.0, 3.0)
    assert np.abs(np.diff(drift)).max() < 2.0 * np.pi / 1.5 / 30.0 * np.sqrt(14.0)


def test_jitter_is_as_large_as_asked_for_and_bounded() -> None:
    jitter = Noise(3).jitter(0.4, 20_000)
    assert np.sqrt(np.mean(jitter**2)) == pytest.approx(0.4, rel=0.02)
    assert np.abs(jitter).max() <= 0.4 * np.sqrt(3.0)
