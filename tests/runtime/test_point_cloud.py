from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime import bvh
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.clips import poses_from_bvh, skeleton_from_bvh
from mlmg_runtime.errors import ShapeError
from mlmg_runtime.point_cloud import best_fit, point_cloud, window_distances
from mlmg_runtime.skeleton import world_positions

WINDOWS = [1, 2, 3, 5, 8, 20, 21]


def wandering(seed: int, n_frames: int, n_points: int = 7) -> FloatArray:
    """Return points of a body, in centimetres, that strays a few hundred metres from the origin."""
    random = np.random.default_rng(seed)
    body = random.normal(scale=40.0, size=(n_points, 3))
    swing = np.cumsum(random.normal(scale=1.5, size=(n_frames, n_points, 3)), axis=0)
    walk = np.cumsum(random.normal(scale=3.0, size=(n_frames, 1, 3)), axis=0) * (1.0, 0.1, 1.0)
    return np.asarray(body + swing + walk + random.normal(scale=2e4, size=3) * (1.0, 0.0, 1.0))


def weights_of(seed: int, n_points: int = 7) -> FloatArray:
    return np.random.default_rng(seed).uniform(0.1, 3.0, size=n_points)


def moved(points: FloatArray, yaw_rad: float, x: float, z: float) -> FloatArray:
    """Return the points turned about the vertical, counter-clockwise seen from above, and shifted."""
    c, s = np.cos(yaw_rad), np.sin(yaw_rad)
    return np.asarray(points @ np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]) + (x, 0.0, z))


def centred(window: FloatArray) -> FloatArray:
    return np.asarray(window - np.mean(window, axis=(0, 1)) * (1.0, 0.0, 1.0))


def naive_distance(a: FloatArray, b: FloatArray, weights: FloatArray) -> float:
    """Return D of one pair of windows, shape (k, n_points, 3), by the published form of the best angle."""
    a, b = centred(a), centred(b)
    w = np.broadcast_to(weights, a.shape[:2])
    total = w.sum()
    (x1, _, z1), (x2, _, z2) = np.moveaxis(a, -1, 0), np.moveaxis(b, -1, 0)
    sx1, sz1, sx2, sz2 = ((w * c).sum() for c in (x1, z1, x2, z2))
    across = (w * (x1 * z2 - x2 * z1)).sum() - (sx1 * sz2 - sx2 * sz1) / total
    along = (w * (x1 * x2 + z1 * z2)).sum() - (sx1 * sx2 + sz1 * sz2) / total
    theta = np.arctan2(across, along)
    x0 = (sx1 - sx2 * np.cos(theta) - sz2 * np.sin(theta)) / total
    z0 = (sz1 + sx2 * np.sin(theta) - sz2 * np.cos(theta)) / total
    return cost_of(a, b, weights, (theta, x0, z0))


def cost_of(a: FloatArray, b: FloatArray, weights: FloatArray, transform: tuple[float, float, float]) -> float:
    return float(np.sum(weights[:, None] * (a - moved(b, *transform)) ** 2))


def all_naive(a: FloatArray, b: FloatArray, weights: FloatArray, window: int) -> FloatArray:
    rows, columns = len(a) - window + 1, len(b) - window + 1
    return np.array(
        [[naive_distance(a[i : i + window], b[j : j + window], weights) for j in range(columns)] for i in range(rows)]
    )


def test_a_thousand_random_window_pairs_are_as_far_apart_as_the_formula_says() -> None:
    random = np.random.default_rng(5)
    a, b, weights = wandering(1, 300), wandering(2, 260), weights_of(3)
    distances = window_distances(point_cloud(a, weights, 20), point_cloud(b, weights, 20))
    assert distances.shape == (281, 241)
    pairs = zip(random.integers(281, size=1000), random.integers(241, size=1000), strict=True)
    for i, j in pairs:
        expected = naive_distance(a[i : i + 20], b[j : j + 20], weights)
        assert distances[i, j] == pytest.approx(expected, rel=1e-9)


