"""Two names side by side of which the first is no graph -> what was probably meant, and how to write it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.case import is_shouted
from mlmg_lang.parsing.foreign import NEXT, other_word
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.structure import SUB
from mlmg_lang.planning.binding.sayings import kind_of
from mlmg_lang.planning.binding.scope import Scope, Unbound
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Span
from mlmg_lang.spelling import is_slip_of, nearest, normal


@dataclass(frozen=True, slots=True)
class Pair:
    """Two names side by side of which the first is no graph; `inner`: what is wrong with the second, were it one."""

    node: syntax.Qualified
    name: syntax.Name
    inner: Sequence[Unbound]
    scope: Scope

    @property
    def is_known(self) -> bool:
        """Return whether the first is the name of a motion or tag."""
        return bool(self.scope.names.places(self.node.graph.text))


def meant_by(pair: Pair) -> Diagnostic | None:
    """Return what to say of two names together; None if each is to be told of by itself."""
    return next((told for rule in _RULES if (told := rule(pair)) is not None), None)


def _foreign(pair: Pair) -> Diagnostic | None:
    return _word_of_other_languages(pair.node, pair.scope.names)


def _swapped(pair: Pair) -> Diagnostic | None:
    graph = _graph_meant(pair.name, pair.inner, pair.scope.names) if pair.is_known else None
    return None if graph is None else _say_swapped(pair.node, graph, pair.scope.names)


def _with_parameter(pair: Pair) -> Diagnostic | None:
    is_parameter = normal(pair.node.graph.text) in pair.scope.parameters
    return _beside_parameter(pair.node, pair.name) if is_parameter else None


def _before_graph(pair: Pair) -> Diagnostic | None:
    is_graph = pair.scope.names.graph(pair.name.text) is not None and not pair.name.quoted
    return _say_before_graph(pair.node, pair.scope.names) if is_graph and not is_shouted(pair.node.graph) else None


def _needless(pair: Pair) -> Diagnostic | None:
    word = pair.node.graph
    is_plain = not pair.inner and not is_shouted(word) and _is_plain(word, pair.scope)
    return _say_needless(pair.node) if is_plain else None


def _side_by_side(pair: Pair) -> Diagnostic | None:
    return _say_side_by_side(pair.node, pair.scope.names) if pair.is_known and not pair.inner else None


def _with_definition(pair: Pair) -> Diagnostic | None:
    let = pair.scope.own.get(normal(pair.node.graph.text))
    return None if let is None else _definition_as_graph(pair.node, let)


def _with_once(pair: Pair) -> Diagnostic | None:
    is_slip = bool(pair.inner) and pair.is_known and not pair.name.quoted and is_slip_of(pair.name.text, "once")
    return _misspelt_once(pair.name) if is_slip and not is_shouted(pair.name) else None


_RULES: Final[tuple[Callable[[Pair], Diagnostic | None], ...]] = (
    _foreign,
    _swapped,
    _with_parameter,
    _before_graph,
    _needless,
    _side_by_side,
    _with_definition,
    _with_once,
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


def _is_plain(name: syntax.Name, scope: Scope) -> bool:
    """Return whether a word without quotes is like nothing known."""
    names = scope.names
    if name.quoted or not name.sound or names.nearest(name.text, names.graphs):
        return False
    return not nearest(name.text, (*names.graphs, SUB, *(let.name.text for let in scope.own.values())))


def _say_swapped(node: syntax.Qualified, graph: str, names: Names) -> Diagnostic:
    motion = node.graph
    right = f"{script_name(graph)} {script_name(motion.text)}"
    message = f"`{motion.text}` is a {kind_of(motion, names)}, not a graph; the graph comes first"
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


def _say_before_graph(node: syntax.Qualified, names: Names) -> Diagnostic:
    """Say what `unkn Upper-Body` is: the graph comes before what it is to do, which is not known either."""
    word, graph = node.graph, names.graph(node.motion.name.text) or node.motion.name.text
    known = names.spellings_on(graph)[:1]
    message = f"`{word.text}` is neither a graph nor a word of the language"
    example = f", as in `{script_name(graph)} {script_name(known[0])}`" if known else ""
    return Diagnostic("MS026", message, word.span, f"behind the graph stands what it is to do{example}")


def _say_needless(node: syntax.Qualified) -> Diagnostic:
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


def _say_side_by_side(node: syntax.Qualified, names: Names) -> Diagnostic:
    first, second = node.graph, node.motion.name
    message = f"`{first.text}` is a {kind_of(first, names)}, not a graph: a word is missing before `{second.text}`"
    both = f"{script_name(first.text)} with {script_name(second.text)}"
    advice = f"for both at once, write `{both}`; what comes later stands on a line of its own"
    place = Span(second.span.start, second.span.start)
    return Diagnostic("MS025", message, node.span, advice, fixes=(Fix(place, "with ", safe=False),))
