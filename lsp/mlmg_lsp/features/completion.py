"""textDocument/completion and completionItem/resolve."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from lsprotocol import types

from mlmg_lang.definitions.gather import Listing
from mlmg_lang.ide.completion import Surroundings
from mlmg_lang.ide.here import state_before, tokens_around
from mlmg_lang.ide.hover import hover_declaration, of_word
from mlmg_lang.ide.matches import matches
from mlmg_lang.ide.occurrences import Sort, Symbol
from mlmg_lang.ide.offers import Completion, Offers, What
from mlmg_lang.ide.words import UNIT_SAYS, WORDS
from mlmg_lang.planning import flow
from mlmg_lang.planning.names import Names
from mlmg_lang.spelling import counted, normal
from mlmg_lsp.convert import markup, offset_of, text_of
from mlmg_lsp.nothing import NoFits, Nothing
from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.positions import EditorPosition, range_from_span
from mlmg_lsp.written import Json, Written, written

if TYPE_CHECKING:
    from mlmg_lang.front_end import Analysis
    from mlmg_runtime.library import Library

MOST_SENT: Final = 100
"""So many, the best; a client asks again when more has been written."""
_KINDS: Final[Mapping[What, int]] = {
    What.MOTION: types.CompletionItemKind.Value.value,
    What.TAG: types.CompletionItemKind.EnumMember.value,
    What.GRAPH: types.CompletionItemKind.Class.value,
    What.DEFINITION: types.CompletionItemKind.Function.value,
    What.PARAMETER: types.CompletionItemKind.Variable.value,
    What.ARGUMENT: types.CompletionItemKind.Field.value,
    What.FILE: types.CompletionItemKind.File.value,
    What.WORD: types.CompletionItemKind.Keyword.value,
    What.UNIT: types.CompletionItemKind.Unit.value,
}
_SNIPPETS: Final[Mapping[str, str]] = {
    "with": "with $0",
    "for": "for ${1:3} ${2|sec,ms,min,frames,cycles|}$0",
    "wait": "wait ${1:2} ${2|sec,ms,min,frames,cycles|}$0",
    "let": "let ${1:name} = $0",
    "repeat": "repeat ${1:2} {\n\t$0\n}",
    "choose": "choose {\n\t| $1\n\t| $0\n}",
}


@dataclass(frozen=True, slots=True)
class _Spot:
    """What completions take the place of.

    Attributes
    ----------
    place : as it is sent. stands : what stands there. is_called : whether a parenthesis stands right behind it.
    apart : whether that is several words, which a name may join otherwise.
    """

    place: Json
    stands: str
    is_called: bool
    apart: bool


def completion(snapshot: Snapshot, params: types.CompletionParams) -> Written:
    """Return what could be written at a place, the best first."""
    source, client = snapshot.analysis.source, snapshot.client
    offset = offset_of(source, params.position, client.encoding)
    tokens = tokens_around(snapshot.analysis, offset)
    meant = matches(source, tokens, offset, _surroundings(snapshot, offset), MOST_SENT)
    span = meant.offered.span
    place = _range(range_from_span(source, span, client.encoding))
    spot = _Spot(place, source.slice(span), source.text[span.end : span.end + 1] == "(", meant.apart)
    items = [_item(snapshot, one, rank, spot) for rank, one in enumerate(meant.found[:MOST_SENT])]
    return written({"isIncomplete": not meant.is_final, "items": items})


def resolve(snapshot: Snapshot, item: types.CompletionItem) -> types.CompletionItem:
    """Return a completion with what there is to read of it."""
    data = item.data if isinstance(item.data, Mapping) else {}
    text = "\n\n".join(_documentation(snapshot, data))
    if text:
        read = markup(text, snapshot.client.markdown_of_completions)
        # Who has not said that it knows kinds of texts may know of none.
        item.documentation = read if read.kind is types.MarkupKind.Markdown else read.value
    return item


def _range(ends: Iterable[EditorPosition]) -> Json:
    start, end = ({"line": line, "character": character} for line, character in ends)
    return {"start": start, "end": end}


def _item(snapshot: Snapshot, one: Completion, rank: int, spot: _Spot) -> Json:
    """Return a completion as it is sent."""
    snippet = _snippet(one, spot, snapshot.analysis) if snapshot.client.snippets else None
    item: dict[str, Json] = {
        # What is compared with it begins with the quote where one is written.
        "label": one.text if spot.stands.startswith('"') else one.name,
        "kind": _KINDS[one.what],
        "detail": _detail(one),
        "sortText": f"{rank:04}",
        "textEdit": {"range": spot.place, "newText": snippet or one.text},
        "data": {"uri": snapshot.uri, "name": one.name, "what": one.what.value, "graph": one.graph, "owner": one.owner},
    }
    if spot.apart:
        item["filterText"] = re.sub(r"[\s_-]", " ", one.name)
    if snippet:
        item["insertTextFormat"] = types.InsertTextFormat.Snippet.value
    if snapshot.client.indents:
        # Else a client may indent the line of a name as it sees fit.
        several = snippet is not None and "\n" in snippet
        mode = types.InsertTextMode.AdjustIndentation if several else types.InsertTextMode.AsIs
        item["insertTextMode"] = mode.value
    return item


def _snippet(one: Completion, spot: _Spot, analysis: Analysis) -> str | None:
    """Return a completion with places to fill in: of a definition, for what has to be given to it."""
    if one.what is What.WORD:
        return _SNIPPETS.get(one.text)
    let = analysis.made.gathered.definitions.lets.get(one.name) if one.what is What.DEFINITION else None
    needed = (
        []
        if let is None or spot.is_called
        else [part.name.text for part in let.parameters or () if part.default is None]
    )
    if not needed:
        return None
    places = ", ".join(f"${{{number}:{name}}}" for number, name in enumerate(needed, 1))
    return f"{_escaped(one.text)}({places})$0"


def _escaped(text: str) -> str:
    """Return a text as it is written in a snippet."""
    return re.sub(r"[\\$}]", r"\\\g<0>", text)


def _detail(one: Completion) -> str:
    """Return a few words that stand beside it in the list."""
    if one.graph is None:
        return one.says or one.what.value
    n_motions = f", {counted(len(one.motions), 'motion')}" if one.what is What.TAG else ""
    beside = f", the rest on {one.beside}" if one.beside else ""
    return f"{one.what.value} on {one.graph}{n_motions}{beside}"


# --- against what ---


def _surroundings(snapshot: Snapshot, offset: int) -> Surroundings:
    """Return what a text is completed against; without a library, its own definitions and the language's words."""
    definitions = snapshot.analysis.made.gathered.definitions  # names alone are asked for, so places make no difference
    paths = partial(_paths, snapshot.analysis)
    if snapshot.shelved is None:
        names = Names(Nothing())
        return Surroundings(names, definitions, flow.unknown(names), Offers(names, NoFits()), paths)
    names = snapshot.shelved.names
    before = state_before(snapshot.analysis, offset, names, snapshot.kept.get("before"))
    snapshot.kept["before"] = before
    return Surroundings(names, definitions, before.state, snapshot.shelved.offers, paths)


