"""A line that cannot be parsed -> what is wrong with it in its writer's words, and the line as it was meant.

Each rule knows one mistake. The first that applies speaks; if it can also say what was meant, parsing goes on
with that, so that a second mistake in the same line is found too; unless one edit mends both: then they are one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing.line_parser import Stuck, read
from mlmg_lang.parsing.mistakes import durations, heads, motions, names, sentences, signs, words
from mlmg_lang.parsing.mistakes.mistake import Mistake, expected, found, mistake
from mlmg_lang.parsing.mistakes.one_edit import one_edit
from mlmg_lang.parsing.syntax import Line
from mlmg_lang.spelling import joined

__all__ = ["Mended", "explain", "mend"]


@dataclass(frozen=True, slots=True)
class Mended:
    """What is wrong with a line, and the line as it was probably meant (None: there is no telling)."""

    diagnostics: tuple[Diagnostic, ...]
    line: Line | None


def mend(stuck: Stuck) -> Mended:
    """Return what is wrong with a line that cannot be parsed: of several mistakes the one that makes them all."""
    step_by_step = _mended(stuck)
    if len(step_by_step.diagnostics) > 1 or step_by_step.diagnostics[0].help is None:
        one = one_edit(stuck)
        if one is not None and one.meant is not None:
            line = read(stuck.source, one.meant, stuck.in_choose)
            assert not isinstance(line, Stuck), "an edit makes all of a line readable"
            return Mended((one.diagnostic,), line)
    return step_by_step


def _mended(stuck: Stuck) -> Mended:
    """While the parser is stuck, say why and go on with what was meant, if that leads further."""
    told: list[Diagnostic] = []
    left = len(stuck.tokens) + 1
    outcome: Line | Stuck = stuck
    while isinstance(outcome, Stuck):
        if outcome.left >= left:
            return Mended(tuple(told), None)
        left = outcome.left
        mistake = explain(outcome)
        told.append(mistake.diagnostic)
        if mistake.meant is None:
            return Mended(tuple(told), None)
        outcome = read(stuck.source, mistake.meant, stuck.in_choose)
    return Mended(tuple(told), outcome)


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
    sentences.list_item,
    sentences.condition,
    sentences.wait_for_motion,
    durations.time_of_beginning,
    words.comes_next,
    words.word_of_other_languages,
    words.space_missing,
    names.clip_file,
    durations.how_often,
    sentences.weight_without_colon,
    sentences.number_first,
    durations.odd_number,
    durations.number_of_other_languages,
    durations.clock_time,
    durations.two_quantities,
    durations.duration_first,
    heads.weight_not_whole,
    names.name_from_digit,
    durations.word_before_number,
    words.misspelt_before_number,
    durations.for_missing,
    durations.for_too_much,
    durations.number_in_words,
    durations.unit_missing,
    signs.or_for_bar,
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
    words.kept_for_later,
    words.reserved_as_name,
    heads.name_missing,
    durations.amount_missing,
    motions.no_motion_after,
    motions.inside_parentheses,
    motions.nothing_before,
    signs.single_quotes,
    signs.stray_character,
    words.misspelt_word,
    words.head_without_body,
    signs.bar_for_or,
    signs.stray_sign,
    motions.three_names,
    motions.lone_number,
    motions.after_the_end,
)
"""The special before the general."""