def test_single_precision_is_off_by_less_than_a_ten_thousandth_of_the_scale() -> None:
    a, b, weights = wandering(1, 300), wandering(2, 260), weights_of(3)
    exact = window_distances(point_cloud(a, weights, 20), point_cloud(b, weights, 20))
    clouds = (point_cloud(points, weights, 20, np.float32) for points in (a, b))
    single = window_distances(*clouds)
    assert single.dtype == np.float32
    assert np.abs(single - exact).max() <= 1e-4 * exact.max()
    assert np.abs(single - exact).max() > 0.0


@pytest.mark.mocap
def test_a_thousand_window_pairs_of_real_clips_are_as_far_apart_as_the_formula_says(mocap: Path) -> None:
    random = np.random.default_rng(6)
    clips = []
    for name in ("Walk_01", "Walk_02", "Idle_02", "Talk_01"):
        document = bvh.read(mocap / "reference" / f"{name}.bvh")
        clips.append(world_positions(skeleton_from_bvh(document), poses_from_bvh(document)))
    weights = weights_of(4, clips[0].shape[1])
    clouds = [point_cloud(points, weights, 20) for points in clips]
    singles = [point_cloud(points, weights, 20, np.float32) for points in clips]
    for a, b in [(0, 0), (0, 1), (1, 2), (2, 3), (0, 3)]:
        distances = window_distances(clouds[a], clouds[b])
        single = window_distances(singles[a], singles[b])
        assert np.abs(single - distances).max() <= 1e-4 * distances.max()
        for _ in range(200):
            i, j = (int(random.integers(size)) for size in distances.shape)
            expected = naive_distance(clips[a][i : i + 20], clips[b][j : j + 20], weights)
            assert distances[i, j] == pytest.approx(expected, rel=1e-9, abs=1e-9 * distances.max() * (i == j))


@pytest.mark.parametrize("window", WINDOWS)
def test_every_pair_is_right_whatever_the_length_of_the_window(window: int) -> None:
    a, b, weights = wandering(4, 30), wandering(5, 25), weights_of(6)
    distances = window_distances(point_cloud(a, weights, window), point_cloud(b, weights, window))
    np.testing.assert_allclose(distances, all_naive(a, b, weights, window), rtol=1e-9)


def test_no_numerical_search_finds_a_better_fit() -> None:
    from scipy.optimize import minimize

    random = np.random.default_rng(7)
    a, b, weights = wandering(8, 60), wandering(9, 60), weights_of(10)
    distances = window_distances(point_cloud(a, weights, 12), point_cloud(b, weights, 12))
    for _ in range(6):
        i, j = (int(random.integers(size)) for size in distances.shape)
        first, second = centred(a[i : i + 12]), centred(b[j : j + 12])
        found = min(
            minimize(lambda x, p=first, q=second: cost_of(p, q, weights, tuple(x)), (yaw, 0.0, 0.0)).fun
            for yaw in (0.0, 2.0, 4.0)
        )
        assert distances[i, j] == pytest.approx(found, rel=1e-6)


@given(
    st.integers(0, 10**6),
    st.floats(-10.0, 10.0),
    st.floats(-1e4, 1e4),
    st.floats(-1e4, 1e4),
)
def test_turning_and_moving_a_clip_over_the_ground_changes_no_distance(
    seed: int, yaw_rad: float, x: float, z: float
) -> None:
    a, b, weights = wandering(seed, 14, 4), wandering(seed + 1, 12, 4), weights_of(seed, 4)
    before = window_distances(point_cloud(a, weights, 6), point_cloud(b, weights, 6))
    after = window_distances(point_cloud(a, weights, 6), point_cloud(moved(b, yaw_rad, x, z), weights, 6))
    np.testing.assert_allclose(after, before, rtol=1e-7)


def test_lifting_a_clip_off_the_ground_does_change_its_distances() -> None:
    a, weights = wandering(1, 14), weights_of(2)
    cloud, lifted = point_cloud(a, weights, 6), point_cloud(a + np.array([0.0, 2.0, 0.0]), weights, 6)
    np.testing.assert_allclose(np.diag(window_distances(cloud, lifted)), 4.0 * 6 * weights.sum(), rtol=1e-6)


def test_a_pair_of_windows_is_the_same_pair_seen_from_the_other_clip() -> None:
    a, b, weights = wandering(1, 40), wandering(2, 30), weights_of(3)
    one, other = point_cloud(a, weights, 9), point_cloud(b, weights, 9)
    np.testing.assert_allclose(window_distances(one, other), window_distances(other, one).T, rtol=1e-10)


