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
# What the mirror makes of a rotation (w, x, y, z): the reflection in x = 0 before and after it.
_REFLECTION = np.array([1.0, 1.0, -1.0, -1.0])
_UNTURNED = np.array([1.0, 0.0, 0.0, 0.0])
# With the reflection in x = 0 these make that in each of the three planes, and that in the origin.
_HALF_TURNS = np.eye(4)
# Bones shorter than this point nowhere; those that spread less across than this, against along, point one way.
_NO_BONE = 1e-9
_ONE_WAY = 0.05
# What the pose of rest counts, against all frames together.
_RESTING = 0.5
# Bones of both sides are unlike if one, mirrored, is farther from the other than this, against the longest of the body.
_UNLIKE = 0.25


def mirrored(skeleton: Skeleton, poses: Poses) -> Poses:
    """Return poses mirrored in the plane x = 0, left and right joints by their names changing places.

    Whatever the local frames of the two sides look like, each joint is turned so that its bones point where the
    mirrored bones of its partner point. How it then lies about its bones is told by the poses: its local rotations
    are like those of its partner, not half a turn from them, so that mirrored poses blend with others.

    Raises
    ------
    ValueError
        If the two sides of the skeleton are not alike.
    """
    partners = partner_joints(skeleton)
    changes = _frame_changes(skeleton, poses)
    world, position = world_transforms(skeleton, poses)
    reflected = world[:, list(partners)] * _REFLECTION
    turned = rotations.multiply(reflected, changes)
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


def _frame_changes(skeleton: Skeleton, poses: Poses) -> FloatArray:
    """Return for each joint the turn C for which the mirrored rotation of its partner, times C, is its own.

    Shape (n_joints, 4). Bones that point two ways determine C. Where there is one, two turns are possible, half a turn
    about it apart; where there is none, the frames of the two sides mirror each other in one of their own planes, or in
    all three. Of the possible ones that is taken after which the local rotations of the joint are most like what they
    were, by the square of the quaternions' product: its mean over all frames, to which the pose of rest, with no
    rotation, adds as much as half of them, for an arm may be raised all the time, and the other not.
    """
    partners, n_joints = partner_joints(skeleton), len(skeleton.joints)
    changes = np.tile(_UNTURNED, (n_joints, 1))
    possible = [_possible_changes(skeleton, joint) for joint in range(n_joints)]
    # The uppermost joint has no parent to be seen from: its frame is taken to lie as the next below that is determined.
    below = next((found[0] for found in possible[skeleton.travel :] if len(found) == 1), _UNTURNED)
    for joint in skeleton.body:
        found = possible[joint]
        if joint == skeleton.travel:
            likeness = np.abs(found @ below)
        else:
            above = changes[skeleton.parents[joint]]
            local = rotations.multiply(rotations.inverse(above), poses.rotations[:, partners[joint]] * _REFLECTION)
            asked = rotations.multiply(rotations.inverse(local), poses.rotations[:, joint])
            likeness = np.mean((asked @ found.T) ** 2, axis=0) + _RESTING * (found @ above) ** 2
        changes[joint] = found[likeness.argmax()]
    return changes


def _possible_changes(skeleton: Skeleton, joint: int) -> FloatArray:
    """Return the turns that carry the bones of `joint` onto the mirrored ones of its partner, shape (n, 4)."""
    from scipy.spatial.transform import Rotation

    partners = partner_joints(skeleton)
    children = [c for c in skeleton.children[joint] if skeleton.parents[partners[c]] == partners[joint]]
    own = np.array([skeleton.joints[c].offset for c in children]).reshape(-1, 3)
    other = np.array([skeleton.joints[partners[c]].offset for c in children]).reshape(-1, 3) * (-1.0, 1.0, 1.0)
    spread = np.linalg.svd(own, compute_uv=False)
    lengths = np.minimum(np.linalg.norm(own, axis=1), np.linalg.norm(other, axis=1))
    if not len(spread) or lengths.max() < _NO_BONE:
        found = _HALF_TURNS
    elif len(spread) > 1 and spread[1] > _ONE_WAY * spread[0]:
        turn, _ = Rotation.align_vectors(other, own)
        found = np.asarray(turn.as_quat(scalar_first=True))[None]
    else:
        longest = int(lengths.argmax())
        found = _two_turns(own[longest], other[longest])
    longest_bone = max(float(np.linalg.norm(skeleton.joints[j].offset)) for j in skeleton.body)
    if np.linalg.norm(rotations.rotate(found[0], own) - other) > _UNLIKE * longest_bone:
        names = dict.fromkeys(skeleton.names[j] for j in (joint, partners[joint]))
        below = " and ".join(f"`{name}`" for name in names)
        raise ValueError(f"the bones below {below} do not mirror each other; expected the OFFSETs of two like sides")
    return found


def _two_turns(bone: FloatArray, other: FloatArray) -> FloatArray:
    """Return the turns that carry one bone to where another points, shape (2, 4): half a turn about that apart."""
    axis = bone / np.linalg.norm(bone)
    rough = rotations.rotate(_HALF_TURNS, axis)
    # Rounded, so that of two half turns that come equally near the same is found for both sides.
    nearest = int(np.round(rough @ other / np.linalg.norm(other), 6).argmax())
    turn = rotations.multiply(rotations.between(rough[nearest], other), _HALF_TURNS[nearest])
    return np.stack((turn, rotations.multiply(turn, np.array([0.0, *axis]))))
