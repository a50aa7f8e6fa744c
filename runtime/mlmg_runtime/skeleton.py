"""Skeletons: a tree of joints, which of them move by position channels, and where each is in the world."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.bvh.document import Joint


@dataclass(frozen=True)
class Skeleton:
    """A tree of joints, parents before their children.

    The *travel joint* carries the body through the world: the last joint of the chain that starts at the
    root, as long as each joint there has one child and that child has position channels. Usually it is the
    root; where a standing root lies above the hips, it is the hips. Joints above it never move.

    Attributes
    ----------
    joints : as in the BVH file; offsets in the library's length unit.
    """

    joints: tuple[Joint, ...]

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Return the joint names in order."""
        return tuple(joint.name for joint in self.joints)

    @cached_property
    def parents(self) -> tuple[int, ...]:
        """Return the index of each joint's parent, -1 for the root."""
        return tuple(joint.parent for joint in self.joints)

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """Return the indices of each joint's children."""
        children: list[list[int]] = [[] for _ in self.joints]
        for index, parent in enumerate(self.parents):
            if parent >= 0:
                children[parent].append(index)
        return tuple(map(tuple, children))

    @cached_property
    def travel(self) -> int:
        """Return the index of the joint that carries the body through the world."""
        joint = 0
        while len(self.children[joint]) == 1 and has_positions(self.joints[self.children[joint][0]]):
            joint = self.children[joint][0]
        return joint

    @cached_property
    def positioned(self) -> tuple[int, ...]:
        """Return the joints whose local position changes: the travel joint, and others by channels."""
        others = (joint for joint in self.body[1:] if has_positions(self.joints[joint]))
        return (self.travel, *others)

    @cached_property
    def body(self) -> tuple[int, ...]:
        """Return the joints from the travel joint down: what moves."""
        return tuple(range(self.travel, len(self.joints)))

    def subtree(self, joint: int) -> frozenset[int]:
        """Return `joint` and all joints below it."""
        found = {joint}
        for index in range(joint + 1, len(self.joints)):
            if self.parents[index] in found:
                found.add(index)
        return frozenset(found)


@dataclass(frozen=True, slots=True, eq=False)
class Poses:
    """Poses of a skeleton, one a frame; y up, the library's length unit.

    Attributes
    ----------
    rotations : array, shape (n_frames, n_joints, 4). Local rotations, unit quaternions (w, x, y, z).
    positions : array, shape (n_frames, len(skeleton.positioned), 3). Local positions of those joints; that of
        the travel joint, the first, is its position in the world.
    """

    rotations: FloatArray
    positions: FloatArray

    @property
    def n_frames(self) -> int:
        """Return the number of frames."""
        return int(self.rotations.shape[0])

    def __getitem__(self, frames: slice) -> Poses:
        """Return some of the frames, sharing memory."""
        return Poses(self.rotations[frames], self.positions[frames])


def has_positions(joint: Joint) -> bool:
    """Return whether the joint has position channels, which replace its offset."""
    return any(channel.endswith("position") for channel in joint.channels)


def world_positions(skeleton: Skeleton, poses: Poses) -> FloatArray:
    """Return the joints' positions in the world, shape (n_frames, n_joints, 3): forward kinematics."""
    return world_transforms(skeleton, poses)[1]


def world_transforms(skeleton: Skeleton, poses: Poses) -> tuple[FloatArray, FloatArray]:
    """Return world rotations, shape (n_frames, n_joints, 4), and positions, shape (n_frames, n_joints, 3).

    Joints above the travel joint stand at the origin, unturned, whatever their offsets say: a pose holds the
    travel joint's place in the world.
    """
    n_frames, n_joints = poses.rotations.shape[:2]
    world_rotation = np.empty((n_frames, n_joints, 4))
    world_position = np.empty((n_frames, n_joints, 3))
    travel = skeleton.travel
    world_rotation[:, :travel] = (1.0, 0.0, 0.0, 0.0)
    world_position[:, :travel] = 0.0
    local = {joint: poses.positions[:, column] for column, joint in enumerate(skeleton.positioned)}
    world_rotation[:, travel] = poses.rotations[:, travel]
    world_position[:, travel] = local[travel]
    for joint in range(travel + 1, n_joints):
        parent = skeleton.parents[joint]
        offset = local.get(joint, np.asarray(skeleton.joints[joint].offset))
        world_rotation[:, joint] = rotations.multiply(world_rotation[:, parent], poses.rotations[:, joint])
        moved = rotations.rotate(world_rotation[:, parent], offset)
        world_position[:, joint] = world_position[:, parent] + moved
    return world_rotation, world_position


def carried_positions(
    skeleton: Skeleton, world_rotation: FloatArray, world_position: FloatArray, joints: Sequence[int]
) -> FloatArray:
    """Return where joints of a body part are as seen from what carries them, shape (n_frames, len(joints), 3).

    A joint is carried by the nearest joint above it that is not one of them; it is seen in that one's frame.

    Parameters
    ----------
    world_rotation, world_position : of all joints, from `world_transforms`.
    joints : of the part; not the travel joint, which nothing carries.
    """
    carriers = []
    for joint in joints:
        carrier = skeleton.parents[joint]
        while carrier in joints:
            carrier = skeleton.parents[carrier]
        carriers.append(carrier)
    away = world_position[:, list(joints)] - world_position[:, carriers]
    return rotations.rotate(rotations.inverse(world_rotation[:, carriers]), away)
