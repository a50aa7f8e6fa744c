"""A place in a script -> what there is to say of what stands there, in parts that are ready for Markdown."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import chain
from pathlib import PurePath
from typing import Final, Protocol

from mlmg_lang.analysis import Analysis
from mlmg_lang.catalog import Catalog
from mlmg_lang.diagnostics import Diagnostic, Severity
from mlmg_lang.ide.definition import declaration
from mlmg_lang.ide.layers import graph_at
from mlmg_lang.ide.meaning import motions_of_use
from mlmg_lang.ide.occurrences import Occurrence, Sort, Symbol, occurrence_at, place_of
from mlmg_lang.ide.sayings import Understood, state_before, understood
from mlmg_lang.ide.signature import described
from mlmg_lang.ide.statements import Statement, statements_at
from mlmg_lang.ide.touching import tokens_at
from mlmg_lang.ide.words import UNIT_SAYS, WORDS
from mlmg_lang.ide.written import written
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.amounts import seconds_from_quantity, spelled, unit_of
from mlmg_lang.parsing.structure import without_groups
from mlmg_lang.planning import typed
from mlmg_lang.planning.names import Names
from mlmg_lang.rendering.wording import safe
from mlmg_lang.rules import read_rule
from mlmg_lang.source import Source, Span
from mlmg_lang.spelling import joined, normal

_MOST: Final = 8
"""So many names are listed."""
_MOST_COMPARED: Final = 5_000
"""So many pairs of motions are compared; where there are more, they stay in the order of the configuration."""
_LONGEST: Final = 600
"""So long may the text of an expansion be, in code points."""


class Anatomy(Protocol):
    """What is told of a library beyond its names."""

    def joints(self, graph: str) -> Sequence[str]:
        """Return the joints of a graph."""

    def transitions(self, graph: str, motion: str) -> Mapping[str, int]:
        """Return, by motion, how many transitions of a graph lead there from a motion."""


@dataclass(frozen=True, slots=True)
class Part:
    """A paragraph in Markdown, or a line of a list (`- `); `code`: a stretch of a script, as it is."""

    text: str
    code: bool = False


@dataclass(frozen=True, slots=True)
class Hover:
    """What is said of a stretch of a text; `span` has offsets of the script or of a file behind it."""

    span: Span
    parts: tuple[Part, ...]


def hover(analysis: Analysis, offset: int, anatomy: Anatomy | None = None) -> Hover | None:
    """Return what there is to say of what stands at an offset; None if there is nothing.

    Parameters
    ----------
    offset : in the script, or behind it in a file that it uses (see `Source`).
    anatomy : without it, joints and transitions are left out.
    """
    found = occurrence_at(analysis, offset)
    statements = statements_at(analysis.made, offset)
    if found is not None:
        parts = tuple(_Teller(analysis, anatomy, offset, statements).of(found))
        return Hover(found.span, parts) if parts else None
    return _quantity_at(analysis, statements, offset) or _word_at(analysis, offset)


def hover_declaration(analysis: Analysis, symbol: Symbol) -> tuple[Part, ...]:
    """Return what there is to say of a script's own name where it gets its meaning, and where that is."""
    span = declaration(analysis, symbol)
    found = None if span is None else hover(analysis, span.start)
    if span is None or found is None:
        return ()
    place = place_of(analysis.source, span)
    line, _ = Source(analysis.source.file(span.start)[0].text).position(place.span.start)
    where = "" if place.file == analysis.source.name else f" of {code(PurePath(place.file).name)}"
    return (*found.parts, Part(f"defined in line {line}{where}"))


def hover_mistakes(analysis: Analysis, offset: int, *, errors: bool) -> Hover | None:
    """Return what the diagnostics at an offset say, and then what that means, each code once; None if there are none.

    Parameters
    ----------
    errors : whether errors are told; else warnings and hints are.
    """
    wrong = [
        one
        for one in analysis.diagnostics
        if one.span and one.span.start <= offset <= one.span.end and (one.severity is Severity.ERROR) == errors
    ]
    if not wrong or wrong[0].span is None:
        return None
    said = [part for one in wrong for part in _of_diagnostic(one)]
    meant = [part for code in dict.fromkeys(one.code for one in wrong) for part in _of_rule(code)]
    return Hover(wrong[0].span, (*said, *meant))


