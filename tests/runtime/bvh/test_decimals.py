from decimal import ROUND_HALF_EVEN, Decimal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as st_np

from mlmg_runtime.bvh.decimals import text_from_rows


def text(rows: object, n_decimals: int) -> str:
    return b"".join(text_from_rows(np.asarray(rows, dtype=np.float64), n_decimals)).decode()


def test_rows_are_lines_and_numbers_have_a_fixed_number_of_decimals() -> None:
    rows = [[0.0, -1.5, 1234.5678915], [0.05, -0.0005, 10.0]]
    assert text(rows, 6) == "0.000000 -1.500000 1234.567892\n0.050000 -0.000500 10.000000\n"
    assert text(rows, 1) == "0.0 -1.5 1234.6\n0.0 0.0 10.0\n"


def test_zero_has_no_sign_and_no_number_is_cut() -> None:
    assert text([[-0.0, -0.04, 99.96, -9.999]], 1) == "0.0 0.0 100.0 -10.0\n"


@pytest.mark.parametrize("number", [1e13, -9.3e12, 4.2e18, 1e30, 1e300, -1.7e308])
def test_huge_numbers_are_spelled_out_too(number: float) -> None:
    assert text([[number, 0.25]], 6) == f"{number:.6f} 0.250000\n"


@pytest.mark.parametrize("shape", [(1, 1), (1, 70000), (70000, 1), (683, 97), (3000, 66)])
def test_rows_of_any_length_are_all_there(shape: tuple[int, int]) -> None:
    rows = np.random.default_rng(0).normal(scale=100.0, size=shape)
    lines = text(rows, 7).splitlines()
    assert len(lines) == shape[0]
    np.testing.assert_allclose([[*map(float, line.split(" "))] for line in lines], rows, atol=0.5001e-7)


@given(st_np.arrays(np.float64, (2, 3), elements=st.floats(-1e8, 1e8)), st.integers(1, 9))
def test_numbers_are_those_that_python_writes_to_half_a_digit(rows: np.ndarray, n_decimals: int) -> None:
    words = text(rows, n_decimals).split()
    for word, number in zip(words, rows.ravel(), strict=True):
        exact = Decimal(float(number)).quantize(Decimal(10) ** -n_decimals, ROUND_HALF_EVEN)
        assert abs(Decimal(word) - exact) <= Decimal(10) ** -n_decimals
        assert abs(float(word) - number) <= 0.5 * 10.0**-n_decimals + 4.0 * np.spacing(abs(number))
        assert word.count(".") == 1
        assert len(word.partition(".")[2]) == n_decimals
        assert word.lstrip("-")[:2] == "0." or word.lstrip("-")[0] != "0"
