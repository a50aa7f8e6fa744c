"""What there is to say of a text is told once, and again only when it has been looked at anew."""

from dataclasses import replace

from lsprotocol import types

from mlmg_lsp.features.diagnostic import diagnostic


def asked(before: str | None = None) -> types.DocumentDiagnosticParams:
    return types.DocumentDiagnosticParams(types.TextDocumentIdentifier("untitled:x"), previous_result_id=before)


def test_what_is_known_already_is_not_told_again(snapshots):
    snapshot = next(snapshots("utf-16", 1))
    told = diagnostic(snapshot, asked())
    assert told.kind == "full"
    assert diagnostic(snapshot, asked(told.result_id)).kind == "unchanged"


def test_of_the_same_text_with_another_library_all_is_told_again(snapshots):
    snapshot = next(snapshots("utf-16", 1))
    told = diagnostic(snapshot, asked())
    assert diagnostic(replace(snapshot, revision=snapshot.revision + 1), asked(told.result_id)).kind == "full"
