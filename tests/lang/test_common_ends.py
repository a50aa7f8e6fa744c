"""What two sequences have in common at both ends is found, and counted once."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.common_ends import common_ends


@pytest.mark.parametrize(
    ("one", "other", "ends"),
    [
        *(("", "", (0, 0)), ("a", "", (0, 0)), ("abc", "abc", (3, 0)), ("abc", "axc", (1, 1)), ("ab", "xb", (0, 1))),
        *(("aa", "aaa", (2, 0)), ("abab", "ab", (2, 0)), ("abXcd", "abcd", (2, 2))),
        *((["a\n", "b"], ["a\n", "c"], (1, 0)), ([1, 2, 3], [4, 2, 3], (0, 2))),
    ],
)
def test_both_ends_are_found(one, other, ends):
    assert common_ends(one, other) == ends


@given(st.text("ab"), st.text("ab"), st.text("ab"), st.text("ab"))
def test_no_longer_ones_are_the_same(head, tail, one, other):
    before, after = head + one + tail, head + other + tail
    n_first, n_last = common_ends(before, after)
    limit = min(len(before), len(after))
    assert before[:n_first] == after[:n_first]
    assert n_first == limit or before[n_first] != after[n_first]
    rest, others = before[n_first:], after[n_first:]
    assert rest[len(rest) - n_last :] == others[len(others) - n_last :]
    assert n_first + n_last == limit or rest[-1 - n_last] != others[-1 - n_last]
