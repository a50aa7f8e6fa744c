"""textDocument/codeAction and codeAction/resolve: the edits that the compiler offers, one by one and all at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Final

from lsprotocol import types

from mlmg_lang.diagnostics import CODES, Diagnostic, Fix
from mlmg_lang.fixing import fix_all
from mlmg_lang.front_end import analyse_again
from mlmg_lang.ide import actions
from mlmg_lang.source import Source, Span
from mlmg_lsp.convert import diagnostic_of, edits_between, range_of, span_of, workspace_edit
from mlmg_lsp.open_text import Snapshot

QUICK_FIX: Final = types.CodeActionKind.QuickFix
FIX_ALL: Final = types.CodeActionKind.SourceFixAll


def code_action(snapshot: Snapshot, params: types.CodeActionParams) -> list[types.CodeAction]:
    """Return what could be done about a place."""
    only = [str(getattr(kind, "value", kind)) for kind in params.context.only or ()]
    span = span_of(snapshot.analysis.source, params.range, snapshot.client.encoding)
    kinds: Sequence[tuple[Sequence[str], Callable[[], Iterator[types.CodeAction]]]] = (
        ((QUICK_FIX.value,), lambda: _fixes(snapshot, span)),
        ([kind.value for kind in _KINDS.values()], lambda: _actions(snapshot, span)),
        ((FIX_ALL.value,), lambda: _fix_all(snapshot)),
    )
    if not only:
        kinds = (*kinds, (("",), lambda: _explanations(snapshot, span)))
    asked = (found for names, found in kinds if any(_is_asked_for(name, only) for name in names))
    return [one for found in asked for one in found() if _is_asked_for(str(getattr(one.kind, "value", one.kind)), only)]


def resolve(snapshot: Snapshot, action: types.CodeAction) -> types.CodeAction:
    """Return an action with its edit."""
    if action.edit is None and action.command is None:
        action.edit = _edit_of_all(snapshot)
    return action


def _is_asked_for(kind: str, only: Sequence[str]) -> bool:
    return not only or any(kind == one or kind.startswith(f"{one}.") for one in only)


def _fixes(snapshot: Snapshot, span: Span) -> Iterator[types.CodeAction]:
    """Yield the edits of the diagnostics that a stretch touches, the likeliest of each first."""
    length = len(snapshot.analysis.source.text)
    for one in _touched(snapshot, span):
        yield from (_fix(snapshot, one, fix) for fix in one.fixes if fix.span.end <= length)


def _touched(snapshot: Snapshot, span: Span) -> Iterator[Diagnostic]:
    """Yield the diagnostics of a script that a stretch of it touches."""
    length = len(snapshot.analysis.source.text)
    for one in snapshot.analysis.diagnostics:
        own = one.span or Span(0, 0)
        if own.start <= span.end and own.end >= span.start and own.end <= length:
            yield one


def _explanations(snapshot: Snapshot, span: Span) -> Iterator[types.CodeAction]:
    """Yield what tells the meaning of each code in a stretch; of no kind, as it mends nothing."""
    by_code: dict[str, list[Diagnostic]] = {}
    for one in _touched(snapshot, span):
        by_code.setdefault(one.code, []).append(one)
    for code, found in by_code.items():
        title = f"Explain `{code}`: {CODES[code].title}"
        command = types.Command(title, command="mlmg.rule", arguments=[{"code": code}])
        yield types.CodeAction(title, diagnostics=[diagnostic_of(snapshot, one) for one in found], command=command)


def _fix(snapshot: Snapshot, one: Diagnostic, fix: Fix) -> types.CodeAction:
    place = range_of(snapshot.analysis.source, fix.span, snapshot.client.encoding)
    return types.CodeAction(
        title=fix.title[:1].upper() + fix.title[1:],
        kind=QUICK_FIX,
        diagnostics=[diagnostic_of(snapshot, one)],
        is_preferred=True if fix.safe and fix is one.fixes[0] else None,
        edit=workspace_edit(snapshot, [types.TextEdit(place, fix.replacement)]),
    )


_KINDS: Final[Mapping[actions.Kind, types.CodeActionKind]] = {
    actions.Kind.SUPPRESS: QUICK_FIX,
    actions.Kind.QUALIFY: types.CodeActionKind.RefactorRewrite,
    actions.Kind.EXTRACT: types.CodeActionKind.RefactorExtract,
    actions.Kind.INLINE: types.CodeActionKind.RefactorInline,
}


def _actions(snapshot: Snapshot, span: Span) -> Iterator[types.CodeAction]:
    """Yield what can be rewritten in a stretch, and what silences the diagnostics that are there."""
    source, encoding = snapshot.analysis.source, snapshot.client.encoding
    for one in actions.actions(snapshot.analysis, span, snapshot.used):
        edits = [types.TextEdit(range_of(source, edit.span, encoding), edit.replacement) for edit in one.edits]
        yield types.CodeAction(
            title=one.title[:1].upper() + one.title[1:],
            kind=_KINDS[one.kind],
            diagnostics=None if one.about is None else [diagnostic_of(snapshot, one.about)],
            edit=workspace_edit(snapshot, edits),
        )


def _fix_all(snapshot: Snapshot) -> Iterator[types.CodeAction]:
    """Yield the one action that applies all edits that are safe, if there are any."""
    if not any(fix.safe for one in snapshot.analysis.diagnostics for fix in one.fixes):
        return
    edit = None if snapshot.client.resolves_edits else _edit_of_all(snapshot)
    yield types.CodeAction("Fix all that is sure to be meant", kind=FIX_ALL, edit=edit, data={"uri": snapshot.uri})


def _edit_of_all(snapshot: Snapshot) -> types.WorkspaceEdit:
    source = snapshot.analysis.source
    fixed = fix_all(source, snapshot.analysis.diagnostics, partial(_diagnosed, snapshot))
    return workspace_edit(snapshot, edits_between(source, fixed.source.text, snapshot.client.encoding))


def _diagnosed(snapshot: Snapshot, source: Source) -> tuple[Source, Sequence[Diagnostic]]:
    again = analyse_again(snapshot.analysis, source)
    return again.source, again.diagnostics
