"""What is answered to each request: a module for each method, or for a few that belong together.

This table is all that `initialize` needs. The modules are imported after it, together with the compiler, by `warm`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from pkgutil import walk_packages
from typing import Any, Final, TypeAlias

from lsprotocol import types

from mlmg_lsp.memory import settle

Answer: TypeAlias = Callable[..., Any]
"""Takes a `Snapshot` and the parameters of a request, and what else it waits for."""

TOKEN_TYPES: Final = (
    *("motion", "tag", "name", "graph", "definition", "parameter", "keyword", "number", "unit", "string", "comment"),
)
"""What a token can be, by `ide.semantics.Kind`, in the order of the legend."""
_SHOWN_AS: Final = {"motion": "enumMember", "tag": "type", "name": "variable", "graph": "namespace"} | {
    "definition": "function",
    "unit": "keyword",
}
"""What themes of editors know them by, where that is another name."""
DECLARATION: Final = 1
LEGEND: Final = types.SemanticTokensLegend([_SHOWN_AS.get(one, one) for one in TOKEN_TYPES], ["declaration"])

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
            code_action_kinds=[
                types.CodeActionKind.QuickFix,
                types.CodeActionKind.Refactor,
                types.CodeActionKind.SourceFixAll,
            ],
            resolve_provider=True,
        ),
        "code_action.code_action",
    ),
    (types.TEXT_DOCUMENT_HOVER, None, "navigation.hover"),
    (types.TEXT_DOCUMENT_DEFINITION, None, "navigation.definition"),
    (types.TEXT_DOCUMENT_REFERENCES, None, "navigation.references_of"),
    (types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT, None, "navigation.highlight"),
    (types.TEXT_DOCUMENT_PREPARE_RENAME, None, "navigation.prepare_rename"),
    (types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True), "navigation.rename_to"),
    (types.TEXT_DOCUMENT_DOCUMENT_LINK, None, "navigation.document_link"),
    (
        types.TEXT_DOCUMENT_SIGNATURE_HELP,
        types.SignatureHelpOptions(trigger_characters=["(", ","]),
        "navigation.signature_help",
    ),
    (types.TEXT_DOCUMENT_CODE_LENS, None, "code_lens.code_lens"),
    (types.TEXT_DOCUMENT_DOCUMENT_SYMBOL, None, "outline.document_symbol"),
    (types.TEXT_DOCUMENT_FOLDING_RANGE, None, "structure.folding_range"),
    (types.TEXT_DOCUMENT_SELECTION_RANGE, None, "structure.selection_range"),
    (types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, LEGEND, "semantic_tokens.full"),
    (types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL_DELTA, LEGEND, "semantic_tokens.delta"),
    (types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, LEGEND, "semantic_tokens.within"),
)
"""By method: what the client is told of it, and what answers a request about a text."""

OF_A_PLACE: Final = frozenset((
    *("completion.completion", "completion.resolve", "semantic_tokens.within"),
    *("navigation.hover", "navigation.definition", "navigation.signature_help"),
))  # fmt: skip
"""What is answered by what stands before and at a place."""
ASKED_AGAIN: Final[Mapping[str, str]] = {
    "diagnostic.diagnostic": "diagnostics",
    "semantic_tokens.full": "semantic_tokens",
    "semantic_tokens.delta": "semantic_tokens",
    "code_lens.code_lens": "code_lens",
}
"""What is answered by a beginning at first, and what a client can then be told to ask again for, by its capability."""
EDITING: Final = frozenset((
    *("formatting.formatting", "formatting.range_formatting", "formatting.on_type_formatting"),
    *("code_action.code_action", "code_action.resolve", "navigation.rename_to"),
))  # fmt: skip
"""What is answered by edits, which are right for that text alone."""
OF_ALL_TEXTS: Final = frozenset({"navigation.references_of", "navigation.rename_to"})
"""What is answered by all texts that are open."""
HOME: Final = "navigation.home_of"
"""What says in which file it is defined: scripts that use it are asked too though they are not open."""

COMMANDS: Final[Mapping[str, str]] = {
    "mlmg.play": "execute_command.play",
    "mlmg.explain": "execute_command.explain",
    "mlmg.candidates": "execute_command.candidates",
    "mlmg.rule": "execute_command.rule",
}
"""By command of workspace/executeCommand, what does it; imported when it is first asked for."""

INLAY_HINT: Final = "inlay_hint.inlay_hint"
"""What answers for hints, which waits for more than a text."""
HINTS_AHEAD: Final = "inlay_hint.get_ahead"
"""What finds them out before anybody asks."""

WORKSPACE_SYMBOL: Final = "workspace_symbol.workspace_symbol"
"""What looks for names in all open texts."""

_COMPILER: Final = tuple(f"mlmg_lang.{one}" for one in ("definitions", "formatting", "ide", "parsing", "planning"))
"""The packages of which analyses and answers import modules where they need them."""

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
    """Import all that answers, with all of the compiler, and let that do once what it does at each key.

    Work is interrupted that nobody waits for any more. A module that is being imported then would be half imported from
    then on, so nothing is left to be imported later: not even what the compiler needs for rare mistakes only.
    """
    from mlmg_lang.front_end import analyse, analyse_again
    from mlmg_lang.source import Source
    from mlmg_lsp.nothing import Nothing

    for name in (*(name for _, _, name in FEATURES), *(name for _, name in RESOLVING), INLAY_HINT, WORKSPACE_SYMBOL):
        answer_named(name)
    for package in _COMPILER:
        for found in walk_packages(import_module(package).__path__, f"{package}."):
            import_module(found.name)
    before = analyse(Source("let a = B for 1 sec\nrepeat 2 {\nA with\n}\n"), Nothing())
    _ = before.ready
    _ = analyse_again(before, Source("let a = B for 2 sec\na\nA\n")).diagnostics
    settle()


def get_ahead(snapshot: Any) -> None:
    """Find out of a text that has been opened what takes long the first time, though nobody has asked yet."""
    for module in ("semantic_tokens", "outline", "code_lens", "inlay_hint", "formatting"):
        answer_named(f"{module}.get_ahead")(snapshot)
