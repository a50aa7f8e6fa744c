"""What changes of a script are made of, and where in it they may be made."""

from __future__ import annotations

from dataclasses import dataclass

from mlmg_lang.analysis import Analysis
from mlmg_lang.parsing import syntax
from mlmg_lang.source import Span
from mlmg_lang.spelling import normal


@dataclass(frozen=True, slots=True)
class Edit:
    """A stretch of a script, and what is to stand in its place."""

    span: Span
    replacement: str


def lasting(node: syntax.Node, analysis: Analysis) -> bool:
    """Return whether a definition is used in a node that says itself how long it lasts."""
    signatures = analysis.made.gathered.definitions.signatures
    used = (part for part in syntax.walk(node) if isinstance(part, syntax.Reference | syntax.Call))
    return any((known := signatures.get(normal(part.name.text))) is not None and known.lasts for part in used)
