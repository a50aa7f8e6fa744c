"""The names of a motion expression -> those that mean nothing, or not what their place asks for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.case import is_shouted, wrong_case
from mlmg_lang.parsing.foreign import NEXT, other_word
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.structure import SUB, group_of, is_sub
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Span
from mlmg_lang.spelling import folded, is_slip_of, listed, nearest, normal

_MAX_LISTED = 8
"""The most names that a message lists when none is like the one written."""


@dataclass(frozen=True, slots=True)
class Scope:
    """What a name can mean in a script.

    Attributes
    ----------
    definitions : the names that are defined where the expression stands; elsewhere they have been put in.
    open : whether a file that defines more could not be used.
    parameters : of the definition that the expression stands in.
    own : all definitions of the script, by name: what may have been meant.
    unread : the names of definitions that could not be read.
    explains : whether it is worked out what is wrong with a name, which takes far longer than to see that it is.
    """

    names: Names
    definitions: frozenset[str]
    open: bool
    parameters: frozenset[str] = frozenset()
    own: Mapping[str, syntax.Let] = field(default_factory=dict)
    unread: frozenset[str] = frozenset()
    explains: bool = True

    def defines(self, name: syntax.Name) -> bool:
        """Return whether a name is one of the script's own."""
        word = normal(name.text)
        return word in self.definitions or word in self.parameters or word in self.unread

    def kind_of_own(self, name: str) -> str | None:
        """Return what a name of the script's own stands for, in a word; None for other names."""
        if normal(name) in self.parameters:
            return "parameter"
        return "definition" if normal(name) in self.own else None


@dataclass(frozen=True, slots=True)
class Unbound:
    """A name that nothing can be played for; `diagnostic` is None where that is reported elsewhere, or nowhere."""

    diagnostic: Diagnostic | None


def unbound(motion: syntax.Motion, scope: Scope) -> Iterator[Unbound]:
    """Yield the names of an expression that cannot be played, in the order of the text."""
    for node, on in _parts(motion, scope):
        match node:
            case syntax.Reference(name):
                yield from _motion_name(name, scope, on)
            case syntax.Qualified():
                yield from _qualified(node, scope)
            case syntax.Call(name):
                yield from _called(node, name, scope)


def graph_hints(motion: syntax.Motion, names: Names) -> Iterator[Diagnostic]:
    """Yield the graphs' names that the library spells otherwise."""
    for node in syntax.walk(motion):
        if isinstance(node, syntax.Qualified | syntax.Call):
            name = node.graph if isinstance(node, syntax.Qualified) else node.name
            meant = SUB if is_sub(name) else names.graph(name.text)
            if meant is not None:
                yield from inexact(name, meant)


def spelling_hints(motion: syntax.Motion, scope: Scope) -> Iterator[Diagnostic]:
    """Yield the names in a definition that the library spells otherwise, and in one way only."""
    yield from graph_hints(motion, scope.names)
    for node in syntax.walk(motion):
        if isinstance(node, syntax.Reference) and not scope.defines(node.name):
            spellings = set(scope.names.spellings_of(node.name.text))
            if len(spellings) == 1:
                yield from inexact(node.name, spellings.pop())


def inexact(name: syntax.Name, meant: str) -> Iterator[Diagnostic]:
    """Yield a hint if a name is not spelt as it should be."""
    if normal(name.text) != normal(meant):
        message = f"`{name.text}` is spelt `{meant}` in the library"
        right = script_name(meant)
        yield Diagnostic("MS020", message, name.span, f"write `{right}`", fixes=(Fix(name.span, right, safe=True),))


def graph_name(name: syntax.Name, scope: Scope) -> Iterator[Unbound]:
    """Yield a name that should be a graph's, if it is not."""
    if is_sub(name) or scope.names.graph(name.text) is not None:
        return
    if not name.sound or normal(name.text) in scope.unread or not scope.explains:
        yield Unbound(None)
    elif is_shouted(name) and not scope.names.places(name.text):
        yield Unbound(wrong_case(name))
    elif scope.names.places(name.text):
        yield Unbound(_not_a_graph(name, _kind(name, scope.names), scope.names))
    elif normal(name.text) in scope.own:
        yield Unbound(_not_a_graph(name, "definition", scope.names))
    else:
        yield Unbound(_unknown_graph(name, scope.names))


