"""A script's text -> everything that is known of it. This module alone knows the order of the stages."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from mlmg_lang.catalog import Catalog
from mlmg_lang.definitions.expand import expand
from mlmg_lang.definitions.gather import Definitions, Files, NoFiles, gather
from mlmg_lang.diagnostics import Diagnostic, has_errors
from mlmg_lang.parsing.case import guess_case
from mlmg_lang.parsing.parse import parse
from mlmg_lang.parsing.structure import check_definition, check_structure, misplaced
from mlmg_lang.parsing.syntax import Script
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source
from mlmg_lang.suppression import suppress

if TYPE_CHECKING:
    from mlmg_lang.planning.resolved import ResolvedPlan
    from mlmg_lang.planning.typed import TypedPlan


@dataclass(frozen=True, slots=True)
class Analysis:
    """What each stage has made of a script.

    Attributes
    ----------
    source : the script; with it the files that it uses.
    script : as it is written. expanded : with what its definitions say in place of their names.
    plan : None without a library.
    resolved : None without a library, or if there are errors.
    diagnostics : in the order of the text.
    """

    source: Source
    tokens: tuple[Token, ...]
    script: Script
    expanded: Script
    definitions: Definitions
    plan: TypedPlan | None
    resolved: ResolvedPlan | None
    diagnostics: tuple[Diagnostic, ...]


def analyse(
    source: Source, catalog: Catalog | None = None, start: str | None = None, files: Files | None = None
) -> Analysis:
    """Return what a script says and what is wrong with it. Whatever the text, this does not fail.

    Parameters
    ----------
    catalog : the library that the script is read against; without one, only syntax and structure are checked.
    start : the motion of the root graph to start in; without it, the script or the library says which.
    files : where the files are found that the script uses; without it, none is.
    """
    tokens = tokenize(source)
    parsed = parse(source, tokens)
    gathered = gather(source, parsed.script, files or NoFiles())
    expanded = expand(parsed.script, gathered.definitions)
    structural = _structure(parsed.script, expanded.script, gathered.definitions, catalog)
    found = (*parsed.diagnostics, *gathered.diagnostics, *expanded.diagnostics, *structural)
    analysis = Analysis(
        gathered.source, tokens, parsed.script, expanded.script, gathered.definitions, None, None, found
    )
    if catalog is None:
        analysis = replace(analysis, diagnostics=(*found, *guess_case(parsed.script)))
    else:
        analysis = _against(analysis, catalog, start)
    told = suppress(analysis.diagnostics, tokens, analysis.source, complete=analysis.resolved is not None)
    return replace(analysis, diagnostics=_sorted(told))


def _structure(
    script: Script, expanded: Script, definitions: Definitions, catalog: Catalog | None
) -> Iterator[Diagnostic]:
    frame_rate = None if catalog is None else catalog.frame_rate
    yield from misplaced(script)
    for let in definitions.lets.values():
        yield from check_definition(let, frame_rate)
    yield from check_structure(expanded, frame_rate, definitions.complete)


def _against(analysis: Analysis, catalog: Catalog, start: str | None) -> Analysis:
    """Return an analysis that goes on with what a library says."""
    # A fifth of what checking a small script without a library takes would be spent on importing these.
    from mlmg_lang.planning.names import Names
    from mlmg_lang.planning.passing import left_at_once
    from mlmg_lang.planning.plan import plan
    from mlmg_lang.planning.resolve import resolve
    from mlmg_lang.planning.unusual import unusual

    source, names = analysis.source, Names(catalog)
    planned = plan(analysis.expanded, analysis.definitions, names, catalog.frame_rate, source)
    resolution = resolve(planned.plan, names, catalog, source, start)
    found = (*analysis.diagnostics, *planned.diagnostics, *resolution.diagnostics)
    if has_errors(found):
        return replace(analysis, plan=planned.plan, diagnostics=found)
    hints = (*left_at_once(resolution, names), *unusual(resolution, names, catalog))
    return replace(analysis, plan=planned.plan, resolved=resolution.plan, diagnostics=(*found, *hints))


def _sorted(diagnostics: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
    """Return diagnostics in the order of the text, each once; those without a place come first."""
    once = {(one.code, one.span, one.message): one for one in reversed(diagnostics)}
    return tuple(sorted(once.values(), key=lambda one: (one.span is not None, one.span, one.code)))
