"""A definition, or a use of it -> what it says, in place of its name."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from operator import attrgetter
from typing import Final

from mlmg_lang.analysis import Analysis, InPieces
from mlmg_lang.diagnostics import has_errors
from mlmg_lang.ide.touching import pieces_touching
from mlmg_lang.parsing import syntax
from mlmg_lang.source import Edit, Span
from mlmg_lang.spelling import normal

_BEHIND: Final = re.compile(r"[ \t]*(?P<parts>;)?[ \t]*(?P<ends>#|\r\n|[\r\n]|\Z)?")
"""What stands behind a statement: what parts it from the next, and what ends its line."""


@dataclass(frozen=True, slots=True)
class Inlining:
    """The edits that put in what a definition says."""

    title: str
    edits: tuple[Edit, ...]


def inlinings(analysis: Analysis, within: Span, used: Collection[str] = ()) -> Iterator[Inlining]:
    """Yield what puts in a definition that a stretch touches the name of: this one use, or all.

    With all uses goes the definition, unless other scripts may need it. Nothing for definitions and uses with mistakes;
    nor for all uses of a script with a mistake in any definition, or with a statement that cannot be read.

    Parameters
    ----------
    used : the names of the files that other scripts use, as far as known.
    """
    for piece, further in pieces_touching(analysis, Span(within.start, within.start)):  # a name is in one
        for item in piece.items:
            for use in _uses(item):
                if _touches(use.node.name.span, further, within):
                    yield from _of_use(analysis, use)
            if isinstance(item, syntax.Let) and _touches(item.name.span, further, within):
                yield from _of_all(analysis, item, used)


def _touches(name: Span, further: int, within: Span) -> bool:
    return name.start + further <= within.start and within.end <= name.end + further


@dataclass(frozen=True, slots=True)
class _Use:
    """Where a name is used that may be that of a definition.

    Attributes
    ----------
    whole : the command that is nothing but this; else None.
    hidden : the parameters of the definition that it stands in, which names put in there would mean.
    in_let : whether it stands in a definition.
    """

    node: syntax.Reference | syntax.Call
    whole: syntax.Command | None
    hidden: frozenset[str]
    in_let: bool


def _uses(item: syntax.Item) -> Iterator[_Use]:
    """Yield the names in an item that may be those of definitions, in the order of the text."""
    parameters = item.parameters or () if isinstance(item, syntax.Let) else ()
    hidden = frozenset(normal(one.name.text) for one in parameters)
    wholes = {id(node.motion): node for node in syntax.walk(item) if isinstance(node, syntax.Command)}
    for node in syntax.walk(item):
        if isinstance(node, syntax.Reference | syntax.Call) and normal(node.name.text) not in hidden:
            yield _Use(node, wholes.get(id(node)), hidden, isinstance(item, syntax.Let))


def _of_use(analysis: Analysis, use: _Use) -> Iterator[Inlining]:
    let = analysis.made.gathered.definitions.find(use.node.name)
    text = None if let is None else _put_in(analysis, let, use)
    if let is not None and text is not None:
        yield Inlining(f"put in what `{let.name.text}` says", (Edit(analysis.made.now(use.node.span), text),))


def _of_all(analysis: Analysis, let: syntax.Let, used: Collection[str]) -> Iterator[Inlining]:
    made = analysis.made
    definitions = made.gathered.definitions
    if definitions.find(let.name) is not let or has_errors(made.defined) or any(map(attrgetter("broken"), made.lines)):
        return
    edits = []
    for use, further in _uses_of(made, let):
        text = _put_in(analysis, let, use)
        if text is None:
            return
        at = use.node.span
        edits.append(Edit(at.shifted(further), text))
    if not edits or any(_overlap(one, other) for one, other in pairwise(_sorted(edits))):
        return
    title = f"put in what `{let.name.text}` says everywhere"
    if _is_for_others(analysis, used):
        yield Inlining(title, _sorted(edits))
    else:
        removal = Edit(_with_separator(made.source.text, made.now(let.span)), "")
        yield Inlining(f"{title}, and take it out", _sorted([*edits, removal]))


def _is_for_others(analysis: Analysis, used: Collection[str]) -> bool:
    """Return whether a script is there for others, as it has nothing but definitions, or is used by one."""
    return not analysis.made.lines.words("used") or analysis.source.name in used


def _uses_of(made: InPieces, let: syntax.Let) -> Iterator[tuple[_Use, int]]:
    """Yield where a script uses a definition, in the order of the text, each with how far from its address it is."""
    name = normal(let.name.text)
    for line, start in zip(made.lines, made.places.logical_line_starts, strict=False):
        if name in line.used or line.defining:
            uses = (use for item in line.items if item is not let for use in _uses(item))
            yield from ((use, start - line.address) for use in uses if normal(use.node.name.text) == name)


def _sorted(edits: Iterable[Edit]) -> tuple[Edit, ...]:
    return tuple(sorted(edits, key=lambda edit: edit.span))


def _overlap(one: Edit, other: Edit) -> bool:
    return one.span.start < other.span.end and other.span.start < one.span.end


def _with_separator(text: str, span: Span) -> Span:
    """Return the span of a statement with what parts it from those beside it: a `;`, or the line end if it is alone."""
    behind = _BEHIND.match(text, span.end)
    assert behind is not None, "there may be nothing behind it"
    before = text[: span.start].rstrip(" \t")
    if behind["ends"] is None:
        return Span(span.start, behind.end() if behind["parts"] else span.end)
    if before.endswith(";"):
        return Span(len(before[:-1].rstrip(" \t")), max(behind.end("parts"), span.end))
    if before and before[-1] not in "\r\n\ufeff":
        return span
    return Span(span.start, behind.start("ends")) if behind["ends"] == "#" else Span(len(before), behind.end())


# --- what is put in -------------------------------------------------------------------------------------


def _put_in(analysis: Analysis, let: syntax.Let, use: _Use) -> str | None:
    """Return what a definition says in a use of it; None if it cannot be put in there without another meaning."""
    made = analysis.made
    signature = made.gathered.definitions.signatures.get(normal(let.name.text))
    values = _values(let, use.node, made)
    if signature is None or values is None or _means_otherwise(let, use.hidden):
        return None
    if signature.lasts:
        alone = use.whole is not None and use.whole.duration is None and use.whole.once is None and not use.in_let
        return _Putting(made, values).text(let.command) if alone else None
    text = _Putting(made, values).text(let.command.motion)
    bare = use.whole is not None and not isinstance(let.command.motion, syntax.Reference)
    return text if bare or isinstance(let.command.motion, syntax.Group) else f"({text})"


def _means_otherwise(let: syntax.Let, hidden: frozenset[str]) -> bool:
    """Return whether a name in a definition would mean a parameter of the one that it is put into."""
    if not hidden:
        return False
    own = {normal(one.name.text) for one in let.parameters or ()}
    names = {normal(node.text) for node in syntax.walk(let.command) if isinstance(node, syntax.Name)}
    return bool((names - own) & hidden)


@dataclass(frozen=True, slots=True)
class _Putting:
    """Puts the values of parameters into what a definition says."""

    made: InPieces
    values: Mapping[str, str]

    def text(self, node: syntax.Node) -> str:
        """Return what a part of a definition says, with values in place of parameters."""
        at = self.made.now(node.span)
        text = self.made.source.slice(at)
        for name in sorted(self._given(node), key=lambda name: name.span, reverse=True):
            place = self.made.now(name.span)
            first, last = place.start - at.start, place.end - at.start
            text = text[:first] + self.values[normal(name.text)] + text[last:]
        return text

    def _given(self, node: syntax.Node) -> Iterator[syntax.Name]:
        for part in syntax.walk(node) if self.values else ():
            match part:
                case syntax.Reference(name) | syntax.Command(duration=syntax.Name() as name):
                    if normal(name.text) in self.values:
                        yield name


def _values(let: syntax.Let, use: syntax.Reference | syntax.Call, made: InPieces) -> dict[str, str] | None:
    """Return what each parameter of a definition is in a use of it, as it is written there; None if one is missing."""
    parameters = let.parameters or ()
    names = [normal(one.name.text) for one in parameters]
    values = {
        name: _written(one.default, made)
        for name, one in zip(names, parameters, strict=True)
        if one.default is not None
    }
    arguments = use.arguments if isinstance(use, syntax.Call) else ()
    if len(arguments) > len(names):
        return None
    for at, argument in enumerate(arguments):
        name = names[at] if argument.name is None else normal(argument.name.text)
        values[name] = _written(argument.value, made)
    return values if set(values) == set(names) else None


def _written(value: syntax.Motion | syntax.Quantity, made: InPieces) -> str:
    """Return a value as it is written, in parentheses if that may be needed where it is put in."""
    text = made.source.slice(made.now(value.span))
    return text if isinstance(value, syntax.Quantity | syntax.Reference | syntax.Group) else f"({text})"
