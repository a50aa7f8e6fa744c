"""The part of an explanation that tells what an expression stands for -> a tree of text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from mlmg_lang.explaining.explanation import (
    Expression,
    Named,
    OnGraph,
    PassedOver,
    SetExpression,
    SetOperator,
    Shared,
    With,
)
from mlmg_lang.explaining.tree import Tree
from mlmg_lang.explaining.wording import listed
from mlmg_lang.rendering.colour import BLUE, DIM


def expression_tree(expression: Expression) -> Tree:
    """Return what an expression, and each part of it, stands for."""
    match expression:
        case With():
            return _assignment("with", expression, map(expression_tree, expression.operands))
        case Shared():
            why = _passed(expression.passed_over)
            refused = (
                Tree("not over", f"{listed(one.graphs)}: {one.because}", style=(DIM,)) for one in expression.refused
            )
            children = (*why, *refused, *map(expression_tree, expression.operands))
            return _assignment("and, shared out", expression, children)
        case OnGraph():
            whole = _set(expression.expression)
            passed = tuple(_passed(expression.passed_over))
            label = expression.text if isinstance(expression.expression, Named) else whole.label
            return Tree(label, whole.text, passed + whole.children, whole.style)


def _assignment(label: str, expression: With | Shared, children: Iterable[Tree]) -> Tree:
    graphs = listed([one.graph for one in expression.assigned])
    return Tree(label, f"an assignment to {graphs}", tuple(children), (BLUE,))


def _passed(every: Sequence[PassedOver]) -> Iterator[Tree]:
    by: dict[str, list[str]] = {}
    for one in every:
        by.setdefault(one.because, []).append(one.graph)
    for because, graphs in by.items():
        yield Tree(f"not on {listed(graphs, 'or')}", because, style=(DIM,))


def _set(expression: SetExpression) -> Tree:
    motions = ", ".join(expression.motions) if expression.motions else "nothing"
    if isinstance(expression, SetOperator):
        children = tuple(map(_set, expression.operands))
        return Tree(expression.word, f"set on {expression.graph}: {motions}", children, (BLUE,))
    spelt = "" if expression.name == expression.text.strip('"') else f" {expression.name}"
    if expression.means == "motion" and not spelt and expression.motions:
        return Tree(expression.text, f"motion on {expression.graph}", style=(BLUE,))
    return Tree(expression.text, f"{expression.means}{spelt} on {expression.graph}: {motions}", style=(BLUE,))
