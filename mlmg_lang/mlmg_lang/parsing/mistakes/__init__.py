"""A line that cannot be parsed -> what is wrong with it in its writer's words, and the line as it was meant.

Each rule knows one mistake. The first that applies speaks; if it can also say what was meant, parsing goes on
with that, so that a second mistake in the same line is found too.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from mlmg_lang.parsing.line_parser import Stuck
from mlmg_lang.parsing.mistakes import durations, heads, motions, signs, words
from mlmg_lang.parsing.mistakes.mistake import Mistake, expected, found, mistake
from mlmg_lang.spelling import joined

__all__ = ["Mistake", "explain"]


def explain(stuck: Stuck) -> Mistake:
    """Return what is wrong where the parser is stuck."""
    for rule in _RULES:
        told = rule(stuck)
        if told is not None:
            return told
    message = f"expected {joined(expected(stuck), 'or')}, found {found(stuck)}"
    return mistake("MS010", message, stuck.span)


_RULES: Final[tuple[Callable[[Stuck], Mistake | None], ...]] = (
    words.wrong_case,
    words.comes_next,
    words.word_of_other_languages,
    durations.odd_number,
    durations.number_of_other_languages,
    durations.clock_time,
    durations.two_quantities,
    durations.duration_first,
    heads.weight_not_whole,
    signs.name_from_digit,
    durations.word_before_number,
    words.misspelt_before_number,
    durations.for_missing,
    durations.for_too_much,
    durations.number_in_words,
    durations.unit_missing,
    durations.for_not_last,
    durations.for_and_once,
    motions.not_after_graph,
    heads.not_behind_name,
    heads.graph_missing,
    heads.path_missing,
    heads.definition,
    heads.equals_missing,
    heads.meaning_missing,
    heads.number_defined,
    heads.comma_missing,
    motions.parenthesis,
    words.reserved_as_name,
    heads.name_missing,
    durations.amount_missing,
    motions.no_motion_after,
    motions.nothing_before,
    signs.stray_character,
    words.misspelt_word,
    words.space_missing,
    words.head_without_body,
    signs.stray_sign,
    motions.three_names,
    motions.lone_number,
    motions.after_the_end,
)
"""The special before the general."""
