"""What is said of words in a row -> one message, where they are a name of the library with spaces in it.

Neither the parser, which knows no library, nor binding, which sees single names, can tell that of `Upper Body TALK`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

from mlmg_grammar import reserved_words
from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.build_syntax import motion_script
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.structure import SUB, is_sub
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Span
from mlmg_lang.spelling import listed, normal

_OF_WORDS: Final = frozenset({"MS010", "MS019", "MS021", "MS025", "MS026", "MS028"})
"""What is said of words in a row, or of one of them, as they are no names by themselves."""


@dataclass(frozen=True, slots=True)
class _Part:
    """A graph, tag or motion, as some words in a row have it; `meant`: all that they could be."""

    words: tuple[str, ...]
    meant: tuple[str, ...]

    @property
    def is_apart(self) -> bool:
        """Return whether there are spaces in it."""
        return len(self.words) > 1

    def is_sure(self, names: Names) -> bool:
        """Return whether nothing else can be meant."""
        known = any(names.places(word) or names.graph(word) is not None for word in self.words)
        return len(self.meant) == 1 and not known


def told_of_names(told: Sequence[Diagnostic], tokens: Sequence[Token], names: Names) -> tuple[Diagnostic, ...]:
    """Return what is wrong with a stretch of text, of names that are written with spaces in them each told once.

    Parameters
    ----------
    tokens : those of the text, with places as in what is told.
    """
    if not any(one.code in _OF_WORDS for one in told):
        return tuple(told)
    apart = [
        (parts, Span(run[0].span.start, run[-1].span.end)) for run in _runs(tokens) if (parts := _parts(run, names))
    ]
    kept: dict[int | Span, Diagnostic] = {}
    for at, one in enumerate(told):
        found = next(((parts, span) for parts, span in apart if _is_of(one, span)), None)
        if found is None:
            kept[at] = one
        else:
            kept.setdefault(found[1], replace(_say(*found, names), notes=one.notes))
    return tuple(kept.values())


def _is_of(one: Diagnostic, run: Span) -> bool:
    """Return whether something is said of words in a row."""
    if one.code not in _OF_WORDS or one.span is None:
        return False
    return one.span.start < run.end and run.start < max(one.span.end, one.span.start + 1)


def _runs(tokens: Sequence[Token]) -> Iterator[Sequence[Token]]:
    """Yield the stretches of names side by side, with the whole numbers behind them that are no durations."""
    kinds = [token.type for token in tokens] + ["", ""]
    first = 0
    for at, kind in enumerate(kinds[:-1]):
        if kind != "NAME" and (kind != "INTEGER" or at == first or kinds[at + 1] == "UNIT"):
            if at - first > 1 and kinds[first - 1] != "LET":
                yield tokens[first:at]
            first = at + 1


def _parts(run: Sequence[Token], names: Names) -> Sequence[_Part]:
    """Return the graph and what it is to do, or one of them, that words in a row are; nothing if they are not."""
    words = tuple(token.text for token in run)
    reserved = reserved_words(motion_script())
    if any(word.lower() in reserved for word in words):
        return ()
    for size in range(len(words) + 1):
        graph, motion = _graph(words[:size], names), _motion(words[size:], names)
        parts = [part for part in (graph, motion) if part.words]
        if all(part.meant for part in parts) and any(part.is_apart for part in parts):
            return parts
    return ()


def _graph(words: tuple[str, ...], names: Names) -> _Part:
    """Return a graph as some words have it, which may be none."""
    if len(words) != 1:
        return _Part(words, tuple(name for name in names.written_apart(words) if name in names.graphs))
    graph = SUB if is_sub(syntax.Name(words[0], False, True, Span(0, 0))) else names.graph(words[0])
    return _Part(words, () if graph is None else (graph,))


def _motion(words: tuple[str, ...], names: Names) -> _Part:
    """Return a motion or tag as some words have it; a single one is left to be told of by itself."""
    if len(words) != 1:
        return _Part(words, tuple(name for name in names.written_apart(words) if name not in names.graphs))
    spellings = tuple(dict.fromkeys(names.spellings_of(words[0])))
    return _Part(words, spellings if len(spellings) == 1 else words)


def _say(parts: Sequence[_Part], span: Span, names: Names) -> Diagnostic:
    apart = [part for part in parts if part.is_apart]
    right = " ".join(script_name(part.meant[0]) for part in parts)
    code = "MS026" if all(part.meant[0] in names.graphs for part in apart) else "MS021"
    fix = Fix(span, right, safe=all(part.is_sure(names) for part in apart))
    return Diagnostic(code, _message(apart), span, f"write `{right}`", fixes=(fix,))


def _message(apart: Sequence[_Part]) -> str:
    written = [" ".join(part.words) for part in apart]
    is_exact = all(normal(text) == normal(part.meant[0]) for text, part in zip(written, apart, strict=True))
    if len(apart) > 1:
        return f"{listed(written)} " + (
            "have spaces in them: such names are written in quotes"
            if is_exact
            else "are no names: there are spaces in them"
        )
    if is_exact:
        return f"{listed(written)} has a space in it: such a name is written in quotes"
    return f"{listed(written)} is no name: there is a space in it"
