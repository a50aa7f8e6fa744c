"""Between BVH documents and poses: channel orders, the up axis, a standing root, the frame rate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.bvh.document import POSITION_CHANNELS, Bvh, Joint
from mlmg_runtime.skeleton import Poses, Skeleton, has_positions

# Turns a z-up world into a y-up one: (x, y, z) -> (x, z, -y).
_Y_UP_FROM_Z_UP = rotations.about_axis("X", np.array(-0.5 * np.pi))


def skeleton_from_bvh(bvh: Bvh) -> Skeleton:
    """Return the skeleton of a BVH file; a travel joint without position channels is given them."""
    skeleton = Skeleton(bvh.joints)
    travel = skeleton.joints[skeleton.travel]
    if has_positions(travel):
        return skeleton
    joints = list(bvh.joints)
    joints[skeleton.travel] = replace(travel, channels=(*POSITION_CHANNELS, *travel.channels))
    return Skeleton(tuple(joints))


def poses_from_bvh(bvh: Bvh, up: str = "y") -> Poses:
    """Return the poses of a BVH file, y up.

    Whatever the joints above the travel joint do is folded into the travel joint, so that it alone carries the body.

    Parameters
    ----------
    bvh : the file; positions in its unit, angles in degrees.
    up : "y" or "z", the vertical axis of the file.
    """
    skeleton = Skeleton(bvh.joints)
    n_frames = bvh.frames.shape[0]
    local_rotation = np.empty((n_frames, len(bvh.joints), 4))
    local_position: dict[int, FloatArray] = {}
    column = 0
    for index, joint in enumerate(bvh.joints):
        values = bvh.frames[:, column : column + len(joint.channels)]
        column += len(joint.channels)
        order = _rotation_order(joint)
        angles = [values[:, at] for at, name in enumerate(joint.channels) if name.endswith("rotation")]
        angles_rad = np.radians(np.stack(angles, axis=-1)) if angles else np.empty((n_frames, 0))
        local_rotation[:, index] = rotations.from_euler(order, angles_rad)
        if has_positions(joint) or index <= skeleton.travel:
            position = np.tile(np.asarray(joint.offset), (n_frames, 1))
            for at, name in enumerate(joint.channels):
                if name in POSITION_CHANNELS:
                    position[:, POSITION_CHANNELS.index(name)] = values[:, at]
            local_position[index] = position
    _fold_above_travel(skeleton, local_rotation, local_position)
    if up == "z":
        travel = skeleton.travel
        local_rotation[:, travel] = rotations.multiply(_Y_UP_FROM_Z_UP, local_rotation[:, travel])
        local_position[travel] = rotations.rotate(_Y_UP_FROM_Z_UP, local_position[travel])
    positions = np.stack([local_position[joint] for joint in skeleton.positioned], axis=1)
    return Poses(local_rotation, positions)


def bvh_from_poses(skeleton: Skeleton, poses: Poses, frame_time_s: float, up: str = "y") -> Bvh:
    """Return poses as a BVH document with the skeleton's hierarchy and channels; angles are continuous in time.

    The joints above the travel joint stand still; `up` is the vertical axis that the file is to have.
    """
    n_frames = poses.n_frames
    travel = skeleton.travel
    local_rotation = poses.rotations
    local_position = {joint: poses.positions[:, column] for column, joint in enumerate(skeleton.positioned)}
    if up == "z":
        back = rotations.inverse(_Y_UP_FROM_Z_UP)
        local_rotation = local_rotation.copy()
        local_rotation[:, travel] = rotations.multiply(back, local_rotation[:, travel])
        local_position[travel] = rotations.rotate(back, local_position[travel])
    above = [joint for joint in skeleton.joints[:travel] if not has_positions(joint)]
    local_position[travel] = local_position[travel] - np.sum([joint.offset for joint in above] or [(0.0, 0.0, 0.0)], axis=0)
    columns: list[FloatArray] = []
    for index, joint in enumerate(skeleton.joints):
        angles = _angles_deg(joint, local_rotation[:, index]) if _rotation_order(joint) else {}
        for channel in joint.channels:
            if channel in POSITION_CHANNELS:
                position = local_position.get(index)
                columns.append(np.zeros(n_frames) if position is None else position[:, POSITION_CHANNELS.index(channel)])
            else:
                columns.append(angles[channel])
    return Bvh(skeleton.joints, frame_time_s, np.stack(columns, axis=1))


def resample(poses: Poses, rate: float, new_rate: float) -> Poses:
    """Return the same movement at another number of frames a second; both rates in frames a second.

    Frames that fall between two are blended: rotations by slerp, positions linearly. The last frame is the last one
    that still lies inside the clip.
    """
    if poses.n_frames < 2 or abs(rate - new_rate) < 1e-3 * new_rate:
        return poses
    n_frames = int(np.floor((poses.n_frames - 1) * new_rate / rate + 1e-6)) + 1
    return sample(poses, np.arange(n_frames) * (rate / new_rate))


def sample(poses: Poses, at_frame: FloatArray) -> Poses:
    """Return poses at fractional frames `at_frame`, shape (n,), each between 0 and n_frames - 1."""
    before = np.clip(np.floor(at_frame).astype(np.int64), 0, max(poses.n_frames - 2, 0))
    after = np.minimum(before + 1, poses.n_frames - 1)
    share = at_frame - before
    turned = rotations.slerp(poses.rotations[before], poses.rotations[after], share[:, None])
    moved = poses.positions[before] + share[:, None, None] * (poses.positions[after] - poses.positions[before])
    return Poses(turned, moved)


def _rotation_order(joint: Joint) -> str:
    return "".join(channel[0] for channel in joint.channels if channel.endswith("rotation"))


def _angles_deg(joint: Joint, local: FloatArray) -> dict[str, FloatArray]:
    """Return the joint's rotation channels by name; axes without a channel are taken to be last, and left out."""
    order = _rotation_order(joint)
    full_order = order + "".join(axis for axis in "XYZ" if axis not in order)
    angles = rotations.continuous_degrees(np.degrees(rotations.to_euler(full_order, local)))
    return {f"{axis}rotation": angles[:, at] for at, axis in enumerate(order)}


def _fold_above_travel(skeleton: Skeleton, rotation: FloatArray, position: dict[int, FloatArray]) -> None:
    for joint in range(skeleton.travel):
        below = joint + 1
        position[below] = position[joint] + rotations.rotate(rotation[:, joint], position[below])
        rotation[:, below] = rotations.multiply(rotation[:, joint], rotation[:, below])
        rotation[:, joint] = (1.0, 0.0, 0.0, 0.0)
        position[joint] = np.zeros_like(position[joint])