def _parts(motion: syntax.Motion, scope: Scope) -> Iterator[tuple[syntax.Motion, tuple[str, ...]]]:
    """Yield the named parts of an expression, each with the graphs that it is meant for.

    What stands in a part that is reported whole is left out.
    """
    names = scope.names
    waiting: list[tuple[syntax.Motion, tuple[str, ...]]] = [(motion, names.graphs)]
    while waiting:
        part, on = waiting.pop()
        match part:
            case syntax.With(operands):
                lower = tuple(graph for graph in on if graph != names.root) or on
                waiting.extend((operand, lower) for operand in reversed(operands[1:]))
                waiting.append((operands[0], on))
            case syntax.Or(operands) | syntax.And(operands):
                waiting.extend((operand, on) for operand in reversed(operands))
            case syntax.Not(operand):
                waiting.append((operand, on))
            case syntax.Group(inner):
                waiting.append((inner, on))
            case syntax.Call(name):
                yield part, on
                inside = None if scope.defines(name) else group_of(part)
                waiting.extend([(inside, _meant(name, names))] if inside is not None else [])
            case _:
                yield part, on
                if isinstance(part, syntax.Qualified) and isinstance(part.motion, syntax.Call):
                    if any(graph_name(part.graph, scope)):
                        continue
                    waiting.append((part.motion, on))


def _meant(graph: syntax.Name, names: Names) -> tuple[str, ...]:
    """Return the graphs that a graph's name, or what stands for one, can mean."""
    if is_sub(graph):
        return names.below((names.root,))
    meant = names.graph(graph.text)
    return names.graphs if meant is None else (meant,)


def _qualified(node: syntax.Qualified, scope: Scope) -> Iterator[Unbound]:
    """Yield what is wrong with `GRAPH NAME`; the two names tell together what was meant."""
    graph = node.graph
    wrong = list(graph_name(graph, scope))
    if not isinstance(node.motion, syntax.Reference):
        yield from wrong
        return
    name = node.motion.name
    inner = list(_motion_name(name, scope, _meant(graph, scope.names)))
    if not wrong or wrong[0].diagnostic is None:
        yield from wrong or inner
        return
    pair = _Pair(node, name, tuple(inner), scope)
    told = next((told for rule in _PAIR_RULES if (told := rule(pair)) is not None), None)
    if told is not None:
        yield Unbound(told)
    elif is_shouted(graph):
        yield from wrong
    elif inner and (pair.is_known or is_shouted(name)):
        yield from inner
    else:
        yield from (*wrong, *inner)


@dataclass(frozen=True, slots=True)
class _Pair:
    """Two names side by side of which the first is no graph; `inner`: what is wrong with the second, were it one."""

    node: syntax.Qualified
    name: syntax.Name
    inner: Sequence[Unbound]
    scope: Scope

    @property
    def is_known(self) -> bool:
        """Return whether the first is the name of a motion or tag."""
        return bool(self.scope.names.places(self.node.graph.text))


def _pair_foreign(pair: _Pair) -> Diagnostic | None:
    return _word_of_other_languages(pair.node, pair.scope.names)


def _pair_swapped(pair: _Pair) -> Diagnostic | None:
    graph = _graph_meant(pair.name, pair.inner, pair.scope.names) if pair.is_known else None
    return None if graph is None else _swapped(pair.node, graph, pair.scope.names)


def _pair_with_parameter(pair: _Pair) -> Diagnostic | None:
    is_parameter = normal(pair.node.graph.text) in pair.scope.parameters
    return _beside_parameter(pair.node, pair.name) if is_parameter else None


def _pair_before_graph(pair: _Pair) -> Diagnostic | None:
    is_graph = pair.scope.names.graph(pair.name.text) is not None and not pair.name.quoted
    return _before_graph(pair.node, pair.scope.names) if is_graph and not is_shouted(pair.node.graph) else None


def _pair_needless(pair: _Pair) -> Diagnostic | None:
    word = pair.node.graph
    is_plain = not pair.inner and not is_shouted(word) and _is_plain(word, pair.scope)
    return _needless(pair.node) if is_plain else None


def _pair_spaced(pair: _Pair) -> Diagnostic | None:
    joint = f"{pair.node.graph.text}_{pair.name.text}"
    meant = next(pair.scope.names.spellings_of(joint), None) if not is_shouted(pair.node.graph) else None
    return None if meant is None else _space_in_name(pair.node, meant)


def _pair_side_by_side(pair: _Pair) -> Diagnostic | None:
    return _side_by_side(pair.node, pair.scope.names) if pair.is_known and not pair.inner else None


