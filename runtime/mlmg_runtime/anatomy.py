"""Which points of a body are legs, trunk, arms and head, told from the shape of its tree alone.

Joint names differ between programs and languages; the tree of a human body does not: it forks at the hips
into legs and trunk, and at the chest into arms and head.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

from mlmg_runtime.arrays import FloatArray

_FULL_SHARE = 0.5  # A branch at least half as long as the longest beside it is a limb; a shorter one is an extra.
_UPPER_SHARE = 0.8  # The first bone nearly as long as the longest is the upper arm, what comes before it the shoulder.


class Bones(Protocol):
    """A tree of points, joints or joints and tips, and how far each is from its parent."""

    @property
    def parents(self) -> tuple[int, ...]:
        """Return the index of each point's parent, -1 for the root; parents stand before their children."""
        ...

    @property
    def lengths(self) -> FloatArray:
        """Return the distances from the parents, shape (n_points,)."""
        ...


@dataclass(frozen=True, slots=True)
class Anatomy:
    """The parts of a body, each as a chain of points from where it begins to its tip.

    Attributes
    ----------
    trunk : from the hips to the chest, both included; at least the hips.
    legs, arms : the limbs that were found, none for a body unlike a human's.
    head : from the base of the neck to the crown, or empty.
    reach : for each point, the length of the longest way from it to a tip below it.
    """

    trunk: tuple[int, ...]
    legs: tuple[tuple[int, ...], ...]
    arms: tuple[tuple[int, ...], ...]
    head: tuple[int, ...]
    reach: tuple[float, ...]

    @property
    def hips(self) -> int:
        """Return the point where the legs begin."""
        return self.trunk[0]

    @property
    def chest(self) -> int:
        """Return the point where the arms begin."""
        return self.trunk[-1]

    @property
    def is_human(self) -> bool:
        """Return whether there are two legs, two arms and a head."""
        return len(self.legs) == 2 and len(self.arms) == 2 and bool(self.head)


def anatomy_from_points(points: Bones, travel: int) -> Anatomy:
    """Return the parts of the body that hangs below the point `travel`."""
    tree = _Tree(points)
    hips = travel
    while len(tree.children[hips]) == 1:
        hips = tree.children[hips][0]
    if not tree.children[hips]:
        return Anatomy((travel,), (), (), (), tree.reach)
    first = max(tree.children[hips], key=lambda child: (tree.n_below[child], tree.span(child)))
    legs = tree.limbs([child for child in tree.children[hips] if child != first])
    trunk = [hips, first]
    while len(tree.long_children(trunk[-1])) == 1:
        trunk.append(tree.long_children(trunk[-1])[0])
    branches = sorted(tree.children[trunk[-1]], key=tree.span, reverse=True)
    arms = tuple(sorted(branches[:2]))
    if len(arms) < 2:
        return Anatomy((hips,), (), (), (), tree.reach)
    return Anatomy(
        tuple(trunk),
        tuple(tree.chain(leg) for leg in legs),
        tuple(tree.chain(arm) for arm in arms),
        tree.chain(branches[2]) if len(branches) > 2 else (),
        tree.reach,
    )


def upper_joint(chain: tuple[int, ...], points: Bones) -> int:
    """Return the point of a limb where its upper bone begins: the shoulder of an arm, the hip of a leg."""
    bones = chain[1:]
    longest = max((points.lengths[bone] for bone in bones), default=0.0)
    for start, bone in zip(chain, bones, strict=False):
        if points.lengths[bone] >= _UPPER_SHARE * longest:
            return start
    return chain[0]


class _Tree:
    """What is asked of a tree of points again and again."""

    def __init__(self, points: Bones) -> None:
        self.lengths = points.lengths
        self.children: list[list[int]] = [[] for _ in points.parents]
        for point, parent in enumerate(points.parents):
            if parent >= 0:
                self.children[parent].append(point)
        self._parents = points.parents

    @cached_property
    def reach(self) -> tuple[float, ...]:
        """Return for each point the longest way down from it."""
        reach = [0.0] * len(self.children)
        for point, parent in reversed(list(enumerate(self._parents))):
            if parent >= 0:
                reach[parent] = max(reach[parent], float(self.lengths[point]) + reach[point])
        return tuple(reach)

    @cached_property
    def n_below(self) -> tuple[int, ...]:
        """Return for each point how many points its subtree holds."""
        count = [1] * len(self.children)
        for point, parent in reversed(list(enumerate(self._parents))):
            if parent >= 0:
                count[parent] += count[point]
        return tuple(count)

    def span(self, point: int) -> float:
        """Return the longest way from a point's parent through it to a tip."""
        return float(self.lengths[point]) + self.reach[point]

    def long_children(self, point: int) -> list[int]:
        """Return the children that are no mere extras."""
        longest = max((self.span(child) for child in self.children[point]), default=0.0)
        return [child for child in self.children[point] if self.span(child) >= _FULL_SHARE * longest]

    def limbs(self, roots: list[int]) -> list[int]:
        """Return the longest branches; a lone root that forks (a pelvis bone) stands for its children."""
        longest = max((self.span(root) for root in roots), default=0.0)
        limbs = [root for root in roots if self.span(root) >= _FULL_SHARE * longest]
        while len(limbs) == 1 and self.children[limbs[0]]:
            limbs = self.long_children(limbs[0])
        return limbs if len(limbs) > 1 else []

    def chain(self, point: int) -> tuple[int, ...]:
        """Return the points of the longest way from `point` to a tip, from above a limb's first bone down."""
        chain = [point]
        while self.children[chain[-1]]:
            chain.append(max(self.children[chain[-1]], key=self.span))
        return tuple(chain)
