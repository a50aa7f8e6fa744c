import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.demo.inverse_kinematics import leg_pose

THIGH, SHIN = 43.0, 42.0
FORWARD = np.array([0.0, 0.0, 1.0])


def targets(farthest: float) -> tuple[FloatArray, FloatArray]:
    random = np.random.default_rng(4)
    hip = random.normal(scale=50.0, size=(200, 3))
    toward = random.normal(size=(200, 3)) * (0.5, 0.3, 0.5) - (0.0, 1.0, 0.0)
    toward /= np.linalg.norm(toward, axis=-1, keepdims=True)
    return hip, hip + toward * random.uniform(20.0, farthest, size=(200, 1))


def joints(hip: FloatArray, ankle: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    pose = leg_pose(hip, ankle, np.broadcast_to(FORWARD, hip.shape), THIGH, SHIN)
    knee = hip + rotations.rotate(pose.hip, np.array([0.0, -THIGH, 0.0]))
    shin = rotations.multiply(pose.hip, rotations.about_axis("X", pose.knee_rad))
    return knee, knee + rotations.rotate(shin, np.array([0.0, -SHIN, 0.0])), pose.knee_rad


def test_the_ankle_gets_where_it_has_to_be() -> None:
    hip, ankle = targets(THIGH + SHIN)
    np.testing.assert_allclose(joints(hip, ankle)[1], ankle, atol=1e-9)


def test_the_knee_bends_forward_and_never_backward() -> None:
    hip, ankle = targets(THIGH + SHIN)
    knee, _, bend = joints(hip, ankle)
    leg = ankle - hip
    on_leg = hip + leg * (np.sum((knee - hip) * leg, axis=-1) / np.sum(leg * leg, axis=-1))[:, None]
    assert np.all((knee - on_leg)[:, 2] > 0.0)
    assert np.all((bend >= 0.0) & (bend <= np.pi))


def test_a_target_out_of_reach_is_reached_for_with_a_straight_leg() -> None:
    hip, ankle = targets(85.0)
    far = hip + 3.0 * (ankle - hip) / np.linalg.norm(ankle - hip, axis=-1, keepdims=True) * 85.0
    _, reached, bend = joints(hip, far)
    np.testing.assert_allclose(bend, 0.0, atol=1e-7)
    np.testing.assert_allclose(reached, hip + (far - hip) / 3.0, atol=1e-6)
