"""The rules of the grammar -> the same rules as people read them.

A parser's rules say what trees are made of. For people, rules that are there for the parser alone are left out or put
in where they are used, words and signs stand for themselves, and repetition is told from its separator.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from mlmg_grammar.definitions import Definition, Section, sections
from mlmg_grammar.expressions import Choice, Expression, Optional, Repeat, Sequence, Symbol, Text, rewritten, sequence

HIDDEN: Final = frozenset({"line", "unparsed"})
"""Rules from which the parser begins; no other rule uses them."""
INLINED: Final = frozenset({"_separator", "repeat_head", "choose_head", "weight"})
"""Rules that are put in where they are used."""


def readable(grammar: str) -> tuple[Section, ...]:
    """Return the parts of a grammar, its rules for people."""
    whole = sections(grammar)
    known = {one.name: one.expression for section in whole for one in section.definitions}
    return tuple(replace(section, definitions=tuple(_shown(section, known))) for section in whole)


def _shown(section: Section, known: dict[str, Expression]) -> list[Definition]:
    kept = (one for one in section.definitions if one.name not in HIDDEN | INLINED)
    return [Definition(_label(one.name), _for_people(one.expression, known)) for one in kept]


def _for_people(expression: Expression, known: dict[str, Expression]) -> Expression:
    """Return an expression with other rules put in, and as simple as it can be said."""

    def change(part: Expression) -> Expression:
        if not isinstance(part, Symbol):
            return _simple(part)
        meant = known[part.name]
        if part.name in INLINED:
            return _for_people(meant, known)
        return meant if isinstance(meant, Text) else Symbol(_label(part.name))

    return rewritten(expression, change)


def _label(name: str) -> str:
    """Return the name of a rule without the mark of those that make no node in the tree."""
    return name.lstrip("_")


def _simple(expression: Expression) -> Expression:
    if isinstance(expression, Choice):
        return _without_common_beginning(expression)
    if isinstance(expression, Sequence):
        return _with_separators(_flat(expression))
    return expression


def _flat(expression: Sequence) -> Sequence:
    """Return a sequence with those in it as parts of it."""
    parts: list[Expression] = []
    for part in expression.parts:
        parts += part.parts if isinstance(part, Sequence) else [part]
    return Sequence(tuple(parts))


def _without_common_beginning(expression: Choice) -> Expression:
    """Return `a | a b` as `a [b]`."""
    options = list(expression.options)
    for at in range(len(options) - 1, 0, -1):
        short, long = _parts(options[at - 1]), _parts(options[at])
        if len(short) < len(long) and long[: len(short)] == short:
            more = Optional(sequence(long[len(short) :]))
            options[at - 1 : at + 1] = [_simple(Sequence((*short, more)))]
    return options[0] if len(options) == 1 else Choice(tuple(options))


def _with_separators(expression: Sequence) -> Expression:
    """Return `a (s a)*` as `a`, repeated with `s` between."""
    parts: list[Expression] = []
    for part in expression.parts:
        between = _separator(part, parts[-1]) if parts else None
        if between is None:
            parts.append(part)
        else:
            parts[-1] = Repeat(parts[-1], between)
    return sequence(tuple(parts))


def _separator(part: Expression, before: Expression) -> Expression | None:
    """Return `s` if a part is `(s a)*` and `a` stands before it."""
    if isinstance(part, Optional) and isinstance(part.part, Repeat) and isinstance(part.part.part, Sequence):
        *between, last = part.part.part.parts
        return sequence(tuple(between)) if last == before else None
    return None


def _parts(expression: Expression) -> tuple[Expression, ...]:
    return expression.parts if isinstance(expression, Sequence) else (expression,)