def test_a_window_is_at_no_distance_from_itself_and_never_below_that() -> None:
    a, weights = wandering(1, 60), weights_of(3)
    distances = window_distances(point_cloud(a, weights, 20), point_cloud(a, weights, 20))
    np.testing.assert_allclose(np.diag(distances), 0.0, atol=1e-9 * distances.max())
    assert distances.min() >= 0.0


def test_the_horizontal_reach_and_the_heights_of_points_alone_bound_the_distance_from_below() -> None:
    a, b, weights = wandering(1, 60), wandering(2, 50), weights_of(3)
    distances = window_distances(point_cloud(a, weights, 8), point_cloud(b, weights, 8))

    def features(points: FloatArray) -> FloatArray:
        about = points - np.average(points, axis=1, weights=weights).mean(axis=0) * (1.0, 0.0, 1.0)
        return np.stack((np.hypot(about[..., 0], about[..., 2]), about[..., 1]))

    for i in range(0, 53, 4):
        for j in range(0, 43, 4):
            apart = features(a[i : i + 8]) - features(b[j : j + 8])
            assert np.sum(weights * apart**2) <= distances[i, j] * (1.0 + 1e-9)


def test_a_joint_of_no_weight_counts_for_nothing() -> None:
    a, b = wandering(1, 30), wandering(2, 30)
    weights = np.array([1.0, 2.0, 0.0, 1.0, 0.5, 0.0, 3.0])
    used = weights > 0
    some = window_distances(point_cloud(a, weights, 10), point_cloud(b, weights, 10))
    clouds = (point_cloud(points[:, used], weights[used], 10) for points in (a, b))
    np.testing.assert_allclose(some, window_distances(*clouds), rtol=1e-10)


def test_a_clip_shorter_than_a_window_has_none() -> None:
    short, long = (point_cloud(wandering(1, n), weights_of(2), 20) for n in (19, 40))
    assert short.n_windows == 0
    assert window_distances(short, long).shape == (0, 21)
    assert window_distances(long, short).shape == (21, 0)


def test_points_and_weights_that_do_not_fit_are_told_with_their_shapes() -> None:
    with pytest.raises(ShapeError, match=r"\(n, m, 3\) and weights \(m,\), found \(9, 7, 3\) and \(6,\)"):
        point_cloud(wandering(1, 9), weights_of(2, 6), 4)
    one, other = (
        point_cloud(wandering(1, 9), weights_of(2), 4),
        point_cloud(wandering(1, 9), weights_of(2), 5),
    )
    with pytest.raises(ShapeError, match="windows of 4 x 7 and 5 x 7 points"):
        window_distances(one, other)
    with pytest.raises(ShapeError, match="found"):
        best_fit(np.zeros((1, 4, 7, 3)), np.zeros((1, 5, 7, 3)), weights_of(2))


def test_the_best_fit_of_each_pair_is_what_makes_its_distance() -> None:
    a, b, weights = wandering(1, 50), wandering(2, 50), weights_of(3)
    distances = window_distances(point_cloud(a, weights, 10), point_cloud(b, weights, 10))
    i, j = np.array([0, 7, 40, 13]), np.array([40, 3, 0, 13])
    first, second = (np.stack([p[at : at + 10] for at in starts]) for p, starts in ((a, i), (b, j)))
    fit = best_fit(first, second, weights)
    for n, (yaw, (x, z)) in enumerate(zip(fit.yaw_rad, fit.shift, strict=True)):
        cost = cost_of(first[n], second[n], weights, (yaw, x, z))
        assert cost == pytest.approx(distances[i[n], j[n]], rel=1e-7)


def test_the_best_fit_undoes_a_known_turn_and_shift() -> None:
    a, weights = wandering(1, 10), weights_of(3)
    away = moved(a, -0.7, 120.0, -80.0)
    fit = best_fit(a[None], away[None], weights)
    back = moved(away, fit.yaw_rad[0], *fit.shift[0])
    np.testing.assert_allclose(back, a, atol=1e-6)
    assert fit.yaw_rad[0] == pytest.approx(0.7)
