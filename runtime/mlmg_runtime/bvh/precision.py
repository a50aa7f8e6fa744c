"""How many decimals a BVH file needs."""

from __future__ import annotations

import math

import numpy as np

from mlmg_runtime.bvh.document import POSITION_CHANNELS, Bvh

LEAST_DECIMALS = 6
MOST_DECIMALS = 15


def decimals_needed(bvh: Bvh, tolerance: float) -> int:
    """Return the number of decimals at which rounding moves no joint by more than `tolerance`, in file units.

    At least 6, which nearly all files have, and at most 15, for a double holds no more. A rounded angle moves
    what lies below the joint in proportion to its distance, and what the angles of a chain do adds up: large
    units and long chains ask for more.
    """
    moved = _moved_by_units(bvh)
    for n_decimals in range(LEAST_DECIMALS, MOST_DECIMALS):
        if moved * 0.5 * 10.0**-n_decimals <= tolerance:
            return n_decimals
    return MOST_DECIMALS


def _moved_by_units(bvh: Bvh) -> float:
    """Return a bound on how far a joint moves if each channel value changes by one unit or degree."""
    farthest = np.maximum(bvh.frames.max(axis=0), -bvh.frames.min(axis=0)).tolist()
    moved = [0.0] * len(bvh.joints)
    n_angles = [0] * len(bvh.joints)
    column = 0
    for index, joint in enumerate(bvh.joints):
        away = [abs(number) for number in joint.offset]
        positions = 0
        for channel in joint.channels:
            if channel in POSITION_CHANNELS:
                away[POSITION_CHANNELS.index(channel)] = farthest[column]
                positions += 1
            column += 1
        n_angles[index] = len(joint.channels) - positions
        moved[index] = math.sqrt(positions)
        if index:
            n_above = n_angles[joint.parent]
            n_angles[index] += n_above
            moved[index] += moved[joint.parent] + n_above * math.radians(1.0) * math.hypot(*away)
    return max(moved)
