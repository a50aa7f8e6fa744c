"""What is answered to each request: a module for each method, or for a few that belong together.

This table is all that `initialize` needs. The modules are imported after it, together with the compiler, by `warm`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum, auto
from importlib import import_module
from pkgutil import walk_packages
from typing import Any, Final, TypeAlias

from lsprotocol import types

from mlmg_lsp.features.legend import LEGEND
from mlmg_lsp.memory import settle

Answer: TypeAlias = Callable[..., Any]
"""Takes a `Snapshot` and the parameters of a request, and what else it waits for."""


class Scope(Enum):
    """What a request is about."""

    TEXT = auto()
    FORESEEN = auto()
    """A text, and how its commands will go."""
    USERS = auto()
    """A text, all others that are open, and those on disk that use the file of a definition."""
    ALL_OPEN = auto()
    ITEM = auto()
    """Something that was answered before, and says itself of which text it is."""


@dataclass(frozen=True, slots=True)
class Feature:
    """A request, and what answers it.

    Attributes
    ----------
    method : as the protocol names it. options : what a client is told of it.
    answer : a function in a module of this package.
    early : whether what stands before and at a place is enough, if the text is still being read.
    refreshed : the name of what a client can be told to ask for again; if it can, any beginning of the text will do.
    edits : whether the answer is edits, which are right for that text alone.
    """

    method: str
    answer: str
    options: Any = None
    scope: Scope = Scope.TEXT
    early: bool = False
    refreshed: str = ""
    edits: bool = False


FEATURES: Final = (
    Feature(
        types.TEXT_DOCUMENT_DIAGNOSTIC,
        "diagnostic.diagnostic",
        types.DiagnosticOptions(inter_file_dependencies=True, workspace_diagnostics=False, identifier="mlmg"),
        refreshed="diagnostics",
    ),
    Feature(
        types.TEXT_DOCUMENT_COMPLETION,
        "completion.completion",
        types.CompletionOptions(trigger_characters=[" ", "(", '"'], resolve_provider=True),
        early=True,
    ),
    Feature(types.COMPLETION_ITEM_RESOLVE, "completion.resolve", scope=Scope.ITEM, early=True),
    Feature(types.TEXT_DOCUMENT_FORMATTING, "formatting.formatting", edits=True),
    Feature(types.TEXT_DOCUMENT_RANGE_FORMATTING, "formatting.range_formatting", edits=True),
    Feature(
        types.TEXT_DOCUMENT_ON_TYPE_FORMATTING,
        "formatting.on_type_formatting",
        types.DocumentOnTypeFormattingOptions("\n", more_trigger_character=["}"]),
        edits=True,
    ),
    Feature(
        types.TEXT_DOCUMENT_CODE_ACTION,
        "code_action.code_action",
        types.CodeActionOptions(
            code_action_kinds=[
                types.CodeActionKind.QuickFix,
                types.CodeActionKind.Refactor,
                types.CodeActionKind.SourceFixAll,
            ],
            resolve_provider=True,
        ),
        edits=True,
    ),
    Feature(types.CODE_ACTION_RESOLVE, "code_action.resolve", scope=Scope.ITEM, edits=True),
    Feature(types.TEXT_DOCUMENT_HOVER, "navigation.hover", early=True),
    Feature(types.TEXT_DOCUMENT_DEFINITION, "navigation.definition", early=True),
    Feature(types.TEXT_DOCUMENT_REFERENCES, "navigation.references_of", scope=Scope.USERS),
    Feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT, "navigation.highlight"),
    Feature(types.TEXT_DOCUMENT_PREPARE_RENAME, "navigation.prepare_rename"),
    Feature(
        types.TEXT_DOCUMENT_RENAME,
        "navigation.rename_to",
        types.RenameOptions(prepare_provider=True),
        scope=Scope.USERS,
        edits=True,
    ),
    Feature(types.TEXT_DOCUMENT_DOCUMENT_LINK, "navigation.document_link"),
    Feature(
        types.TEXT_DOCUMENT_SIGNATURE_HELP,
        "navigation.signature_help",
        types.SignatureHelpOptions(trigger_characters=["(", ","]),
        early=True,
    ),
    Feature(types.TEXT_DOCUMENT_INLAY_HINT, "inlay_hint.inlay_hint", scope=Scope.FORESEEN),
    Feature(types.TEXT_DOCUMENT_CODE_LENS, "code_lens.code_lens", refreshed="code_lens"),
    Feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL, "outline.document_symbol"),
    Feature(types.WORKSPACE_SYMBOL, "workspace_symbol.workspace_symbol", scope=Scope.ALL_OPEN),
    Feature(types.TEXT_DOCUMENT_FOLDING_RANGE, "structure.folding_range"),
    Feature(types.TEXT_DOCUMENT_SELECTION_RANGE, "structure.selection_range"),
    Feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, "semantic_tokens.full", LEGEND, refreshed="semantic_tokens"),
    Feature(
        types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL_DELTA, "semantic_tokens.delta", LEGEND, refreshed="semantic_tokens"
    ),
    Feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, "semantic_tokens.within", LEGEND, early=True),
)

COMMANDS: Final[Mapping[str, str]] = {
    "mlmg.play": "execute_command.play",
    "mlmg.explain": "execute_command.explain",
    "mlmg.candidates": "execute_command.candidates",
    "mlmg.rule": "execute_command.rule",
}
"""By command of workspace/executeCommand, what does it; imported when it is first asked for."""

_COMPILER: Final = tuple(f"mlmg_lang.{one}" for one in ("definitions", "formatting", "ide", "parsing", "planning"))
"""The packages of which analyses and answers import modules where they need them."""


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

    for feature in FEATURES:
        answer_named(feature.answer)
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
