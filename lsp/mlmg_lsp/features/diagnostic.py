"""textDocument/diagnostic, for clients that ask; the others are told."""

from __future__ import annotations

from lsprotocol import types

from mlmg_lsp.convert import diagnostics_of
from mlmg_lsp.open_text import Snapshot


def diagnostic(snapshot: Snapshot, params: types.DocumentDiagnosticParams) -> types.DocumentDiagnosticReport:
    """Return all that is to be said of a script, or that it is the same as before."""
    if not snapshot.revision:  # it is asked for again
        return types.RelatedFullDocumentDiagnosticReport(diagnostics_of(snapshot))
    found = str(snapshot.revision)
    if params.previous_result_id == found:
        return types.RelatedUnchangedDocumentDiagnosticReport(found)
    return types.RelatedFullDocumentDiagnosticReport(diagnostics_of(snapshot), result_id=found)
