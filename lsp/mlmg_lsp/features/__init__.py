"""What is answered to each request: a module for each method, or for a few that belong together.

This table is all that `initialize` needs. The modules are imported after it, together with the compiler, by `warm`.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from lsprotocol import types

if TYPE_CHECKING:
    from mlmg_lsp.documents import Snapshot

Answer: TypeAlias = "Callable[[Snapshot, Any], Any]"

FEATURES: Final[tuple[tuple[str, Any, str], ...]] = (
    (
        types.TEXT_DOCUMENT_DIAGNOSTIC,
        types.DiagnosticOptions(inter_file_dependencies=True, workspace_diagnostics=False, identifier="mlmg"),
        "diagnostic.diagnostic",
    ),
    (
        types.TEXT_DOCUMENT_COMPLETION,
        types.CompletionOptions(trigger_characters=[" ", "(", '"'], resolve_provider=True),
        "completion.completion",
    ),
    (types.TEXT_DOCUMENT_FORMATTING, None, "formatting.formatting"),
    (types.TEXT_DOCUMENT_RANGE_FORMATTING, None, "formatting.range_formatting"),
    (
        types.TEXT_DOCUMENT_ON_TYPE_FORMATTING,
        types.DocumentOnTypeFormattingOptions("\n", more_trigger_character=["}"]),
        "formatting.on_type_formatting",
    ),
    (
        types.TEXT_DOCUMENT_CODE_ACTION,
        types.CodeActionOptions(
            code_action_kinds=[types.CodeActionKind.QuickFix, types.CodeActionKind.SourceFixAll], resolve_provider=True
        ),
        "code_action.code_action",
    ),
)
"""By method: what the client is told of it, and what answers a request about a text."""

RESOLVING: Final[tuple[tuple[str, str], ...]] = (
    (types.COMPLETION_ITEM_RESOLVE, "completion.resolve"),
    (types.CODE_ACTION_RESOLVE, "code_action.resolve"),
)
"""By method, what adds to an item that was answered before."""


def answer_named(name: str) -> Answer:
    """Return what answers: a function in a module of this package."""
    module, _, function = name.partition(".")
    found: Answer = getattr(import_module(f"{__name__}.{module}"), function)
    return found


def warm() -> None:
    """Import all that answers, and let the compiler do once what it does at each key.

    Work is interrupted that nobody waits for any more; a module that is being imported had better not be.
    """
    from mlmg_lang.front_end import analyse, analyse_again
    from mlmg_lang.source import Source
    from mlmg_lsp.nothing import Nothing

    for name in (*(name for _, _, name in FEATURES), *(name for _, name in RESOLVING)):
        answer_named(name)
    before = analyse(Source("let a = B for 1 sec\nrepeat 2 {\nA with\n}\n"), Nothing())
    _ = before.ready
    _ = analyse_again(before, Source("let a = B for 2 sec\na\nA\n")).diagnostics
