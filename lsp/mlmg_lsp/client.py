"""What a client says that it can do -> the few facts that the server goes by."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from lsprotocol import types

from mlmg_lsp.positions import Encoding

_ENCODINGS: Final[Mapping[str, Encoding]] = {"utf-8": "utf-8", "utf-16": "utf-16", "utf-32": "utf-32"}

_REFRESHED: Final = ("diagnostics", "code_lens", "inlay_hint", "semantic_tokens")


@dataclass(frozen=True, slots=True)
class Client:
    """A client, as far as it makes a difference.

    Attributes
    ----------
    encoding : what it counts characters in.
    pulls : whether it asks for diagnostics, and can be told to ask again; else it is told of them.
    related, tags, links : whether diagnostics may have other places, tags, and links to what they mean.
    snippets : whether completions may have places to fill in.
    markdown_of_completions, markdown_of_hovers : whether what there is to read may be Markdown.
    unmarked : whether it may mark none of the things that a definition takes.
    indents : whether it can be told how to indent what a completion writes.
    folds_lines : whether it folds whole lines only.
    versioned : whether edits may name the version that they are for.
    resolves_edits : whether it asks for the edit of a code action when that is chosen.
    progress, configuration, watches : whether it can be asked for these.
    shows : whether it can be asked to show a document.
    offers : whether messages that it shows may offer something by a button, without keeping a person from writing on.
    refreshed : of what it can be told to ask again, by the names of its capabilities.
    """

    encoding: Encoding = "utf-16"
    pulls: bool = False
    related: bool = False
    tags: bool = False
    links: bool = False
    snippets: bool = False
    markdown_of_completions: bool = False
    markdown_of_hovers: bool = False
    unmarked: bool = False
    indents: bool = False
    folds_lines: bool = False
    versioned: bool = False
    resolves_edits: bool = False
    progress: bool = False
    configuration: bool = False
    watches: bool = False
    shows: bool = False
    offers: bool = False
    refreshed: frozenset[str] = frozenset()


def client_from(capabilities: types.ClientCapabilities) -> Client:
    """Return what a client can do."""

    def has(path: str) -> Any:
        value: Any = capabilities
        for name in path.split("."):
            value = getattr(value, name, None)
        return value

    def texts(path: str) -> list[Any]:
        return list(map(_plain, has(path) or ()))

    modes = set(has("text_document.completion.completion_item.insert_text_mode_support.value_set") or ())
    resolved = has("text_document.code_action.resolve_support.properties") or ()
    return Client(
        encoding=encoding_from(has("general.position_encodings") or ()),
        # One that cannot be told to ask again would never hear of a library that is loaded later.
        pulls=has("text_document.diagnostic") is not None and bool(has("workspace.diagnostics.refresh_support")),
        related=bool(has("text_document.publish_diagnostics.related_information")),
        tags=bool(has("text_document.publish_diagnostics.tag_support")),
        links=bool(has("text_document.publish_diagnostics.code_description_support")),
        snippets=bool(has("text_document.completion.completion_item.snippet_support")),
        markdown_of_completions="markdown" in texts("text_document.completion.completion_item.documentation_format"),
        markdown_of_hovers="markdown" in texts("text_document.hover.content_format"),
        unmarked=bool(has("text_document.signature_help.signature_information.no_active_parameter_support")),
        indents=modes.issuperset(types.InsertTextMode),
        folds_lines=bool(has("text_document.folding_range.line_folding_only")),
        versioned=bool(has("workspace.workspace_edit.document_changes")),
        resolves_edits="edit" in resolved,
        progress=bool(has("window.work_done_progress")),
        configuration=bool(has("workspace.configuration")),
        watches=bool(has("workspace.did_change_watched_files.dynamic_registration")),
        shows=bool(has("window.show_document.support")),
        offers=_is_mapping_with(has("experimental"), "offers"),
        refreshed=frozenset(name for name in _REFRESHED if has(f"workspace.{name}.refresh_support")),
    )


def encoding_from(offered: Any) -> Encoding:
    """Return the first known of the encodings that a client offers; without one, what all have to know."""
    return next((_ENCODINGS[name] for name in map(str, map(_plain, offered)) if name in _ENCODINGS), "utf-16")


def _is_mapping_with(found: Any, name: str) -> bool:
    return isinstance(found, Mapping) and found.get(name) is True


def _plain(encoding: Any) -> Any:
    return getattr(encoding, "value", encoding)
