"""Numbers as decimal text, many at a time."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from mlmg_runtime.arrays import FloatArray

_BLOCK = 1 << 16
"""How many numbers are spelled at a time: their digits fit into the cache of a core."""


def text_from_rows(rows: FloatArray, n_decimals: int) -> Iterator[bytes]:
    """Yield the text of finite numbers, shape (n_rows, n_columns): a line a row, blanks between numbers.

    Every number has `n_decimals` digits after the point, at least 1, and is rounded to the nearest; no
    exponents, and no sign at zero.
    """
    n_rows = max(1, _BLOCK // rows.shape[1])
    for first in range(0, len(rows), n_rows):
        block = rows[first : first + n_rows]
        with np.errstate(over="ignore"):
            scaled = np.rint(block * 10.0**n_decimals)
        if np.abs(scaled).max() < 2.0**53:
            yield _text_from_integers(scaled.astype(np.int64), n_decimals)
        else:
            yield "".join(" ".join(f"{value:.{n_decimals}f}" for value in row) + "\n" for row in block).encode()


def _text_from_integers(scaled: NDArray[np.int64], n_decimals: int) -> bytes:
    """Return the text of `scaled` / 10^n_decimals: first equally wide, then without idle signs and zeros."""
    rest = np.abs(scaled)
    n_whole = max(1, len(str(rest.max())) - n_decimals)
    point = 1 + n_whole
    characters = np.empty((*scaled.shape, point + 1 + n_decimals + 1), np.uint8)
    kept = np.ones(characters.shape, np.bool_)
    characters[..., 0] = ord("-")
    kept[..., 0] = scaled < 0
    characters[..., point] = ord(".")
    characters[..., -1] = ord(" ")
    characters[:, -1, -1] = ord("\n")
    for column in (*range(point + n_decimals, point, -1), *range(point - 1, 0, -1)):
        if column < point - 1:
            kept[..., column] = rest > 0
        quotient = rest // 10
        characters[..., column] = rest - 10 * quotient + ord("0")
        rest = quotient
    return characters[kept].tobytes()
