"""Between BVH documents and poses: channel orders, the up axis, a standing root, the frame rate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.bvh.document import POSITION_CHANNELS, ROTATION_CHANNELS, Bvh, Joint
from mlmg_runtime.skeleton import Poses, Skeleton, has_positions

# Turns a z-up world into a y-up one: (x, y, z) -> (x, z, -y).
_Y_UP_FROM_Z_UP = rotations.about_axis("X", np.array(-0.5 * np.pi))


def skeleton_from_bvh(bvh: Bvh) -> Skeleton:
    """Return the skeleton of a BVH file; the travel joint is given the channels that it lacks of all six.

    For it must be able to take the body anywhere, whatever way it faces.
    """
    skeleton = Skeleton(bvh.joints)
    travel = bvh.joints[skeleton.travel]
    positions = [name for name in POSITION_CHANNELS if name not in travel.channels]
    turns = [name for name in ROTATION_CHANNELS if name not in travel.channels]
    joints = list(bvh.joints)
    joints[skeleton.travel] = replace(travel, channels=(*positions, *travel.channels, *turns))
    return Skeleton(tuple(joints))


def poses_from_bvh(bvh: Bvh, up: str = "y") -> Poses:
    """Return the poses of a BVH file, y up.

    Whatever the joints above the travel joint do is folded into the travel joint, so that it alone carries
    the body.

    Parameters
    ----------
    bvh : the file; positions in its unit, angles in degrees.
    up : "y" or "z", the vertical axis of the file.
    """
    skeleton = Skeleton(bvh.joints)
    travel = skeleton.travel
    rotation = np.empty((bvh.frames.shape[0], len(bvh.joints), 4))
    position: dict[int, FloatArray] = {}
    column = 0
    for index, joint in enumerate(bvh.joints):
        values = bvh.frames[:, column : column + len(joint.channels)]
        column += len(joint.channels)
        rotation[:, index] = _local_rotation(joint, values)
        if has_positions(joint) or index <= travel:
            position[index] = _local_position(joint, values)
    _fold_above_travel(skeleton, rotation, position)
    if up == "z":
        rotation[:, travel] = rotations.multiply(_Y_UP_FROM_Z_UP, rotation[:, travel])
        position[travel] = rotations.rotate(_Y_UP_FROM_Z_UP, position[travel])
    return Poses(rotation, np.stack([position[joint] for joint in skeleton.positioned], axis=1))


def bvh_from_poses(skeleton: Skeleton, poses: Poses, frame_time_s: float, up: str = "y") -> Bvh:
    """Return poses as a BVH document with the skeleton's hierarchy and channels.

    The joints above the travel joint stand still; `up` is the vertical axis that the file is to have. Angles
    jump as little as they can from frame to frame. A joint with fewer than three rotation channels turns as
    near to its pose as they allow.
    """
    travel = skeleton.travel
    travel_rotation = poses.rotations[:, travel]
    position = {joint: poses.positions[:, column] for column, joint in enumerate(skeleton.positioned)}
    if up == "z":
        back = rotations.inverse(_Y_UP_FROM_Z_UP)
        travel_rotation = rotations.multiply(back, travel_rotation)
        position[travel] = rotations.rotate(back, position[travel])
    for joint in skeleton.joints[:travel]:
        position[travel] = position[travel] - _standing_position(joint)
    columns: list[FloatArray] = []
    for index, joint in enumerate(skeleton.joints):
        turned = travel_rotation if index == travel else poses.rotations[:, index]
        values = _channel_values(joint, turned, position.get(index))
        columns.extend(values[channel] for channel in joint.channels)
    return Bvh(skeleton.joints, frame_time_s, np.stack(columns, axis=1))


def same_rate(rate: float, other: float) -> bool:
    """Return whether two rates are one: files write 30 frames a second as 0.0333 s, and 29.97 is 30 to the eye."""
    return abs(rate - other) < 2e-3 * other


def resample(poses: Poses, rate: float, new_rate: float) -> Poses:
    """Return the same movement at another number of frames a second; both rates in frames a second.

    Frames that fall between two are blended: rotations by slerp, positions linearly. The last frame is the
    last one that still lies inside the clip.
    """
    if poses.n_frames < 2 or same_rate(rate, new_rate):
        return poses
    n_frames = int(np.floor((poses.n_frames - 1) * new_rate / rate + 1e-6)) + 1
    return sample(poses, np.arange(n_frames, dtype=np.float64) * (rate / new_rate))


def sample(poses: Poses, at_frame: FloatArray) -> Poses:
    """Return poses at fractional frames `at_frame`, shape (n,), each between 0 and n_frames - 1."""
    before = np.clip(np.floor(at_frame).astype(np.int64), 0, max(poses.n_frames - 2, 0))
    after = np.minimum(before + 1, poses.n_frames - 1)
    share = at_frame - before
    turned = rotations.slerp(poses.rotations[before], poses.rotations[after], share[:, None])
    step = poses.positions[after] - poses.positions[before]
    return Poses(turned, poses.positions[before] + share[:, None, None] * step)


def _rotation_order(joint: Joint) -> str:
    return "".join(channel[0] for channel in joint.channels if channel in ROTATION_CHANNELS)


def _local_rotation(joint: Joint, values: FloatArray) -> FloatArray:
    """Return the rotations of a joint, shape (n_frames, 4), from the values of its channels."""
    angles = [at for at, channel in enumerate(joint.channels) if channel in ROTATION_CHANNELS]
    return rotations.from_euler(_rotation_order(joint), np.radians(values[:, angles]))


def _local_position(joint: Joint, values: FloatArray) -> FloatArray:
    """Return the positions of a joint in its parent, shape (n_frames, 3): channels, or else the offset."""
    position = np.tile(np.asarray(joint.offset), (values.shape[0], 1))
    for at, channel in enumerate(joint.channels):
        if channel in POSITION_CHANNELS:
            position[:, POSITION_CHANNELS.index(channel)] = values[:, at]
    return position


def _standing_position(joint: Joint) -> FloatArray:
    """Return where a joint is in its parent when its channels are zero, shape (3,)."""
    return _local_position(joint, np.zeros((1, len(joint.channels)))).reshape(3)


def _channel_values(joint: Joint, turned: FloatArray, position: FloatArray | None) -> dict[str, FloatArray]:
    """Return a joint's channels by name, (n_frames,) each; without a `position`, those are zero."""
    order = _rotation_order(joint)
    values = dict.fromkeys(joint.channels, np.zeros(turned.shape[0]))
    if order:
        angles_deg = np.degrees(rotations.continuous_euler(rotations.to_euler(order, turned)))
        values |= {f"{axis}rotation": angles_deg[:, at] for at, axis in enumerate(order)}
    if position is not None:
        values |= {channel: position[:, at] for at, channel in enumerate(POSITION_CHANNELS)}
    return values


def _fold_above_travel(skeleton: Skeleton, rotation: FloatArray, position: dict[int, FloatArray]) -> None:
    for joint in range(skeleton.travel):
        below = joint + 1
        position[below] = position[joint] + rotations.rotate(rotation[:, joint], position[below])
        rotation[:, below] = rotations.multiply(rotation[:, joint], rotation[:, below])
        rotation[:, joint] = (1.0, 0.0, 0.0, 0.0)
        position[joint] = np.zeros_like(position[joint])