def _pair_with_definition(pair: _Pair) -> Diagnostic | None:
    let = pair.scope.own.get(normal(pair.node.graph.text))
    return None if let is None else _definition_as_graph(pair.node, let)


def _pair_with_once(pair: _Pair) -> Diagnostic | None:
    is_slip = bool(pair.inner) and pair.is_known and not pair.name.quoted and is_slip_of(pair.name.text, "once")
    return _misspelt_once(pair.name) if is_slip and not is_shouted(pair.name) else None


_PAIR_RULES: Final[tuple[Callable[[_Pair], Diagnostic | None], ...]] = (
    _pair_foreign,
    _pair_swapped,
    _pair_with_parameter,
    _pair_before_graph,
    _pair_needless,
    _pair_spaced,
    _pair_side_by_side,
    _pair_with_definition,
    _pair_with_once,
)
"""The special before the general."""


def _word_of_other_languages(node: syntax.Qualified, names: Names) -> Diagnostic | None:
    """Return what to say of a word that stands elsewhere for one of the language, where a graph is expected."""
    word, name = node.graph, node.motion.name
    if names.graph(name.text) is not None and _means_end(word, names):
        return _for_end(node)
    if name.quoted and other_word(word.text, "use"):
        return _for_use(word)
    return _comes_next(word) if word.text.lower() in NEXT else None


def _means_end(word: syntax.Name, names: Names) -> bool:
    if word.quoted or names.places(word.text):
        return False
    return other_word(word.text, "end") or is_slip_of(word.text, "end")


def _graph_meant(name: syntax.Name, wrong: Sequence[Unbound], names: Names) -> str | None:
    """Return the graph that a name is, or that it is most like if it is nothing else."""
    graph = names.graph(name.text)
    if graph is not None or not any(one.diagnostic is not None and one.diagnostic.code == "MS021" for one in wrong):
        return graph
    return names.nearest_graph(name.text)


def _called(node: syntax.Call, name: syntax.Name, scope: Scope) -> Iterator[Unbound]:
    if normal(name.text) in scope.parameters and group_of(node) is not None:
        yield Unbound(_before_parenthesis(node, name))
        return
    foreign = scope.open and not is_sub(name) and scope.names.graph(name.text) is None
    if foreign or scope.defines(name) or group_of(node) is None:
        yield Unbound(None)
        return
    wrong = list(graph_name(name, scope))
    if not wrong or not scope.explains or scope.names.places(name.text):
        yield from wrong
        return
    near = _own_like(name.text, scope.own.values())
    yield from (Unbound(_unknown_definition(name, near)),) if near else wrong


def _motion_name(name: syntax.Name, scope: Scope, on: Sequence[str]) -> Iterator[Unbound]:
    """Yield a name that should be a motion's or a tag's, if it is not; `on`: the graphs that it is meant for."""
    if scope.defines(name):
        yield Unbound(None)
        return
    if scope.names.places(name.text):
        return
    if not name.sound or not scope.explains or (scope.open and scope.names.graph(name.text) is None):
        yield Unbound(None)
    elif is_shouted(name):
        yield Unbound(wrong_case(name))
    elif scope.names.graph(name.text) is not None or is_sub(name):
        yield Unbound(_graph_alone(name, scope.names))
    else:
        yield Unbound(_unknown(name, scope, on))


# --- what to say -----------------------------------------------------------------------------------------


def _unknown(name: syntax.Name, scope: Scope, on: Sequence[str]) -> Diagnostic:
    names = scope.names
    message = f"no tag or motion `{name.text}` in this library"
    own = (*scope.parameters, *(let.name.text for let in scope.own.values()))
    same = tuple(word for word in own if folded(word) == folded(name.text))
    # Of own names and the library's together, the nearest are among those of each.
    near = same or nearest(name.text, (*own, *names.nearest(name.text, on)))
    near = near or names.nearest(name.text, names.graphs)
    if not near:
        near_graph = nearest(name.text, names.graphs, limit=1)
        advice = f"there is a graph `{near_graph[0]}`" if near_graph else _all_names(names, on)
        return Diagnostic("MS021", message, name.span, advice)
    fixes = tuple(Fix(name.span, script_name(word), safe=len(same) == 1) for word in near)
    return Diagnostic("MS021", message, name.span, _where(near, scope, on), fixes=fixes)


def _own_like(name: str, lets: Iterable[syntax.Let]) -> tuple[str, ...]:
    """Return the definitions that can be used with arguments, and whose names look most like one."""
    return nearest(name, (let.name.text for let in lets if let.parameters))


