"""The array types that travel through the runtime."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]
BoolArray: TypeAlias = NDArray[np.bool_]


def frozen(array: FloatArray) -> FloatArray:
    """Return `array`, made read-only, because it is shared."""
    array.setflags(write=False)
    return array
