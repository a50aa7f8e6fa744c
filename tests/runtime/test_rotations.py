"""Rotations are held against scipy's, which keeps its quaternions as (x, y, z, w)."""

from itertools import permutations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray

THREE_AXES = ["".join(order) for order in permutations("XYZ")]
TWO_AXES = ["".join(order) for order in permutations("XYZ", 2)]
QUARTER = 0.5 * np.pi


def scipy_rotation(q: FloatArray) -> Rotation:
    return Rotation.from_quat(np.roll(q, -1, axis=-1))


def random_rotations(n: int, seed: int = 0) -> FloatArray:
    return rotations.normalized(np.random.default_rng(seed).normal(size=(n, 4)))


def assert_same_rotation(q: FloatArray, expected: FloatArray, tolerance: float = 1e-12) -> None:
    flip = np.where(np.sum(q * expected, axis=-1, keepdims=True) < 0.0, -1.0, 1.0)
    np.testing.assert_allclose(q * flip, expected, rtol=0.0, atol=tolerance)


def test_a_product_turns_first_by_its_second_factor() -> None:
    a, b = random_rotations(50), random_rotations(50, seed=1)
    product = scipy_rotation(a) * scipy_rotation(b)
    assert_same_rotation(rotations.multiply(a, b), np.roll(product.as_quat(), 1, axis=-1))


def test_products_broadcast() -> None:
    a, b = random_rotations(6).reshape(3, 2, 4), random_rotations(2, seed=1)
    assert_same_rotation(rotations.multiply(a, b)[2], rotations.multiply(a[2], b))
    assert_same_rotation(rotations.multiply(b[0], a)[1], rotations.multiply(b[0], a[1]))


def test_a_rotation_times_its_inverse_does_nothing() -> None:
    q = random_rotations(20)
    assert_same_rotation(rotations.multiply(q, rotations.inverse(q)), np.tile([1.0, 0.0, 0.0, 0.0], (20, 1)))


def test_vectors_turn_as_scipy_turns_them() -> None:
    q, v = random_rotations(50), np.random.default_rng(1).normal(size=(50, 3))
    np.testing.assert_allclose(rotations.rotate(q, v), scipy_rotation(q).apply(v), atol=1e-12)


def test_one_rotation_turns_many_vectors_and_many_rotations_turn_one() -> None:
    q, v = random_rotations(5), np.random.default_rng(1).normal(size=(5, 3))
    np.testing.assert_allclose(rotations.rotate(q[0], v), scipy_rotation(q[0]).apply(v), atol=1e-12)
    np.testing.assert_allclose(rotations.rotate(q, v[0]), scipy_rotation(q).apply(v[0]), atol=1e-12)


def test_matrices_are_those_of_scipy() -> None:
    q = random_rotations(50)
    np.testing.assert_allclose(rotations.matrix_from_quaternion(q), scipy_rotation(q).as_matrix(), atol=1e-12)


@pytest.mark.parametrize("order", ["", "X", "Y", "Z", *TWO_AXES, *THREE_AXES])
def test_angles_are_intrinsic_in_the_order_of_the_channels(order: str) -> None:
    angles = np.random.default_rng(0).uniform(-7.0, 7.0, size=(40, len(order)))
    expected = Rotation.from_euler(order, angles) if order else Rotation.identity(40)
    assert_same_rotation(rotations.from_euler(order, angles), np.roll(expected.as_quat(), 1, axis=-1))


@pytest.mark.parametrize("order", THREE_AXES)
def test_angles_of_a_rotation_are_those_of_scipy(order: str) -> None:
    q = random_rotations(200)
    np.testing.assert_allclose(rotations.to_euler(order, q), scipy_rotation(q).as_euler(order), atol=1e-9)


@pytest.mark.parametrize("order", THREE_AXES)
@pytest.mark.parametrize("distance", [0.0, 1e-12, 1e-9, 1e-7, 1e-4])
@pytest.mark.parametrize("middle", [QUARTER, -QUARTER])
def test_near_the_singularity_the_angles_still_make_the_rotation(order: str, distance: float, middle: float) -> None:
    angles = np.random.default_rng(0).uniform(-3.0, 3.0, size=(100, 3))
    angles[:, 1] = middle * (1.0 - distance)
    q = rotations.from_euler(order, angles)
    assert_same_rotation(rotations.from_euler(order, rotations.to_euler(order, q)), q, 1e-14)


