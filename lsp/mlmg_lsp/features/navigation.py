"""What a name is, where it is defined and used, and another name for it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from lsprotocol import types

from mlmg_lang.ide import definition as definitions
from mlmg_lang.ide import hover as hovers
from mlmg_lang.ide import links, references, rename, signature
from mlmg_lang.ide.occurrences import Place
from mlmg_lang.script_files import read_script
from mlmg_lang.source import Source, Span
from mlmg_lsp.closed import Dependents
from mlmg_lsp.command_arguments import Refused
from mlmg_lsp.convert import (
    edit_in,
    index_after,
    location_of_place,
    markup,
    offset_of,
    range_of,
    source_of,
    text_of,
    workspace_edits,
)
from mlmg_lsp.library_facts import LibraryFacts, configuration_of
from mlmg_lsp.open_text import Snapshot


def hover(snapshot: Snapshot, params: types.HoverParams) -> types.Hover | None:
    """Return what there is to say of what stands at a place, and of what is wrong with it: errors first."""
    offset = _offset(snapshot, params.position)
    said = (
        hovers.hover_mistakes(snapshot.analysis, offset, errors=True),
        hovers.hover(snapshot.analysis, offset, _facts(snapshot)),
        hovers.hover_mistakes(snapshot.analysis, offset, errors=False),
    )
    found = [one for one in said if one is not None]
    if not found:
        return None
    text = text_of(part for one in found for part in one.parts)
    return types.Hover(markup(text, snapshot.client.markdown_of_hovers), _range(snapshot, found[0].span))


def _facts(snapshot: Snapshot) -> LibraryFacts | None:
    if snapshot.shelved is None:
        return None
    library = snapshot.shelved.library
    return LibraryFacts(library, configuration_of(library))


def definition(snapshot: Snapshot, params: types.DefinitionParams) -> list[types.Location] | None:
    """Return where the name at a place gets its meaning."""
    found = definitions.definition(snapshot.analysis, _offset(snapshot, params.position), _facts(snapshot))
    return None if found is None else [_location(snapshot, place) for place in found.places]


def home_of(snapshot: Snapshot, params: types.ReferenceParams | types.RenameParams) -> Path | None:
    """Return the path of the file that defines the name at a place; None if no file does."""
    home = references.home_at(snapshot.analysis, _offset(snapshot, params.position))
    return None if home is None or not Path(home).is_absolute() else Path(home)


def references_of(snapshot: Snapshot, params: types.ReferenceParams, users: Dependents) -> list[types.Location]:
    """Return where the name at a place is used, in all open texts too, and in scripts that use its file."""
    offset, declared = _offset(snapshot, params.position), params.context.include_declaration
    snapshot = _with(snapshot, users)
    return [
        _location(snapshot, place)
        for place in references.references(snapshot.analysis, offset, snapshot.others, declared)
    ]


def highlight(snapshot: Snapshot, params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
    """Return where else in a text the name at a place stands."""
    found = references.highlights(snapshot.analysis, _offset(snapshot, params.position))
    write, read = types.DocumentHighlightKind.Write, types.DocumentHighlightKind.Read
    return [types.DocumentHighlight(_range(snapshot, one.span), write if one.declares else read) for one in found]


def prepare_rename(snapshot: Snapshot, params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder:
    """Return the name at a place.

    Raises
    ------
    Refused
        That says why it cannot be another.
    """
    found = rename.prepare_rename(snapshot.analysis, _offset(snapshot, params.position))
    if isinstance(found, rename.Refusal):
        raise Refused(found.why)
    return types.PrepareRenamePlaceholder(_range(snapshot, found.span), found.name)


def rename_to(snapshot: Snapshot, params: types.RenameParams, users: Dependents) -> types.WorkspaceEdit:
    """Return the edits that give the name at a place another.

    Raises
    ------
    Refused
        That says why that cannot be.
    """
    offset, snapshot = _offset(snapshot, params.position), _with(snapshot, users)
    found = rename.rename(snapshot.analysis, offset, params.new_name, snapshot.others, snapshot.opened.keys())
    if isinstance(found, rename.Refusal):
        raise Refused(found.why)
    if users.unread:
        raise Refused("; ".join(users.unread))
    for file in found:
        if file not in snapshot.opened and _has_changed(source_of(snapshot, file)):
            raise Refused(
                f"{file} has changed since the open scripts that use it have read it: open it, or these again"
            )
    return workspace_edits(
        snapshot,
        {file: [edit_in(snapshot, file, one.span, one.replacement) for one in edits] for file, edits in found.items()},
    )


def document_link(snapshot: Snapshot, _params: types.DocumentLinkParams) -> list[types.DocumentLink]:
    """Return the paths of a script, and where they lead."""
    return [
        types.DocumentLink(_range(snapshot, one.span), target=_location(snapshot, Place(one.file, Span(0, 0))).uri)
        for one in links.document_links(snapshot.analysis)
    ]


def signature_help(snapshot: Snapshot, params: types.SignatureHelpParams) -> types.SignatureHelp | None:
    """Return what the definition takes that is being used at a place."""
    found = signature.signature_help(snapshot.analysis, _offset(snapshot, params.position))
    if found is None:
        return None
    told = [
        types.ParameterInformation(
            (index_after(found.label[: one.start]), index_after(found.label[: one.end])), one.says
        )
        for one in found.parameters
    ]
    # To a client that has to mark one, a number that there is not comes nearest to none.
    active = len(told) if found.active is None and not snapshot.client.unmarked else found.active
    shown = types.SignatureInformation(found.label, parameters=told, active_parameter=active)
    return types.SignatureHelp([shown], 0, active)


def _with(snapshot: Snapshot, users: Dependents) -> Snapshot:
    """Return what is known of a text together with what is known of scripts that are not open."""
    return replace(snapshot, others=(*snapshot.others, *users.analyses))


def _has_changed(file: Source) -> bool:
    """Return whether a file says something else than has been read of it: not all clients tell of that."""
    try:
        return read_script(file.name)[0].text != file.text
    except OSError:
        return True


def _offset(snapshot: Snapshot, position: types.Position) -> int:
    return offset_of(snapshot.analysis.source, position, snapshot.client.encoding)


def _range(snapshot: Snapshot, span: Span) -> types.Range:
    return range_of(snapshot.analysis.source, span, snapshot.client.encoding)


def _location(snapshot: Snapshot, place: Place) -> types.Location:
    return location_of_place(snapshot, place.file, place.span)
