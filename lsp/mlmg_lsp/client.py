"""What a client says that it can do -> the few facts that the server goes by."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from lsprotocol import types

from mlmg_lsp.positions import Encoding

_ENCODINGS: Final[Mapping[str, Encoding]] = {"utf-8": "utf-8", "utf-16": "utf-16", "utf-32": "utf-32"}


@dataclass(frozen=True, slots=True)
class Client:
    """A client, as far as it makes a difference.

    Attributes
    ----------
    encoding : what it counts characters in.
    pulls : whether it asks for diagnostics; else it is told. refreshes : whether it can be told to ask again.
    related, tags : whether diagnostics may have other places, and tags.
    snippets : whether completions may have places to fill in.
    versioned : whether edits may name the version that they are for.
    resolves_edits : whether it asks for the edit of a code action when that is chosen.
    progress, configuration, watches : whether it can be asked for these.
    """

    encoding: Encoding = "utf-16"
    pulls: bool = False
    refreshes: bool = False
    related: bool = False
    tags: bool = False
    snippets: bool = False
    versioned: bool = False
    resolves_edits: bool = False
    progress: bool = False
    configuration: bool = False
    watches: bool = False


def client_from(capabilities: types.ClientCapabilities) -> Client:
    """Return what a client can do."""

    def has(path: str) -> Any:
        value: Any = capabilities
        for name in path.split("."):
            value = getattr(value, name, None)
        return value

    resolved = has("text_document.code_action.resolve_support.properties") or ()
    return Client(
        encoding=encoding_from(has("general.position_encodings") or ()),
        pulls=has("text_document.diagnostic") is not None,
        refreshes=bool(has("workspace.diagnostics.refresh_support")),
        related=bool(has("text_document.publish_diagnostics.related_information")),
        tags=bool(has("text_document.publish_diagnostics.tag_support")),
        snippets=bool(has("text_document.completion.completion_item.snippet_support")),
        versioned=bool(has("workspace.workspace_edit.document_changes")),
        resolves_edits="edit" in resolved,
        progress=bool(has("window.work_done_progress")),
        configuration=bool(has("workspace.configuration")),
        watches=bool(has("workspace.did_change_watched_files.dynamic_registration")),
    )


def encoding_from(offered: Any) -> Encoding:
    """Return the first known of the encodings that a client offers; without one, what all have to know."""
    return next((_ENCODINGS[name] for name in map(str, map(_plain, offered)) if name in _ENCODINGS), "utf-16")


def _plain(encoding: Any) -> Any:
    return getattr(encoding, "value", encoding)
