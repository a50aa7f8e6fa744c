"""workspace/symbol: definitions of open scripts and of the files that they use; tags and motions of the libraries."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from lsprotocol import types

from mlmg_lang.ide.occurrences import Place
from mlmg_lang.ide.symbols import Found, LibraryName, workspace_symbols
from mlmg_lang.source import Source
from mlmg_lsp.convert import range_of, source_of, uri_of
from mlmg_lsp.library_facts import LibraryFacts, configuration_of
from mlmg_lsp.open_text import Snapshot
from mlmg_runtime.library import Library

_MOST: Final = 100
"""So many, the likeliest; a client asks again when more has been written."""


def workspace_symbol(snapshots: Sequence[Snapshot], params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
    """Return what has the letters of a query in its name, the likeliest first.

    Parameters
    ----------
    snapshots : of all open texts.
    """
    if not snapshots:
        return []
    libraries = {id(one.shelved): one.shelved.library for one in snapshots if one.shelved is not None}
    # Without a letter to go by, only what is written here is worth listing.
    names = dict.fromkeys(name for library in libraries.values() for name in _names(library)) if params.query else {}
    found = workspace_symbols((one.analysis for one in snapshots), params.query, names, _MOST)
    return list(_Writer(snapshots, libraries.values()).written(found))


def _names(library: Library) -> Iterator[LibraryName]:
    for graph in library.by_name.values():
        yield from (LibraryName(tag, True) for tags in graph.tags.values() for tag in tags)
        yield from (LibraryName(motion, False) for motion in graph.motions)


class _Writer:
    """Writes symbols as a client has them."""

    def __init__(self, snapshots: Sequence[Snapshot], libraries: Iterable[Library]) -> None:
        self._snapshot = snapshots[0]
        self._facts = [LibraryFacts(library, configuration_of(library)) for library in libraries]
        self._sources: dict[str, Source] = {}

    def written(self, found: Iterable[Found | LibraryName]) -> Iterator[types.WorkspaceSymbol]:
        """Yield symbols; names of libraries only where it is known where they come from."""
        for one in found:
            if isinstance(one, Found):
                place = Place(one.file, one.symbol.selection)
                yield self._symbol(one.symbol.name, types.SymbolKind.Function, place, one.symbol.detail)
            else:
                kind = types.SymbolKind.Enum if one.is_tag else types.SymbolKind.EnumMember
                origin = next((at for facts in self._facts if (at := _origin(facts, one)) is not None), None)
                if origin is not None:
                    yield self._symbol(one.name, kind, origin, "tag" if one.is_tag else "motion")

    def _symbol(self, name: str, kind: types.SymbolKind, place: Place, beside: str) -> types.WorkspaceSymbol:
        file, span = place.file, place.span
        if file not in self._sources:
            # The whole of a file is meant by its beginning: a clip is not read for that.
            self._sources[file] = source_of(self._snapshot, file) if span.end else Source("", file)
        where = range_of(self._sources[file], span, self._snapshot.client.encoding)
        return types.WorkspaceSymbol(
            types.Location(uri_of(self._snapshot, file), where), name, kind, container_name=beside
        )


def _origin(facts: LibraryFacts, one: LibraryName) -> Place | None:
    if one.is_tag:
        return next(iter(facts.tag(one.name)), None)
    return facts.motion(one.name)