@pytest.mark.parametrize("order", ["X", "Y", "Z", *TWO_AXES])
def test_one_or_two_angles_come_back_from_the_rotation_that_they_make(order: str) -> None:
    angles = np.random.default_rng(0).uniform(-np.pi, np.pi, size=(200, len(order)))
    angles[:8, -1] = QUARTER, -QUARTER, np.pi, 0.0, 2.0, -2.0, QUARTER, -QUARTER
    q = rotations.from_euler(order, angles) * np.where(np.arange(200) % 2, 1.0, -1.0)[:, None]
    difference = np.remainder(rotations.to_euler(order, q) - angles + np.pi, 2.0 * np.pi) - np.pi
    np.testing.assert_allclose(difference, 0.0, atol=1e-12)


@pytest.mark.parametrize("order", ["X", "Y", "Z", *TWO_AXES])
def test_no_other_one_or_two_angles_come_nearer_to_a_rotation(order: str) -> None:
    q = random_rotations(30)
    angles = rotations.to_euler(order, q)
    error = rotations.angle_between(rotations.from_euler(order, angles), q)
    steps = np.linspace(-np.pi, np.pi, 73)
    grid = np.stack(np.meshgrid(*[steps] * len(order)), axis=-1).reshape(-1, 1, len(order))
    best_of_grid = rotations.angle_between(rotations.from_euler(order, grid), q).min(axis=0)
    assert np.all(error <= best_of_grid + 1e-12)


def test_turns_about_any_axis_are_those_of_scipy() -> None:
    random = np.random.default_rng(11)
    axis, angle_rad = random.normal(size=(50, 3)), random.uniform(-4.0, 4.0, size=50)
    unit = axis / np.linalg.norm(axis, axis=-1, keepdims=True)
    expected = np.roll(Rotation.from_rotvec(angle_rad[:, None] * unit).as_quat(), 1, axis=-1)
    assert_same_rotation(rotations.about(axis, angle_rad), expected)


def test_the_smallest_turn_between_two_ways_turns_one_to_the_other_about_what_lies_across_both() -> None:
    random = np.random.default_rng(12)
    a, b = random.normal(size=(2, 50, 3))
    turn = rotations.between(a, b)
    along = rotations.rotate(turn, a) / np.linalg.norm(a, axis=-1, keepdims=True)
    np.testing.assert_allclose(along, b / np.linalg.norm(b, axis=-1, keepdims=True), atol=1e-12)
    np.testing.assert_allclose(np.sum(turn[:, 1:] * a, axis=-1), 0.0, atol=1e-12)
    assert np.all(np.isfinite(rotations.between(a, -a)))


def test_slerp_goes_the_shortest_way_at_even_speed() -> None:
    a, b = random_rotations(30), random_rotations(30, seed=1)
    for weight in (0.0, 0.25, 0.5, 1.0):
        way = [
            Slerp([0.0, 1.0], Rotation.concatenate([scipy_rotation(x), scipy_rotation(y)]))(weight)
            for x, y in zip(a, b, strict=True)
        ]
        expected = np.roll([rotation.as_quat() for rotation in way], 1, axis=-1)
        assert_same_rotation(rotations.slerp(a, b, np.asarray(weight)), expected)


def test_slerp_takes_a_weight_for_each_rotation() -> None:
    a, b = random_rotations(6).reshape(3, 2, 4), random_rotations(6, seed=1).reshape(3, 2, 4)
    weight = np.array([[0.1], [0.5], [0.9]])
    result = rotations.slerp(a, b, weight)
    for row in range(3):
        assert_same_rotation(result[row], rotations.slerp(a[row], b[row], weight[row]))


def test_slerp_between_a_rotation_and_itself_or_its_negative_stays_there() -> None:
    q = random_rotations(10)
    for other in (q, -q, rotations.normalized(q + 1e-13)):
        assert_same_rotation(rotations.slerp(q, other, np.asarray(0.3)), q)


def test_slerp_between_opposite_rotations_is_half_way_between() -> None:
    none, half_turn = np.array([1.0, 0.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0, 0.0])
    middle = rotations.slerp(none, half_turn, np.asarray(0.5))
    np.testing.assert_allclose(rotations.angle_between(none, middle), QUARTER)


def test_angles_between_rotations_are_those_of_scipy() -> None:
    a, b = random_rotations(50), random_rotations(50, seed=1)
    expected = (scipy_rotation(a).inv() * scipy_rotation(b)).magnitude()
    np.testing.assert_allclose(rotations.angle_between(a, b), expected, atol=1e-12)


