"""Names that the library spells otherwise."""

from __future__ import annotations

from collections.abc import Iterator

from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.structure import SUB, is_sub
from mlmg_lang.planning.binding.scope import Scope
from mlmg_lang.planning.names import Names
from mlmg_lang.spelling import normal


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
