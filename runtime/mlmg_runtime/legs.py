"""Which joints of a skeleton are its legs: from the names of its feet, else from the shape of its tree."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mlmg_runtime.anatomy import anatomy_from_points, upper_joint
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.skeleton import Poses, Skeleton

_FOOT = re.compile("foot|ankle", re.IGNORECASE)
# Of the thigh and the shin, one is at most so many times as long as the other.
_LONGER = 2.0


@dataclass(frozen=True, slots=True)
class Leg:
    """The joints of a leg.

    Attributes
    ----------
    hip, knee, ankle : where the thigh, the shin and the foot begin.
    toes : the next joint of the foot, or the ankle where it has none.
    """

    hip: int
    knee: int
    ankle: int
    toes: int


@dataclass(frozen=True, slots=True, eq=False)
class _Bones:
    parents: tuple[int, ...]
    lengths: FloatArray


def find_legs(skeleton: Skeleton, poses: Poses) -> tuple[Leg, ...]:
    """Return the legs of a skeleton, in the order of their joints; none for a body unlike that of a human.

    A leg has a thigh and a shin of about one length. Feet are what is called a foot or an ankle; where no two of
    those end a leg, legs are told by the shape of the tree.

    Parameters
    ----------
    poses : a few of its poses, for joints whose positions replace their offsets.
    """
    bones = _Bones(skeleton.parents, _lengths(skeleton, poses))
    named = [_leg(skeleton, bones, chain) for chain in _named_chains(skeleton, bones)]
    legs = [leg for leg in named if leg is not None and _FOOT.search(skeleton.names[leg.ankle])]
    if len(legs) < 2:
        shaped = [_leg(skeleton, bones, chain) for chain in anatomy_from_points(bones, skeleton.travel).legs]
        legs = [leg for leg in shaped if leg is not None]
    return tuple(sorted(legs, key=lambda leg: leg.hip))


def _lengths(skeleton: Skeleton, poses: Poses) -> FloatArray:
    offsets = np.array([joint.offset for joint in skeleton.joints], dtype=np.float64)
    for column, joint in enumerate(skeleton.positioned):
        offsets[joint] = np.median(poses.positions[:, column], axis=0)
    lengths = np.linalg.norm(offsets, axis=1)
    lengths[: skeleton.travel + 1] = 0.0
    return np.asarray(lengths)


def _named_chains(skeleton: Skeleton, bones: _Bones) -> list[list[int]]:
    """Return the ways from where the legs part to the tips of the feet, of all feet that are called so."""
    ways = []
    for joint in skeleton.body:
        way = [joint]
        while way[0] != skeleton.travel:
            way.insert(0, skeleton.parents[way[0]])
        if _FOOT.search(skeleton.names[joint]) and not any(_FOOT.search(skeleton.names[above]) for above in way[:-1]):
            ways.append(way)
    shared = 0
    while len(ways) > 1 and all(len(way) > shared and way[shared] == ways[0][shared] for way in ways):
        shared += 1
    for way in ways:
        while skeleton.children[way[-1]]:
            way.append(max(skeleton.children[way[-1]], key=lambda child: float(bones.lengths[child])))
    return [way[shared:] for way in ways]


def _leg(skeleton: Skeleton, bones: _Bones, chain: Sequence[int]) -> Leg | None:
    """Return the leg that a chain of joints is, from where it begins to its tip, or None if it is none."""
    start = chain.index(upper_joint(tuple(chain), bones)) if chain else 0
    if len(chain) - start < 3 or skeleton.travel in chain:
        return None
    hip, knee, ankle, *foot = chain[start:]
    thigh, shin = float(bones.lengths[knee]), float(bones.lengths[ankle])
    if not 0.0 < max(thigh, shin) <= _LONGER * min(thigh, shin):
        return None
    return Leg(hip, knee, ankle, foot[0] if foot else ankle)
