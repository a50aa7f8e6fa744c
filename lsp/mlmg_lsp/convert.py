"""What is found, as plain data -> what is sent. Positions are converted by `positions`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Final

from lsprotocol import types

from mlmg_lang.diagnostics import Diagnostic, Severity
from mlmg_lang.ide.links import use_leading_to
from mlmg_lang.line_diff import changed_lines
from mlmg_lang.rules import page_of, read_rule
from mlmg_lang.source import Source, Span
from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.positions import EditorPosition, Encoding, offset_from_position, range_from_span, units_in

if TYPE_CHECKING:
    from mlmg_lang.ide.markdown import Part

_SEVERITIES: Final = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    # Editors hardly show what they call a hint, and ours are worth reading.
    Severity.HINT: types.DiagnosticSeverity.Information,
}
_SIGNS: Final = re.compile(r"\*\*|^```[\w-]*\n|\n```$", re.MULTILINE)
"""Of bold words and stretches of code, as we write them."""
_UNUSED: Final = "MS054"


def range_of(source: Source, span: Span, encoding: Encoding) -> types.Range:
    """Return a span as an editor has it."""
    start, end = range_from_span(source, span, encoding)
    return types.Range(types.Position(*start), types.Position(*end))


def span_of(source: Source, place: types.Range, encoding: Encoding) -> Span:
    """Return a range of an editor as a span."""
    return Span(offset_of(source, place.start, encoding), offset_of(source, place.end, encoding))


def offset_of(source: Source, position: types.Position, encoding: Encoding) -> int:
    """Return the offset of an editor's position."""
    return offset_from_position(source, EditorPosition(position.line, position.character), encoding)


def location_of(snapshot: Snapshot, span: Span) -> types.Location:
    """Return a place in a script, or in a file that it uses."""
    source = snapshot.analysis.source
    file, base = source.file(span.start)
    own = Span(span.start - base, min(span.end - base, len(file.text)))
    place = range_of(file, own, snapshot.client.encoding)
    return types.Location(uri_of(snapshot, file.name), place)


def location_of_place(snapshot: Snapshot, file: str, span: Span) -> types.Location:
    """Return a place in a file, counted from its beginning."""
    # The whole of a file is meant by its beginning: a clip is not read for that.
    source = source_of(snapshot, file) if span.end else Source("", file)
    return types.Location(uri_of(snapshot, file), range_of(source, span, snapshot.client.encoding))


def uri_of(snapshot: Snapshot, file: str) -> str:
    """Return the URI of a file: the client's own, if it is open there."""
    if file == snapshot.analysis.source.name:
        return snapshot.uri
    return snapshot.opened[file][0] if file in snapshot.opened else Path(file).absolute().as_uri()


def source_of(snapshot: Snapshot, file: str) -> Source:
    """Return the text of a file: as it is open, or as an open script uses it, else as it is on disk."""
    known = (snapshot.analysis, *snapshot.others)
    sources = (source for one in known for source in (one.source, *one.source.used))
    found = next((source for source in sources if source.name == file), None)
    return Source(Path(file).read_bytes().decode("utf-8-sig", "replace"), file) if found is None else found


def text_of(parts: Iterable[Part]) -> str:
    """Return what there is to say as one text in Markdown."""
    return "\n\n".join(f"```motion-script\n{part.text}\n```" if part.code else part.text for part in parts)


def markup(text: str, as_it_is: bool) -> types.MarkupContent:
    """Return a text in Markdown; without its signs for a client that would show them."""
    if as_it_is:
        return types.MarkupContent(types.MarkupKind.Markdown, text)
    return types.MarkupContent(types.MarkupKind.PlainText, _SIGNS.sub("", text))


# --- diagnostics ---


def diagnostics_of(snapshot: Snapshot) -> list[types.Diagnostic]:
    """Return all that is to be said of a script."""
    return [diagnostic_of(snapshot, one) for one in snapshot.analysis.diagnostics]


def diagnostics_of_used(snapshot: Snapshot) -> dict[str, list[types.Diagnostic]]:
    """Return what is wrong in the files that a script uses, where it is, by the names of the files."""
    found: dict[str, list[types.Diagnostic]] = {}
    for one in snapshot.analysis.diagnostics:
        if one.span is not None and one.span.end > len(snapshot.analysis.source.text):
            file, _ = snapshot.analysis.source.file(one.span.start)
            use = _use_of(snapshot, one.span)
            others = [*((label.span, label.message) for label in one.places), (use, "the file is used here")]
            found.setdefault(file.name, []).append(_diagnostic(snapshot, one, one.span, others))
    return found


