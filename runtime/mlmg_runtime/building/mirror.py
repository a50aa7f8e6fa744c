"""A clip seen in a mirror: what the left side did, the right side does."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from mlmg_runtime import rotations
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.skeleton import Poses, Skeleton, world_transforms

_SIDE = re.compile(r"(?i:left|right)|(?<![A-Za-z])[lrLR](?![A-Za-z])|^[LR](?=[A-Z])")
_OTHER = {"left": "right", "right": "left", "l": "r", "r": "l"}


def mirrored(skeleton: Skeleton, poses: Poses) -> Poses:
    """Return poses mirrored in the plane x = 0, left and right joints by their names changing places.

    Whatever the local frames of the two sides look like, each joint is turned so that its bones point where the
    mirrored bones of its partner point.
    """
    partners = partner_joints(skeleton)
    world, position = world_transforms(skeleton, poses)
    reflected = world[:, list(partners)] * np.array([1.0, 1.0, -1.0, -1.0])
    turned = np.stack(
        [rotations.multiply(reflected[:, j], _frame_change(skeleton, j, p)) for j, p in enumerate(partners)],
        axis=1,
    )
    local = turned.copy()
    for joint in range(skeleton.travel + 1, len(skeleton.joints)):
        local[:, joint] = rotations.multiply(rotations.inverse(turned[:, skeleton.parents[joint]]), turned[:, joint])
    moved = poses.positions.copy()
    moved[:, 0] = position[:, skeleton.travel] * np.array([-1.0, 1.0, 1.0])
    return Poses(local, moved)


def partner_joints(skeleton: Skeleton) -> tuple[int, ...]:
    """Return for each joint the one of the other side: left for right by name, itself where there is none."""
    index = {name: joint for joint, name in enumerate(skeleton.names)}
    return tuple(
        next((index[other] for other in _other_side(name) if other in index), joint) for name, joint in index.items()
    )


def _other_side(name: str) -> Iterator[str]:
    """Yield the name with one of the words or letters that may tell the side exchanged."""
    for match in _SIDE.finditer(name):
        found = match[0]
        other = _OTHER[found.lower()]
        other = other.upper() if found.isupper() else other.capitalize() if found[0].isupper() else other
        yield name[: match.start()] + other + name[match.end() :]


def _frame_change(skeleton: Skeleton, joint: int, partner: int) -> FloatArray:
    """Return the turn that carries the bones of `joint` onto the mirrored bones of `partner`, in mirrored frames."""
    from scipy.spatial.transform import Rotation

    own = [skeleton.joints[child].offset for child in skeleton.children[joint]]
    partners = partner_joints(skeleton)
    other = [
        np.multiply(skeleton.joints[partners[child]].offset, (-1.0, 1.0, 1.0)) for child in skeleton.children[joint]
    ]
    lengths = np.linalg.norm(own, axis=1) if own else np.empty(0)
    if not own or lengths.max() < 1e-9:
        return np.array([1.0, 0.0, 0.0, 0.0])
    if len(own) == 1 or np.linalg.matrix_rank(np.asarray(own), tol=1e-6) == 1:
        best = int(lengths.argmax())
        turn, _ = Rotation.align_vectors(other[best][None], np.asarray(own[best])[None])
    else:
        turn, _ = Rotation.align_vectors(np.asarray(other), np.asarray(own))
    return np.asarray(turn.as_quat(scalar_first=True), dtype=np.float64)