def _of_diagnostic(one: Diagnostic) -> Iterator[Part]:
    yield Part(f"**{one.severity.value}:** {safe(one.message)}")
    if one.help:
        yield Part(f"help: {safe(one.help)}")


@cache
def _of_rule(code: str) -> tuple[Part, ...]:
    """Return what a diagnostic means, and why it is one."""
    rule = read_rule(code)
    return (Part(f"**{code}** {rule.meaning}"), Part(rule.why))


def code(name: str) -> str:
    """Return a name in Markdown as code, whatever is in it."""
    ticks = "`" * (1 + max(map(len, re.findall("`+", name)), default=0))
    pad = " " if name.startswith("`") or name.endswith("`") else ""
    return f"{ticks}{pad}{name}{pad}{ticks}"


# --- numbers and words -----------------------------------------------------------------------------------


def _quantity_at(analysis: Analysis, statements: Sequence[Statement], offset: int) -> Hover | None:
    for statement in statements:
        for node in syntax.walk(statement.item):
            if isinstance(node, syntax.Quantity):
                span = statement.at(node.span)
                if span.start <= offset <= span.end:
                    return Hover(span, tuple(_of_quantity(analysis, statement, node)))
    return None


def _of_quantity(analysis: Analysis, statement: Statement, quantity: syntax.Quantity) -> Iterator[Part]:
    catalog, unit = analysis.question.catalog, unit_of(quantity)
    rate = None if catalog is None else catalog.frame_rate
    seconds = seconds_from_quantity(quantity, rate)
    if unit == "cycles":
        yield Part(f"{quantity.number} {UNIT_SAYS[unit]}")
        yield from _of_cycles(analysis, statement, float(quantity.number))
    elif seconds is None:
        yield Part(f"{quantity.number} frames; how long they last depends on the library")
    else:
        yield Part(_lasting(seconds, rate))


def _lasting(seconds: float, rate: float | None) -> str:
    """Return a duration in seconds and frames."""
    said = f"{spelled(seconds)} sec"
    return said if rate is None else f"{said}, {spelled(seconds * rate)} frames at {spelled(rate)} frames a second"


def _of_cycles(analysis: Analysis, statement: Statement, number: float) -> Iterator[Part]:
    """Yield how long cycles of the motions last that a command may take."""
    catalog, command = analysis.question.catalog, statement.item
    if catalog is None or not isinstance(command, syntax.Command):
        return
    way = understood(analysis, command).way
    if way is not None:
        lengths = sorted(catalog.n_frames(motion) * number for motion in _topmost(analysis, way).motions)
        first, last = (
            _lasting(frames / catalog.frame_rate, catalog.frame_rate) for frames in (lengths[0], lengths[-1])
        )
        yield Part(f"here {first}" if first == last else f"here from {first} to {last}")


def _topmost(analysis: Analysis, way: typed.Layering) -> typed.Layer:
    names = analysis.question.names
    assert names is not None, "what is understood has been looked up"
    return min(way.layers, key=lambda layer: names.height(layer.graph))


def _word_at(analysis: Analysis, offset: int) -> Hover | None:
    """Return what a word of the language says."""
    tokens, further = tokens_at(analysis, offset)
    at = bisect_right(tokens, offset - further, key=lambda token: token.span.start)
    for token in reversed(tokens[max(at - 2, 0) : at]):
        span = token.span.shifted(further)
        if offset <= span.end and token.type in WORDS:
            return Hover(span, (of_word(token.text, WORDS[token.type]),))
    return None


def of_word(word: str, says: str) -> Part:
    """Return what is told of a word of the language that says something."""
    return Part(f"{code(word)}: {says}")