def diagnostic_of(snapshot: Snapshot, one: Diagnostic) -> types.Diagnostic:
    """Return a diagnostic. What is wrong in a file that the script uses is told where it is used."""
    span = one.span or Span(0, 0)
    others = [(label.span, label.message) for label in one.places]
    if span.end > len(snapshot.analysis.source.text):
        others.insert(0, (span, one.message))
        span = _use_of(snapshot, span)
    return _diagnostic(snapshot, one, span, others)


def _diagnostic(
    snapshot: Snapshot, one: Diagnostic, span: Span, others: Iterable[tuple[Span, str]]
) -> types.Diagnostic:
    client = snapshot.client
    related = [types.DiagnosticRelatedInformation(location_of(snapshot, at), said) for at, said in others]
    return types.Diagnostic(
        range=location_of(snapshot, span).range,
        message=message_of(one),
        severity=_SEVERITIES[one.severity],
        code=one.code,
        code_description=_description(one.code) if client.links else None,
        source="mlmg",
        tags=[types.DiagnosticTag.Unnecessary] if client.tags and one.code == _UNUSED else None,
        related_information=related if client.related and related else None,
        data={"rule": _meaning(one.code)},
    )


def message_of(one: Diagnostic) -> str:
    """Return all that a diagnostic says in words: what is wrong, what else to know, what to do about it."""
    notes = [f"note: {note.message}" for note in one.notes if note.span is None]
    return "\n".join([one.message, *notes, *([f"help: {one.help}"] if one.help else [])])


@cache
def _meaning(code: str) -> str:
    return read_rule(code).meaning


@cache
def _description(code: str) -> types.CodeDescription | None:
    """Return the file that tells what a code means; None where this package is not in files."""
    path = page_of(code)
    return None if path is None else types.CodeDescription(path.as_uri())


def _use_of(snapshot: Snapshot, span: Span) -> Span:
    """Return where a script uses the file that a place is in, itself or by way of others."""
    file, _ = snapshot.analysis.source.file(span.start)
    return use_leading_to(snapshot.analysis, file.name) or Span(0, 0)


# --- edits ---


def edits_between(source: Source, after: str, encoding: Encoding) -> list[types.TextEdit]:
    """Return the edits that make another text of a script, line by line, so that cursors stay where they are."""
    return [
        types.TextEdit(range_of(source, edit.span, encoding), edit.replacement) for edit in changed_lines(source, after)
    ]


def workspace_edit(snapshot: Snapshot, edits: Iterable[types.TextEdit]) -> types.WorkspaceEdit:
    """Return edits of one text; with its version, if the client knows what that is for."""
    return workspace_edits(snapshot, {snapshot.analysis.source.name: list(edits)})


def workspace_edits(snapshot: Snapshot, by_file: Mapping[str, Sequence[types.TextEdit]]) -> types.WorkspaceEdit:
    """Return edits of some files."""
    by_uri = {uri_of(snapshot, file): (file, list(edits)) for file, edits in by_file.items()}
    if not snapshot.client.versioned:
        return types.WorkspaceEdit(changes={uri: edits for uri, (_, edits) in by_uri.items()})
    return types.WorkspaceEdit(
        document_changes=[
            types.TextDocumentEdit(
                types.OptionalVersionedTextDocumentIdentifier(uri, _version_of(snapshot, file)), list(edits)
            )
            for uri, (file, edits) in by_uri.items()
        ]
    )


def _version_of(snapshot: Snapshot, file: str) -> int | None:
    """Return the version of a file, if it is open."""
    if file == snapshot.analysis.source.name:
        return snapshot.version
    return snapshot.opened[file][1] if file in snapshot.opened else None


def edit_in(snapshot: Snapshot, file: str, span: Span, text: str) -> types.TextEdit:
    """Return an edit of a file, counted from its beginning."""
    return types.TextEdit(range_of(source_of(snapshot, file), span, snapshot.client.encoding), text)


def index_after(text: str) -> int:
    """Return how long a text is as labels are counted, whatever the encoding: in UTF-16."""
    return units_in(text, "utf-16")
