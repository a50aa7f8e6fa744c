import numpy as np

from mlmg_runtime.bvh import Bvh, Joint
from mlmg_runtime.bvh.precision import decimals_needed

TURNS = ("Zrotation", "Xrotation", "Yrotation")
ALL = ("Xposition", "Yposition", "Zposition", *TURNS)


def chain(n_joints: int, bone: float, channels: tuple[str, ...] = TURNS) -> Bvh:
    joints = [Joint("j0", -1, (0.0, 0.0, 0.0), ALL)]
    joints += [Joint(f"j{at}", at - 1, (0.0, bone, 0.0), channels) for at in range(1, n_joints)]
    n_channels = sum(len(joint.channels) for joint in joints)
    return Bvh(tuple(joints), 1.0, np.full((2, n_channels), bone))


def test_a_body_in_centimetres_needs_six_decimals() -> None:
    assert decimals_needed(chain(8, 25.0), 1e-4) == 6


def test_a_body_in_millimetres_needs_more() -> None:
    assert decimals_needed(chain(8, 250.0), 1e-4) == 7


def test_long_chains_need_more() -> None:
    assert decimals_needed(chain(200, 25.0), 1e-4) == 9


def test_positions_count_where_they_replace_offsets() -> None:
    near = chain(8, 0.01, ALL)
    far = Bvh(near.joints, 1.0, near.frames - 1e6)
    assert decimals_needed(near, 1e-4) == 6
    assert decimals_needed(far, 1e-4) > 9


def test_where_the_root_is_does_not_count() -> None:
    bvh = chain(8, 25.0)
    frames = bvh.frames.copy()
    frames[:, :3] = 1e6
    assert decimals_needed(Bvh(bvh.joints, 1.0, frames), 1e-4) == 6


def test_a_double_holds_no_more_than_fifteen_decimals() -> None:
    assert decimals_needed(chain(3, 1e300), 1e-4) == 15


def test_rounded_so_the_end_of_the_worst_chain_moves_less_than_the_tolerance() -> None:
    bvh = chain(200, 25.0)
    worst = 0.5 * 10.0 ** -decimals_needed(bvh, 1e-4)
    # All joints are straight, and each is off about the same axis: the errors add up.
    turned = np.cumsum(np.full(199, np.radians(worst)))
    assert np.abs(25.0 * np.sum(np.exp(1j * turned)) - 25.0 * 199) < 1e-4
