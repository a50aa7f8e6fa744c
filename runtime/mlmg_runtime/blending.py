"""How the weight passes from the motion that is left to the motion that is entered."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from mlmg_runtime.arrays import FloatArray


def c1_weight(share: FloatArray) -> FloatArray:
    """Return the weight of the motion that is left, `share` (0 to 1) of the way into a transition: C1-smooth [K02]."""
    return np.asarray(2.0 * share**3 - 3.0 * share**2 + 1.0)


def linear_weight(share: FloatArray) -> FloatArray:
    """Return the weight of the motion that is left, `share` (0 to 1) of the way into a transition: linear [MLMG]."""
    return np.asarray(1.0 - share)


WEIGHTS: Mapping[str, Callable[[FloatArray], FloatArray]] = {"c1": c1_weight, "linear": linear_weight}
