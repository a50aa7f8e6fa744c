"""A command that cannot be obeyed -> the reason, as one who knows the library would tell it."""

from __future__ import annotations

from collections.abc import Iterator

from mlmg_lang.catalog import Catalog
from mlmg_lang.diagnostics import Diagnostic, Fix, Note
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.planning import typed
from mlmg_lang.planning.forbidding import why_forbidden
from mlmg_lang.planning.names import Kind, Names
from mlmg_lang.planning.rules.ruling import Stopped
from mlmg_lang.source import Span
from mlmg_lang.spelling import some


def reason(
    stopped: Stopped, above: typed.Statement | None, notes: tuple[Note, ...], names: Names, catalog: Catalog
) -> Diagnostic:
    """Say why a command cannot be obeyed.

    Parameters
    ----------
    above : the statement that plays what stands in the way, if it is one; it may be the command itself.
    """
    graph, motions = stopped.graph, some(stopped.motions)
    if not stopped.by_rule_1:
        message = f"nothing asked of `{graph}` can be reached from {motions}"
        advice = _missing(stopped, names, catalog)
        return Diagnostic("MS041", message, stopped.span, advice, notes)
    verb = "is" if len(stopped.motions) == 1 else "are"
    message = f"`{graph}` cannot do this during {motions}, which {verb} not on `{graph}`"
    for tag, span, free in _looser(stopped, above, names, catalog):
        advice = f"write `{tag}`: of its motions {some(free)} {'is' if len(free) == 1 else 'are'} on `{graph}`"
        return Diagnostic("MS040", message, stopped.span, advice, notes, (Fix(span, tag, safe=False),))
    free = _on_both(names.motions(stopped.above), graph, names)
    return Diagnostic("MS040", message, stopped.span, f"it can during {some(free)}" if free else None, notes)


def _missing(stopped: Stopped, names: Names, catalog: Catalog) -> str:
    """Say why no way leads from some motions to what is wanted, and what to do about it."""
    sources = _on_both(stopped.motions, stopped.graph, names)
    because = why_forbidden(stopped.graph, sources, stopped.wanted, catalog)
    if because is not None:
        return f"{because}; come from another motion"
    return f"no transition of `{stopped.graph}` leads there; play another motion in between, or first"


def _looser(
    stopped: Stopped, above: typed.Statement | None, names: Names, catalog: Catalog
) -> Iterator[tuple[str, Span, tuple[str, ...]]]:
    """Yield each tag that could stand for the one motion in the way, where it stands, and its motions on the graph."""
    layers = above.ways[0].layers if isinstance(above, typed.Command) else ()
    for layer in layers:
        if layer.graph != stopped.above or not isinstance(layer.choice, typed.Named) or layer.choice.kind is Kind.TAG:
            continue
        for tag in catalog.tags(layer.graph, layer.choice.name):
            match = names.find(layer.graph, tag, exactly=True)
            free = _on_both(match.entry.motions, stopped.graph, names) if match else ()
            if free:
                yield script_name(tag), layer.choice.span, free


def _on_both(motions: tuple[str, ...], graph: str, names: Names) -> tuple[str, ...]:
    return tuple(motion for motion in motions if motion in names.motion_set(graph))