def _unknown_definition(name: syntax.Name, near: Sequence[str]) -> Diagnostic:
    message = f"`{name.text}` is neither a definition nor a graph"
    fixes = tuple(Fix(name.span, script_name(word), safe=False) for word in near)
    return Diagnostic("MS028", message, name.span, f"there is the definition {listed(near, 'or')}", fixes=fixes)


def _where(words: Sequence[str], scope: Scope, on: Sequence[str]) -> str:
    """Return on which graph there are some names, those of one graph together; of several, the first of `on`."""
    by_place: dict[str, list[str]] = {}
    for word in words:
        kind = scope.kind_of_own(word)
        graphs = () if kind else scope.names.places(word)
        place = f"there is the {kind}" if kind else f"on {next((g for g in on if g in graphs), graphs[0])} there is"
        by_place.setdefault(place, []).append(word)
    return "; ".join(f"{place} {listed(found, 'or')}" for place, found in by_place.items())


def _all_names(names: Names, on: Sequence[str]) -> str | None:
    """Return which tags there are, or motions if there are no tags, unless they are many."""
    known = names.tags(on) or tuple(dict.fromkeys(word for graph in on for word in names.spellings_on(graph)))
    place = f"on {on[0]} " if len(on) == 1 < len(names.graphs) else ""
    return f"{place}there are {listed(known)}" if 0 < len(known) <= _MAX_LISTED else None


def _unknown_graph(name: syntax.Name, names: Names) -> Diagnostic:
    if name.quoted and name.text.casefold() == SUB.casefold() and len(names.graphs) > 1:
        message = f"in quotes, `{name.text}` is a name like others, and no graph has it"
        fix = Fix(name.span, SUB, safe=False)
        return Diagnostic("MS026", message, name.span, f"for the graph below, write `{SUB}` without them", fixes=(fix,))
    near = nearest(name.text, (*names.graphs, *([SUB] if len(names.graphs) > 1 else [])))
    message = f"no graph `{name.text}` in this library"
    advice = f"the graphs are {listed(names.graphs)}" if len(names.graphs) > 1 else f"its one graph is `{names.root}`"
    if near:
        advice = f"there is {listed(near, 'or')}"
    fixes = tuple(Fix(name.span, script_name(graph), safe=False) for graph in near)
    return Diagnostic("MS026", message, name.span, advice, fixes=fixes)


def _not_a_graph(name: syntax.Name, kind: str, names: Names) -> Diagnostic:
    message = f"`{name.text}` is a {kind}, not a graph"
    return Diagnostic("MS025", message, name.span, f"the graphs are {listed(names.graphs)}")


def _swapped(node: syntax.Qualified, graph: str, names: Names) -> Diagnostic:
    motion = node.graph
    right = f"{script_name(graph)} {script_name(motion.text)}"
    message = f"`{motion.text}` is a {_kind(motion, names)}, not a graph; the graph comes first"
    fix = Fix(node.span, right, safe=names.graph(node.motion.name.text) is not None)
    return Diagnostic("MS025", message, node.span, f"write `{right}`", fixes=(fix,))


def _definition_as_graph(node: syntax.Qualified, let: syntax.Let) -> Diagnostic:
    """Say what `GREET WALK` is, where `GREET` is defined."""
    name, argument = node.graph.text, node.motion.name.text
    message = f"`{name}` is a definition, not a graph"
    if not let.parameters:
        place = Span(node.motion.span.start, node.motion.span.start)
        advice = f"for both at once, write `{script_name(name)} with {script_name(argument)}`"
        return Diagnostic("MS025", message, node.span, advice, fixes=(Fix(place, "with ", safe=False),))
    right = f"{script_name(name)}({script_name(argument)})"
    fix = Fix(node.span, right, safe=len(let.parameters) == 1)
    return Diagnostic("MS025", message, node.span, f"write `{right}`", fixes=(fix,))


def _is_plain(name: syntax.Name, scope: Scope) -> bool:
    """Return whether a word without quotes is like nothing known."""
    names = scope.names
    if name.quoted or not name.sound or names.nearest(name.text, names.graphs):
        return False
    return not nearest(name.text, (*names.graphs, SUB, *(let.name.text for let in scope.own.values())))


def _before_graph(node: syntax.Qualified, names: Names) -> Diagnostic:
    """Say what `unkn Upper-Body` is: the graph comes before what it is to do, which is not known either."""
    word, graph = node.graph, names.graph(node.motion.name.text) or node.motion.name.text
    known = names.spellings_on(graph)[:1]
    message = f"`{word.text}` is neither a graph nor a word of the language"
    example = f", as in `{script_name(graph)} {script_name(known[0])}`" if known else ""
    return Diagnostic("MS026", message, word.span, f"behind the graph stands what it is to do{example}")


