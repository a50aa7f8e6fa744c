"""A script and the edits that its diagnostics offer -> the script as it is with them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

from mlmg_lang.diagnostics import Diagnostic, Fix, n_errors
from mlmg_lang.source import Source

Diagnose: TypeAlias = Callable[[Source], tuple[Source, Sequence[Diagnostic]]]
"""What says what is wrong with a text; it returns the text together with the files that it uses."""
MAX_ROUNDS: Final = 20
"""Edits can make others possible; after so many rounds they are rather undoing each other."""
_MAX_SINGLE: Final = 100
"""The most edits that are tried one by one where all at once make a script worse."""


@dataclass(frozen=True, slots=True)
class Fixed:
    """A script with edits applied.

    Attributes
    ----------
    diagnostics : what is still to be said of it.
    n_fixed : how many edits there were.
    """

    source: Source
    diagnostics: tuple[Diagnostic, ...]
    n_fixed: int


def fix_all(source: Source, diagnostics: Sequence[Diagnostic], diagnose: Diagnose, unsafe: bool = False) -> Fixed:
    """Apply the edits of a script's diagnostics, and of those that are left then, until there are no more.

    Of edits that overlap the first is applied; the others wait for the next round. A round that leaves more errors than
    there were is taken back: then its edits are tried one by one.

    Parameters
    ----------
    unsafe : whether to apply the likeliest edit of each diagnostic, be it safe or not; else only safe ones.
    """
    state = Fixed(source, tuple(diagnostics), 0)
    for _ in range(MAX_ROUNDS):
        edits = _without_overlaps(applicable(state.diagnostics, state.source, unsafe))
        after = _edited(state, edits, diagnose)
        if after is None and 1 < len(edits) <= _MAX_SINGLE:
            after = _one_by_one(state, edits, diagnose)
        if after is None:
            break
        state = after
    return state


def applicable(diagnostics: Iterable[Diagnostic], source: Source, unsafe: bool) -> Iterator[Fix]:
    """Yield the edit of each diagnostic that would be applied to the script itself, if there is one."""
    for one in diagnostics:
        edits = [fix for fix in one.fixes if (fix.safe or unsafe) and fix.span.end <= len(source.text)]
        yield from edits[:1]


def _without_overlaps(edits: Iterable[Fix]) -> list[Fix]:
    """Return edits in the order of the text, each as far as it does not touch what one before it changes."""
    kept: list[Fix] = []
    for edit in sorted(edits, key=lambda edit: (edit.span.start, edit.span.end)):
        if (
            not kept
            or edit.span.start > kept[-1].span.end
            or (edit.span.start == kept[-1].span.end and edit.span.start < edit.span.end)
        ):
            kept.append(edit)
    return kept


def _edited(state: Fixed, edits: Sequence[Fix], diagnose: Diagnose) -> Fixed | None:
    """Return a script with edits applied; None if that changes nothing or makes it worse."""
    text = state.source.text
    for edit in reversed(edits):
        text = text[: edit.span.start] + edit.replacement + text[edit.span.end :]
    if text == state.source.text:
        return None
    source, diagnostics = diagnose(Source(text, state.source.name))
    worse = n_errors(diagnostics) > n_errors(state.diagnostics)
    return None if worse else Fixed(source, tuple(diagnostics), state.n_fixed + len(edits))


def _one_by_one(state: Fixed, edits: Sequence[Fix], diagnose: Diagnose) -> Fixed | None:
    """Return a script with those edits that do not make it worse, from the last to the first, so that places hold."""
    after = state
    for edit in reversed(edits):
        after = _edited(after, (edit,), diagnose) or after
    return None if after is state else after
