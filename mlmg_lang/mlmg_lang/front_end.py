"""A script's text -> everything that is known of it. This module alone knows the order of the stages."""

from __future__ import annotations

from dataclasses import dataclass, replace

from mlmg_lang.catalog import Catalog
from mlmg_lang.diagnostics import Diagnostic, has_errors
from mlmg_lang.parsing.case import guess_case
from mlmg_lang.parsing.parse import parse
from mlmg_lang.parsing.structure import check_structure
from mlmg_lang.parsing.syntax import Script
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.passing import left_at_once
from mlmg_lang.planning.plan import plan
from mlmg_lang.planning.resolve import resolve
from mlmg_lang.planning.resolved import ResolvedPlan
from mlmg_lang.planning.typed import TypedPlan
from mlmg_lang.source import Source


@dataclass(frozen=True, slots=True)
class Analysis:
    """What each stage has made of a script.

    Attributes
    ----------
    plan : None without a library.
    resolved : None without a library, or if there are errors.
    diagnostics : in the order of the text.
    """

    source: Source
    tokens: tuple[Token, ...]
    script: Script
    plan: TypedPlan | None
    resolved: ResolvedPlan | None
    diagnostics: tuple[Diagnostic, ...]


def analyse(source: Source, catalog: Catalog | None = None, start: str | None = None) -> Analysis:
    """Return what a script says and what is wrong with it. Whatever the text, this does not fail.

    Parameters
    ----------
    catalog : the library that the script is read against; without one, only syntax and structure are checked.
    start : the motion of the root graph to start in; without it, the script or the library says which.
    """
    tokens = tokenize(source)
    parsed = parse(source, tokens)
    frame_rate = None if catalog is None else catalog.frame_rate
    found = (*parsed.diagnostics, *check_structure(parsed.script, frame_rate))
    analysis = Analysis(source, tokens, parsed.script, None, None, found)
    if catalog is None:
        return replace(analysis, diagnostics=_sorted((*found, *guess_case(parsed.script))))
    return _against(analysis, catalog, start)


def _against(analysis: Analysis, catalog: Catalog, start: str | None) -> Analysis:
    """Return an analysis that goes on with what a library says."""
    source, names = analysis.source, Names(catalog)
    planned = plan(analysis.script, names, catalog.frame_rate, source)
    resolution = resolve(planned.plan, names, catalog, source, start)
    found = (*analysis.diagnostics, *planned.diagnostics, *resolution.diagnostics)
    if has_errors(found):
        return replace(analysis, plan=planned.plan, diagnostics=_sorted(found))
    hints = tuple(left_at_once(resolution, names))
    return replace(analysis, plan=planned.plan, resolved=resolution.plan, diagnostics=_sorted((*found, *hints)))


def _sorted(diagnostics: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
    """Return diagnostics in the order of the text; those without a place come first."""
    return tuple(sorted(diagnostics, key=lambda one: (one.span is not None, one.span, one.code)))
