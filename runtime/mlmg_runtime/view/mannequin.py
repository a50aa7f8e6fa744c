"""A mannequin around a skeleton: tapered capsules, each the hull of two balls.

Measures are in metres for a body 1.7 m tall, and scaled to the body at hand. They are given along a limb as
a share of its length, so that any skeleton gets limbs that taper, whatever bones it divides them into.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mlmg_runtime.anatomy import Anatomy, upper_joint
from mlmg_runtime.view.points import Points

BODY_HEIGHT = 1.7

# Radius against the way that is left to the tip, as a share of the limb from shoulder or hip down.
_ARM = ((0.0, 0.05, 0.13, 0.24, 0.56, 1.0, 1.4), (0.022, 0.030, 0.033, 0.028, 0.037, 0.050, 0.050))
_LEG = ((0.0, 0.06, 0.19, 0.58, 1.0, 1.3), (0.024, 0.032, 0.040, 0.054, 0.080, 0.085))
_MITTEN_TIPS = 3  # A hand with more tips than these has fingers of its own.
_FINGER = ((0.0, 0.05, 0.10, 0.17, 0.24), (0.0075, 0.009, 0.011, 0.018, 0.026))
_BULGE_AT, _BULGE, _BULGE_LENGTH = 0.3, 1.08, 0.15  # Muscles of the long bones.
_NECK_TO_CROWN = 0.27
_CROWN_TO_CENTRE = 0.118
_OTHER = 0.03


@dataclass(frozen=True, slots=True)
class Ball:
    """A ball on the line through two points of a scene, at a + share * (b - a); radius in metres."""

    a: int
    b: int
    share: float
    radius: float


@dataclass(frozen=True, slots=True)
class Capsule:
    """The hull of two balls; `joint` is the joint whose rotation moves it."""

    first: Ball
    second: Ball
    joint: int


def body_height(points: Points, anatomy: Anatomy) -> float:
    """Return about how tall a body is, from its bones alone: all clips of one skeleton agree."""
    if not anatomy.is_human:
        return 1.2 * anatomy.reach[anatomy.hips]
    leg = max(anatomy.reach[leg[0]] + float(points.lengths[leg[0]]) for leg in anatomy.legs)
    spine = sum(float(points.lengths[point]) for point in (*anatomy.trunk[1:], anatomy.head[0]))
    return 1.12 * (leg + spine)


def mannequin(points: Points, anatomy: Anatomy, heels: tuple[int, ...], jaw: int | None) -> tuple[Capsule, ...]:
    """Return the capsules of a body.

    Parameters
    ----------
    points : joints and tips; lengths in metres.
    heels : a point for each leg of the anatomy.
    jaw : the middle of the jaw; both only for a human body.
    """
    return tuple(_Builder(points, anatomy).capsules(heels, jaw))


def skull_share(points: Points, anatomy: Anatomy) -> float:
    """Return where the middle of the skull is, as a share of the way from the head joint to its tip.

    A head that the file cuts short is given its height.
    """
    size = body_height(points, anatomy) / BODY_HEIGHT
    neck = sum(float(points.lengths[point]) for point in anatomy.head[1:-1]) / size
    bone = max(float(points.lengths[anatomy.head[-1]]) / size, 1e-6)
    return (max(bone, _NECK_TO_CROWN - neck) - _CROWN_TO_CENTRE) / bone


class _Builder:
    """Lays capsules around one body."""

    def __init__(self, points: Points, anatomy: Anatomy) -> None:
        self.points = points
        self.anatomy = anatomy
        self.size = body_height(points, anatomy) / BODY_HEIGHT
        self.radii = self._radii()

    def capsules(self, heels: tuple[int, ...], jaw: int | None) -> Iterator[Capsule]:
        if not self.anatomy.is_human or jaw is None:
            yield from self._bones(range(len(self.points.parents)))
            return
        own = {*self.anatomy.trunk, *self.anatomy.head, *heels, jaw}
        limbs = [point for point in range(len(self.points.parents)) if point not in own]
        yield from self._bones(point for point in limbs if self._is_limb(point))
        yield from self._trunk()
        yield from self._head(jaw)
        for leg, heel in zip(self.anatomy.legs, heels, strict=True):
            yield from self._foot(leg, heel)

    def _ball(self, a: int, b: int, share: float, radius: float) -> Ball:
        return Ball(a, b, share, radius * self.size)

    def _radii(self) -> dict[int, float]:
        """Return the radius at each point below the root of a limb, in metres of this body."""
        radii = {}
        for limbs, profile in ((self.anatomy.arms, _ARM), (self.anatomy.legs, _LEG)):
            for limb in limbs:
                below = self._subtree(limb[0])
                whole = max(self.anatomy.reach[upper_joint(limb, self.points)], 1e-9)
                tips = sum(1 for point in below if self.anatomy.reach[point] == 0.0)
                fingers = limbs is self.anatomy.arms and tips > _MITTEN_TIPS
                for point in below:
                    left = self.anatomy.reach[point] / whole
                    table = _FINGER if fingers and left < _FINGER[0][-1] else profile
                    radii[point] = float(np.interp(left, *table)) * self.size
        return radii

    def _subtree(self, root: int) -> list[int]:
        below = {root}
        for point, parent in enumerate(self.points.parents[: len(self.anatomy.reach)]):
            if parent in below:
                below.add(point)
        return sorted(below)

    def _is_limb(self, point: int) -> bool:
        return point in self.radii and self.points.parents[point] in self.radii

    def _bones(self, ends: Iterator[int] | range) -> Iterator[Capsule]:
        """Yield each bone as one capsule, or as two with a bulge between, if it is a long bone of a limb."""
        for point in ends:
            parent = self.points.parents[point]
            length = float(self.points.lengths[point])
            if parent < 0 or length < 0.004 * self.size:
                continue
            first = Ball(parent, point, 0.0, self.radii.get(parent, _OTHER * self.size))
            last = Ball(parent, point, 1.0, self.radii.get(point, _OTHER * self.size))
            if length < _BULGE_LENGTH * self.size or parent not in self.radii:
                yield Capsule(first, last, parent)
                continue
            middle = Ball(parent, point, _BULGE_AT, _BULGE * (first.radius + _BULGE_AT * (last.radius - first.radius)))
            yield Capsule(first, middle, parent)
            yield Capsule(middle, last, parent)

    def _trunk(self) -> Iterator[Capsule]:
        anatomy, ball = self.anatomy, self._ball
        hip_l, hip_r = (upper_joint(leg, self.points) for leg in anatomy.legs)
        arm_l, arm_r = (upper_joint(arm, self.points) for arm in anatomy.arms)
        hips, chest, neck = anatomy.hips, anatomy.chest, anatomy.head[0]
        waist = self._waist()
        middle = ball(*waist, 0.088)
        yield Capsule(ball(hip_l, hip_r, 0.08, 0.088), ball(hip_l, hip_r, 0.92, 0.088), hips)
        for share in (0.3, 0.7):
            yield Capsule(ball(hip_l, hip_r, share, 0.092), middle, hips)
            yield Capsule(middle, ball(arm_l, arm_r, share, 0.078), chest)
        for arm, other in ((arm_l, arm_r), (arm_r, arm_l)):
            yield Capsule(ball(arm, other, 0.02, 0.052), ball(arm, other, 0.32, 0.076), chest)
            yield Capsule(ball(arm, other, 0.03, 0.046), ball(neck, neck, 0.0, 0.046), chest)

    def _waist(self) -> tuple[int, int, float]:
        """Return the place 40 % of the way from the hips to the neck, as two points and a share."""
        way = (*self.anatomy.trunk, self.anatomy.head[0])
        steps = [float(self.points.lengths[point]) for point in way[1:]]
        left = 0.40 * sum(steps)
        for start, end, step in zip(way, way[1:], steps, strict=False):
            if left <= step:
                return start, end, left / max(step, 1e-9)
            left -= step
        return way[-2], way[-1], 1.0

    def _head(self, jaw: int) -> Iterator[Capsule]:
        ball = self._ball
        base, (joint, tip) = self.anatomy.head[0], self.anatomy.head[-2:]
        centre = skull_share(self.points, self.anatomy)
        bone = max(float(self.points.lengths[tip]) / self.size, 1e-6)
        skull = ball(joint, tip, centre, 0.082)
        yield Capsule(ball(base, base, 0.0, 0.050), ball(joint, tip, centre - 0.05 / bone, 0.044), base)
        yield Capsule(skull, ball(joint, tip, centre + 0.030 / bone, 0.086), joint)
        yield Capsule(skull, ball(jaw, jaw, 0.0, 0.052), joint)

    def _foot(self, leg: tuple[int, ...], heel: int) -> Iterator[Capsule]:
        joint = self.points.parents[heel]
        toes = leg[leg.index(joint) + 1]
        behind = self._ball(heel, heel, 0.0, 0.036)
        ball_of_foot = Ball(toes, toes, 0.0, self.radii[toes])
        yield Capsule(behind, ball_of_foot, joint)
        yield Capsule(self._ball(joint, heel, 0.55, 0.042), self._ball(joint, toes, 0.75, 0.037), joint)
        yield Capsule(Ball(joint, joint, 0.0, self.radii[joint]), behind, joint)