@pytest.mark.parametrize("angle", [1e-9, 1e-5, np.pi - 1e-5])
def test_tiny_and_nearly_opposite_angles_are_measured_exactly(angle: float) -> None:
    a = random_rotations(1)[0]
    b = rotations.multiply(a, rotations.about_axis("Y", np.array(angle)))
    np.testing.assert_allclose(rotations.angle_between(a, b), angle, rtol=1e-6)
    np.testing.assert_allclose(rotations.angle_between(a, -b), angle, rtol=1e-6)


@pytest.mark.parametrize("order", [*TWO_AXES, *THREE_AXES])
def test_written_continuously_angles_still_make_the_same_rotations(order: str) -> None:
    q = random_rotations(100)
    angles = rotations.continuous_euler(rotations.to_euler(order, q))
    nearest = rotations.from_euler(order, rotations.to_euler(order, q))
    assert_same_rotation(rotations.from_euler(order, angles), nearest)


@pytest.mark.parametrize("order", THREE_AXES)
def test_smooth_channels_beyond_the_singularity_come_back_smooth(order: str) -> None:
    time = np.linspace(0.0, 1.0, 200)[:, None]
    angles = np.array([0.3, 1.2, -0.4]) + time * np.array([9.0, 2.5, -7.0])
    result = rotations.continuous_euler(rotations.to_euler(order, rotations.from_euler(order, angles)))
    np.testing.assert_allclose(result - result[0], angles - angles[0], atol=1e-9)


def wobbling(n_frames: int, about_deg: float) -> tuple[FloatArray, FloatArray]:
    """Return a joint at rest, and one turned about an axis by an angle that swings by 10 degrees."""
    angle = np.radians(about_deg + 10.0 * np.sin(np.arange(n_frames)))
    rest = np.tile([1.0, 0.0, 0.0, 0.0], (n_frames, 1, 1))
    return rest, rotations.about_axis("X", angle)[:, None]


@pytest.mark.parametrize("about_deg", [40.0, 165.0, 180.0, 195.0])
def test_movements_half_a_turn_apart_are_blended_on_one_side(about_deg: float) -> None:
    a, b = wobbling(20, about_deg)
    b[7:12] *= -1.0
    weight = np.linspace(0.05, 1.0, 20)
    blended = rotations.slerp_movements(a, b, weight, np.array([0]))
    angle = np.degrees(2.0 * np.arctan2(blended[:, 0, 1], blended[:, 0, 0]))
    swing = about_deg + 10.0 * np.sin(np.arange(20))
    sides = [weight * turned for turned in (swing, swing - 360.0)]
    apart = [np.abs((angle - side + 180.0) % 360.0 - 180.0).max() for side in sides]
    assert min(apart) < 1e-9
    if about_deg != 180.0:
        assert apart.index(min(apart)) == (0 if about_deg < 180.0 else 1)


def test_movements_less_than_half_a_turn_apart_are_blended_frame_by_frame() -> None:
    random = np.random.default_rng(3)
    a = rotations.normalized(random.normal(size=(30, 5, 4)))
    b = rotations.multiply(a, rotations.about_axis("Y", random.uniform(-3.0, 3.0, size=(1, 5)))) * random.choice(
        [-1.0, 1.0], size=(30, 5, 1)
    )
    weight = random.uniform(size=30)
    found = rotations.slerp_movements(a, b, weight, np.array([0, 4, 5, 20]))
    assert_same_rotation(found, rotations.slerp(a, b, weight[:, None]))


def test_each_blend_of_movements_takes_its_own_side() -> None:
    (a, b), (_, c) = wobbling(20, 165.0), wobbling(20, 195.0)
    b[10:] = c[10:]
    weight = np.tile(np.linspace(0.1, 1.0, 10), 2)
    both = rotations.slerp_movements(a, b, weight, np.array([0, 10]))
    for part in (slice(0, 10), slice(10, 20)):
        alone = rotations.slerp_movements(a[part], b[part], weight[part], np.array([0]))
        assert_same_rotation(both[part], alone)


def test_the_long_way_round_back_to_the_same_rotation_is_no_way() -> None:
    q = rotations.normalized(np.array([[[0.1, 0.7, -0.3, 0.4]]]))
    with np.errstate(all="raise"):
        assert_same_rotation(rotations.slerp_movements(q, -q, np.array([0.5]), np.array([0])), q)


def test_a_movement_that_comes_all_the_way_round_is_where_it_was() -> None:
    a, _ = wobbling(4, 0.0)
    b = rotations.about_axis("X", np.radians([[0.0], [20.0], [190.0], [360.0]]))
    found = rotations.slerp_movements(a, b, np.array([0.5, 0.5, 0.3, 0.5]), np.array([0]))
    assert_same_rotation(found[3], a[3])
