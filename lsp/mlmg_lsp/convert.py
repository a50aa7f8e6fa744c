"""What is found, as plain data -> what is sent. Positions are converted by `positions`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from difflib import SequenceMatcher
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Final

from lsprotocol import types

from mlmg_lang.diagnostics import Diagnostic, Severity
from mlmg_lang.parsing import syntax
from mlmg_lang.rules import read_rule
from mlmg_lang.source import Source, Span
from mlmg_lsp.documents import Snapshot
from mlmg_lsp.positions import EditorPosition, Encoding, offset_from_position, range_from_span

_SEVERITIES: Final = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    # Editors hardly show what they call a hint, and ours are worth reading.
    Severity.HINT: types.DiagnosticSeverity.Information,
}
_UNUSED: Final = "MS054"
_MOST_COMPARED: Final = 5_000
"""Of so many lines it is worked out which of them an edit leaves alone; of more, only where it begins and ends."""


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
    uri = snapshot.uri if file is source or file.name == source.name else Path(file.name).absolute().as_uri()
    own = Span(span.start - base, min(span.end - base, len(file.text)))
    return types.Location(uri, range_of(Source(file.text, file.name), own, snapshot.client.encoding))


# --- diagnostics ---


def diagnostics_of(snapshot: Snapshot) -> list[types.Diagnostic]:
    """Return all that is to be said of a script."""
    return [diagnostic_of(snapshot, one) for one in snapshot.analysis.diagnostics]


def diagnostic_of(snapshot: Snapshot, one: Diagnostic) -> types.Diagnostic:
    """Return a diagnostic. What is wrong in a file that the script uses is told where it is used."""
    source, client = snapshot.analysis.source, snapshot.client
    span = one.span or Span(0, 0)
    others = [(label.span, label.message) for label in one.places]
    if span.end > len(source.text):
        others.insert(0, (span, one.message))
        span = _use_of(snapshot)
    related = [types.DiagnosticRelatedInformation(location_of(snapshot, at), said) for at, said in others]
    return types.Diagnostic(
        range=range_of(source, span, client.encoding),
        message=message_of(one),
        severity=_SEVERITIES[one.severity],
        code=one.code,
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


def _use_of(snapshot: Snapshot) -> Span:
    """Return where a script uses its first file."""
    made = snapshot.analysis.made
    uses = (item for piece in made.pieces for item in piece.defining if isinstance(item, syntax.Use))
    return next((made.now(item.span) for item in uses), Span(0, 0))


# --- edits ---


def edits_between(source: Source, after: str, encoding: Encoding) -> list[types.TextEdit]:
    """Return the edits that make another text of a script, line by line, so that cursors stay where they are."""
    return [types.TextEdit(range_of(source, span, encoding), new) for span, new in changed_lines(source, after)]


def changed_lines(source: Source, after: str) -> Iterator[tuple[Span, str]]:
    """Yield the stretches of whole lines that differ between two texts, with what takes the place of each."""
    starts = (*source.line_starts, len(source.text))
    old = [source.text[start:end] for start, end in pairwise(starts)]
    new = [after[start:end] for start, end in pairwise((*Source(after).line_starts, len(after)))]
    for first, last, begin, end in _differences(old, new):
        if last - first == end - begin:
            lines = zip(range(first, last), new[begin:end], strict=True)
            yield from ((Span(starts[at], starts[at + 1]), line) for at, line in lines if old[at] != line)
        else:
            yield Span(starts[first], starts[last]), "".join(new[begin:end])


def _differences(old: Sequence[str], new: Sequence[str]) -> Iterator[tuple[int, int, int, int]]:
    limit = min(len(old), len(new))
    head = next((at for at in range(limit) if old[at] != new[at]), limit)
    tail = next((at for at in range(limit - head) if old[-1 - at] != new[-1 - at]), limit - head)
    middle, others = old[head : len(old) - tail], new[head : len(new) - tail]
    if len(middle) + len(others) > _MOST_COMPARED:
        yield head, len(old) - tail, head, len(new) - tail
        return
    for kind, first, last, begin, end in SequenceMatcher(None, middle, others, autojunk=False).get_opcodes():
        if kind != "equal":
            yield first + head, last + head, begin + head, end + head


def workspace_edit(snapshot: Snapshot, edits: Iterable[types.TextEdit]) -> types.WorkspaceEdit:
    """Return edits of one text; with its version, if the client knows what that is for."""
    kept = list(edits)
    if not snapshot.client.versioned:
        return types.WorkspaceEdit(changes={snapshot.uri: kept})
    document = types.OptionalVersionedTextDocumentIdentifier(snapshot.uri, snapshot.version)
    return types.WorkspaceEdit(document_changes=[types.TextDocumentEdit(document, list(kept))])