# --- names -----------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Teller:
    """Tells of a name at an offset, which is in one of some statements."""

    analysis: Analysis
    anatomy: Anatomy | None
    offset: int
    statements: Sequence[Statement]

    @property
    def _library(self) -> tuple[Names, Catalog] | None:
        question = self.analysis.question
        return None if question.names is None or question.catalog is None else (question.names, question.catalog)

    def of(self, found: Occurrence) -> Iterator[Part]:
        symbol = found.symbol
        match symbol.sort:
            case Sort.DEFINITION:
                yield from self._definition(found)
            case Sort.PARAMETER:
                yield from self._parameter(symbol)
            case Sort.SUB:
                yield from self._sub(found)
            case Sort.MOTION | Sort.TAG | Sort.GRAPH if self._library is not None:
                tell = {Sort.MOTION: self._motion, Sort.TAG: self._tag, Sort.GRAPH: self._graph}[symbol.sort]
                yield from tell(symbol.name, *self._library)

    # --- of a library ---

    def _motion(self, motion: str, names: Names, catalog: Catalog) -> Iterator[Part]:
        n_frames = catalog.n_frames(motion)
        yield Part(f"motion {code(motion)}: {spelled(round(n_frames / catalog.frame_rate, 2))} sec, {n_frames} frames")
        for graph in names.graphs:
            if motion in names.motion_set(graph):
                tags = catalog.tags(graph, motion)
                said = joined(map(code, tags)) if tags else "no tags"
                yield Part(f"- on {code(graph)}: {said}{self._ways_on(graph, motion)}")

    def _ways_on(self, graph: str, motion: str) -> str:
        """Return where the transitions of a motion lead."""
        if self.anatomy is None:
            return ""
        numbers = {other: n for other, n in self.anatomy.transitions(graph, motion).items() if n}
        if not numbers:
            return "; no transitions lead on"
        most = sorted(numbers, key=lambda other: -numbers[other])
        listed = _some([f"{code(other)} ({numbers[other]})" for other in most])
        n_all = sum(numbers.values())
        return f"; {n_all} transition{'' if n_all == 1 else 's'} to {listed}"

    def _tag(self, tag: str, names: Names, catalog: Catalog) -> Iterator[Part]:
        yield Part(f"tag {code(tag)}")
        for graph in names.graphs:
            match = names.find(graph, tag, exactly=True)
            if match is not None:
                motions, ranked = self._by_fit(graph, match.entry.motions, names, catalog)
                best = ", by likeness to what may play before" if ranked else ""
                yield Part(f"- on {code(graph)}: {_some(list(map(code, motions)))}{best}")

    def _by_fit(self, graph: str, motions: Sequence[str], names: Names, catalog: Catalog) -> tuple[Sequence[str], bool]:
        """Return motions by how like they are to what may drive a graph before, and whether that is known."""
        before = self._driving(graph, names)
        known = [one for one in before if one in names.motion_set(graph)]
        if len(motions) < 2 or not 0 < len(known) * len(motions) <= _MOST_COMPARED:
            return motions, False
        return sorted(motions, key=lambda one: min(catalog.unlikeness(graph, other, one) for other in known)), True

    def _driving(self, graph: str, names: Names) -> Iterable[str]:
        """Return what may drive a graph when the statement comes to it: what it says above it, or what plays before."""
        for statement in self.statements:
            state = state_before(self.analysis, statement)
            if state is None or not state.certain or not isinstance(statement.item, syntax.Command):
                continue
            way = understood(self.analysis, statement.item).way
            layers = {} if way is None else {layer.graph: layer.motions for layer in way.layers}
            for above in names.ancestors(graph):
                if above in layers:
                    return layers[above]
            driving = (one for one in (graph, *names.ancestors(graph)) if one in state.parts)
            return state.parts[next(driving)].motions
        return ()

    def _graph(self, graph: str, names: Names, catalog: Catalog) -> Iterator[Part]:
        parent, children = names.parent(graph), names.children(graph)
        where = "the whole body" if parent is None else f"below {code(parent)}"
        above = f"; above {joined(map(code, children))}" if children else ""
        yield Part(f"graph {code(graph)}: {where}{above}")
        if self.anatomy is not None:
            joints = self.anatomy.joints(graph)
            yield Part(f"- {len(joints)} joint{'' if len(joints) == 1 else 's'}: {_some(list(map(code, joints)))}")
        motions = names.motions(graph)
        yield Part(f"- {len(motions)} motion{'' if len(motions) == 1 else 's'}: {_some(list(map(code, motions)))}")

    def _sub(self, found: Occurrence) -> Iterator[Part]:
        meant = graph_at(self.analysis, found.span)
        says = "the graph below the one that is named before `with`"
        yield Part(f"`Sub`: {says}" if meant is None else f"`Sub` is {code(meant)} here: {says}")
        if meant is not None and self._library is not None:
            yield from self._graph(meant, *self._library)

    # --- of the script ---

    def _definition(self, found: Occurrence) -> Iterator[Part]:
        made = self.analysis.made
        let = made.gathered.definitions.lets[found.symbol.name]
        yield Part(_short(" ".join(made.addressed.slice(let.span).split())), code=True)
        signature = made.gathered.definitions.signatures.get(found.symbol.name)
        if signature is not None:
            yield Part(_type(let.command))
        for parameter in described(let, signature, made)[1]:
            yield Part(f"- {code(parameter.name)}{': ' if parameter.says else ''}{parameter.says}")
        use = found.use or syntax.Reference(let.name, let.name.span)
        alone = understood(self.analysis, syntax.Command(use, None, None, use.span))
        yield from _put_in(let, alone)
        yield from self._meant(found, alone)

    def _meant(self, found: Occurrence, alone: Understood) -> Iterator[Part]:
        """Yield the graphs and motions that a definition stands for where it is used; alone, where it is defined."""
        if found.use is None:
            layers = () if alone.way is None else alone.way.layers
            meant: Mapping[str, Sequence[str]] = {layer.graph: layer.motions for layer in layers}
        else:
            meant = motions_of_use(self.analysis, [one.item for one in self.statements], found.use)
        for graph, motions in meant.items():
            yield Part(f"- on {code(graph)}: {_some(list(map(code, motions)))}")

    def _parameter(self, symbol: Symbol) -> Iterator[Part]:
        made = self.analysis.made
        let = made.gathered.definitions.lets.get(symbol.owner)
        own = () if let is None else let.parameters or ()
        parameter = next((one for one in own if normal(one.name.text) == symbol.name), None)
        if let is None or parameter is None:
            return
        signature = made.gathered.definitions.signatures.get(symbol.owner)
        kind = None if signature is None else signature.kinds.get(symbol.name)
        says = f"parameter {code(parameter.name.text)} of {code(let.name.text)}"
        yield Part(says if kind is None else f"{says}: a {kind}")
        if parameter.default is not None:
            default = " ".join(made.addressed.slice(parameter.default.span).split())
            yield Part(f"without it, {code(_short(default))}")


def _type(command: syntax.Command) -> str:
    """Return what a definition is, in words."""
    if command.once is not None:
        return "a whole statement, which plays once"
    return (
        "a motion" if command.duration is None else f"a whole statement, which lasts {code(written(command.duration))}"
    )


def _put_in(let: syntax.Let, use: Understood) -> Iterator[Part]:
    """Yield what a definition says in one use of it, if that is not what is written."""
    if use.expanded is None:
        return
    text = written(replace(use.expanded, motion=without_groups(use.expanded.motion)))
    if text != written(replace(let.command, motion=without_groups(let.command.motion))):
        yield Part("which stands here for")
        yield Part(_short(text), code=True)


def _some(listed: Sequence[str]) -> str:
    """Return words as a sentence has them, but only the first of many."""
    n_more = len(listed) - _MOST
    return joined(chain(listed[:_MOST], (f"{n_more} more",) if n_more > 0 else ())) if listed else "none"


def _short(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]} ..."