def _needless(node: syntax.Qualified) -> Diagnostic:
    """Say what `play WALK` is."""
    word, name = node.graph, node.motion.name
    message = f"`{word.text}` is neither a graph nor a word of the language"
    fix = Fix(Span(word.span.start, name.span.start), "", safe=False)
    return Diagnostic("MS026", message, word.span, f"write `{script_name(name.text)}` alone, or a graph before it",
                      fixes=(fix,))  # fmt: skip


def _beside_parameter(node: syntax.Qualified, name: syntax.Name) -> Diagnostic:
    """Say what `x TALK` is in a definition, where `x` is a parameter."""
    place = Span(node.motion.span.start, node.motion.span.start)
    message = f"`{node.graph.text}` is a parameter, not a graph: a word is missing before `{name.text}`"
    advice = f"for both at once, write `{script_name(node.graph.text)} with {script_name(name.text)}`"
    return Diagnostic("MS025", message, node.span, advice, fixes=(Fix(place, "with ", safe=False),))


def _before_parenthesis(node: syntax.Call, name: syntax.Name) -> Diagnostic:
    """Say what `x (TALK)` is in a definition, where `x` is a parameter."""
    message = (
        f"`{name.text}` is a parameter, which stands for a motion: it is no graph, and takes nothing in parentheses"
    )
    return Diagnostic("MS025", message, node.span, f"write `{script_name(name.text)}` alone, or a graph before the `(`")


def _space_in_name(node: syntax.Qualified, meant: str) -> Diagnostic:
    """Say what `wave hand` is, where there is `WAVE_HAND`."""
    written, right = f"{node.graph.text} {node.motion.name.text}", script_name(meant)
    message = f"`{written}` is no name: there is a space in it"
    return Diagnostic("MS021", message, node.span, f"write `{right}`", fixes=(Fix(node.span, right, safe=False),))


def _for_end(node: syntax.Qualified) -> Diagnostic:
    """Say what `stop Upper-Body` is."""
    message = f"`{node.graph.text}` is not a word of the language"
    advice = f"to give a part back to the rest of the body, write `end {script_name(node.motion.name.text)}`"
    return Diagnostic("MS019", message, node.graph.span, advice, fixes=(Fix(node.graph.span, "end", safe=False),))


def _for_use(word: syntax.Name) -> Diagnostic:
    """Say what `import "gestures.ms"` is."""
    message = f"`{word.text}` is not a word of the language"
    return Diagnostic("MS019", message, word.span, "write `use`", fixes=(Fix(word.span, "use", safe=False),))


def _comes_next(word: syntax.Name) -> Diagnostic:
    """Say what is wrong with `WALK and then IDLE`."""
    advice = "what is played later stands on a line of its own, or after `;`"
    return Diagnostic("MS019", f"`{word.text}` is not a word of the language", word.span, advice)


def _misspelt_once(name: syntax.Name) -> Diagnostic:
    message = f"`{name.text}` is not a word of the language"
    fix = Fix(name.span, "once", safe=False)
    return Diagnostic("MS019", message, name.span, "did you mean `once`?", fixes=(fix,))


def _side_by_side(node: syntax.Qualified, names: Names) -> Diagnostic:
    first, second = node.graph, node.motion.name
    message = f"`{first.text}` is a {_kind(first, names)}, not a graph: a word is missing before `{second.text}`"
    both = f"{script_name(first.text)} with {script_name(second.text)}"
    advice = f"for both at once, write `{both}`; what comes later stands on a line of its own"
    place = Span(second.span.start, second.span.start)
    return Diagnostic("MS025", message, node.span, advice, fixes=(Fix(place, "with ", safe=False),))


def _graph_alone(name: syntax.Name, names: Names) -> Diagnostic:
    graph = names.graph(name.text) or name.text
    message = f"`{graph}` is a graph, not a motion"
    known = names.spellings_on(graph)[:1] if graph in names.graphs else names.spellings()[:1]
    advice = f"write what it is to do, as in `{script_name(graph)} {script_name(known[0])}`" if known else None
    return Diagnostic("MS024", message, name.span, advice)


def _kind(name: syntax.Name, names: Names) -> str:
    match = names.find_unqualified(names.places(name.text)[0], name.text)
    return "motion" if match is None else match.entry.kind
