"""What is left out of the search for garbage."""

import gc

import pytest

from mlmg_lsp.memory import settle, undisturbed, unsettle


def test_what_is_there_is_left_out_until_it_is_taken_back() -> None:
    kept = [[n] for n in range(1000)]
    settle()
    assert gc.get_freeze_count() >= len(kept)
    unsettle()
    assert gc.get_freeze_count() == 0


def test_nothing_is_searched_meanwhile_and_all_as_before_afterwards_whatever_happens() -> None:
    def failing() -> None:
        with undisturbed():
            found.append(gc.isenabled())
            raise ValueError("oh")

    found: list[bool] = []
    with pytest.raises(ValueError, match="oh"):
        failing()
    assert found == [False]
    assert gc.isenabled()