def _paths(analysis: Analysis, begun: str) -> Iterable[str]:
    files = analysis.question.files
    return files.paths(begun, analysis.source.name) if isinstance(files, Listing) else ()


# --- what there is to read ---


def _documentation(snapshot: Snapshot, data: Mapping[str, Any]) -> Iterator[str]:
    name, owner = str(data.get("name")), str(data.get("owner"))
    match data.get("what"):
        case What.DEFINITION:
            yield text_of(hover_declaration(snapshot.analysis, Symbol(Sort.DEFINITION, name)))
        case What.PARAMETER | What.ARGUMENT:
            parameter = Symbol(Sort.PARAMETER, normal(name.removesuffix(" = ")), owner)
            yield text_of(hover_declaration(snapshot.analysis, parameter))
        case What.WORD if name.upper() in WORDS:
            yield of_word(name, WORDS[name.upper()]).text
        case What.UNIT if name in UNIT_SAYS:
            yield of_word(name, UNIT_SAYS[name]).text
        case what if snapshot.shelved is not None:
            yield from _of_library(snapshot.shelved.library, what, name, data.get("graph"))


def _of_library(library: Library, what: object, name: str, graph: object) -> Iterator[str]:
    match what:
        case What.MOTION if graph in library.graphs and name in library.by_name[graph].index:
            yield from _of_motion(library, name)
        case What.TAG if graph in library.graphs:
            yield from _of_tag(library, str(graph), name)
        case What.GRAPH if name in library.graphs:
            yield from _of_graph(library, name)


def _of_motion(library: Library, motion: str) -> Iterator[str]:
    n_frames = library.n_frames(motion)
    yield f"**{motion}**: {n_frames / library.frame_rate:.1f} s, {n_frames} frames"
    on = [graph for graph in library.graphs if motion in library.by_name[graph].index]
    yield "\n".join(f"- {graph}: {', '.join(library.tags(graph, motion)) or 'no tags'}" for graph in on)


def _of_tag(library: Library, graph: str, tag: str) -> Iterator[str]:
    motions = [motion for motion in library.motions(graph) if tag in library.tags(graph, motion)]
    yield f"**{tag}** on {graph}: {counted(len(motions), 'motion')}"
    seconds = ((motion, library.n_frames(motion) / library.frame_rate) for motion in motions[:10])
    more = f"\n- and {len(motions) - 10} more" if len(motions) > 10 else ""
    yield "\n".join(f"- {motion}, {length:.1f} s" for motion, length in seconds) + more


def _of_graph(library: Library, graph: str) -> Iterator[str]:
    own = library.by_name[graph]
    parent = f", below {own.parent}" if own.parent else ""
    yield f"**{graph}**: {counted(len(own.motions), 'motion')}{parent}"
    yield "joints: " + ", ".join(library.skeleton.names[joint] for joint in own.joints)
