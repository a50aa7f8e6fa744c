"""When a foot goes over from the motion that is left to the motion that is entered, and whether it is dragged then."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mlmg_runtime.arrays import BoolArray, FloatArray

# What haste in going over weighs, and what it weighs to be astray, against being dragged so far.
_HASTE = 0.3
_ASTRAY = 6.0
# The share of the time of going over in which a foot gets faster, and in which it gets slower again.
_RAMP = 0.25
# So many moments are tried for a foot to set out and to arrive, at most.
_MOST_MOMENTS = 24


@dataclass(frozen=True, slots=True, eq=False)
class FootPath:
    """A foot in one of the windows of each of n transitions of k frames, with the frame before.

    Attributes
    ----------
    places : array, shape (n, k + 1, 3). Where its toes are in the world.
    planted : array, shape (n, k + 1).
    """

    places: FloatArray
    planted: BoolArray

    @property
    def stands(self) -> BoolArray:
        """Return whether the foot is planted before and after each step, shape (n, k)."""
        return np.asarray(self.planted[:, 1:] & self.planted[:, :-1])


def foot_weights(left: FootPath, entered: FootPath, body: FloatArray, far: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the weight of the motion that is left for a foot, and how far it goes over while it is planted.

    The weight falls from 1 to 0 in that part of the transition in which the sum of three lengths is least: how far the
    foot moves over the ground in the share of the motions in which it is planted; its haste, 0.3 times the mean of
    v^2 / far, with v the speed at which it goes from the one motion to the other, in lengths a transition; and 6 times
    the mean of x^4 / far^3, with x how far it is astray from where the body's blend would have it. So a foot that
    stands in a motion stays where that has it, and goes over in the air if it can; else as slowly as a transition may.

    Parameters
    ----------
    body : array, shape (k + 1,). The weight of the motion that is left for the body, 1 before the transition.
    far : array, shape (n,). How far a foot may well be astray.

    Returns
    -------
    array, shape (n, k), and array, shape (n,), in lengths.
    """
    n_steps = len(body) - 1
    tried = _falls(n_steps)
    apart = np.linalg.norm(left.places - entered.places, axis=-1)
    gap = 0.5 * (apart[:, 1:] + apart[:, :-1])
    cost = np.stack([_dragged(left, entered, weight) for weight in tried], axis=1) / far[:, None]
    cost += _HASTE * n_steps * (gap / far[:, None]) ** 2 @ (np.diff(tried) ** 2).T
    cost += _ASTRAY / n_steps * (apart / far[:, None]) ** 4 @ ((tried - body) ** 4).T
    # Rounded, so that among equals it is the longest, whatever the order in which a product is summed.
    weight = tried[cost.round(9).argmin(axis=1)]
    return weight[:, 1:], np.sum(_on_ground(left, entered, weight) * gap * -np.diff(weight), axis=1)


def _dragged(left: FootPath, entered: FootPath, weight: FloatArray) -> FloatArray:
    """Return how far feet move over the ground in the share of the motions in which they are planted, shape (n,)."""
    places = entered.places + weight[:, None] * (left.places - entered.places)
    steps = np.hypot(*np.moveaxis(np.diff(places[..., ::2], axis=1), -1, 0))
    return np.asarray(np.sum(_on_ground(left, entered, weight) * steps, axis=1))


def _on_ground(left: FootPath, entered: FootPath, weight: FloatArray) -> FloatArray:
    """Return the share of the two motions in which a foot is planted, for each step; `weight` (..., k + 1)."""
    share = 0.5 * (weight[..., 1:] + weight[..., :-1])
    return np.asarray(share * left.stands + (1.0 - share) * entered.stands)


def _falls(n_steps: int) -> FloatArray:
    """Return the ways to fall from 1 to 0 that are tried, each from some moment to some other: (n, n_steps + 1)."""
    moments = np.unique(np.linspace(0, n_steps, min(n_steps, _MOST_MOMENTS) + 1).round())
    begin, end = np.array([(a, b) for a in moments for b in moments[::-1] if a < b]).T[:, :, None]
    share = np.clip((np.arange(n_steps + 1) - begin) / (end - begin), 0.0, 1.0)
    rest = np.minimum(share, 1.0 - share)
    eased = np.where(rest < _RAMP, rest**2 / (2.0 * _RAMP), rest - 0.5 * _RAMP) / (1.0 - _RAMP)
    return np.asarray(np.where(share < 0.5, 1.0 - eased, eased))
