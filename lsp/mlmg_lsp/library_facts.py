"""A library, as what `mlmg_lang.ide` asks of one beyond its names: anatomy, transitions, and where things come from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from mlmg_lang.ide.occurrences import Place
from mlmg_lang.source import Source, Span
from mlmg_runtime.building.toml_files import TomlFile, read_toml
from mlmg_runtime.errors import MlmgError
from mlmg_runtime.library import Library


@dataclass(frozen=True)
class LibraryFacts:
    """Answers `ide.hover_name.Anatomy` and `ide.definition.Origins`.

    Attributes
    ----------
    configuration : the file that the library was built from; None if it is not known. It is read when first needed.
    """

    library: Library
    configuration: Path | None

    def joints(self, graph: str) -> Sequence[str]:
        """Return the joints of a graph."""
        return [self.library.skeleton.names[joint] for joint in self.library.by_name[graph].joints]

    def transitions(self, graph: str, motion: str) -> Mapping[str, int]:
        """Return, by motion, how many transitions of a graph lead there from a motion."""
        own = self.library.by_name[graph]
        index = own.index[motion]
        leaving = own.transitions[own.first_edge[index] : own.first_edge[index + 1]]
        numbers = np.bincount(leaving["dst_motion"], minlength=len(own.motions))
        return dict(zip(own.motions, map(int, numbers), strict=True))

    def motion(self, motion: str) -> Place | None:
        """Return the file of a motion's clip; None if it is not there (any more), or the library cannot be read now."""
        try:
            source = self.library.source(motion)
        except (MlmgError, OSError):
            return None
        if source is None or self.configuration is None:
            return None
        path = self.configuration.parent / source
        return Place(str(path.resolve()), Span(0, 0)) if path.is_file() else None

    def tag(self, tag: str, graph: str | None = None) -> tuple[Place, ...]:
        """Return the lines of the configuration that give a tag to motions, those of one of the graphs first."""
        file = self._file
        tables = {} if file is None else file.document.get("tags", {})
        keys = [
            ("tags", on, motion)
            for on, motions in (tables.items() if isinstance(tables, dict) else ())
            for motion, tags in (motions.items() if isinstance(motions, dict) else ())
            if isinstance(tags, list) and tag in tags
        ]
        keys.sort(key=lambda key: key[1] != graph)
        return tuple(place for key in keys if (place := self._place(key)) is not None)

    def graph(self, graph: str) -> Place | None:
        """Return the line of the configuration where a graph is described."""
        file = self._file
        tables = [] if file is None else file.document.get("graph", [])
        named = (at for at, table in enumerate(tables) if isinstance(table, dict) and table.get("name") == graph)
        at = next(named, None)
        return None if at is None else self._place(("graph", at, "name"))

    @cached_property
    def _file(self) -> TomlFile | None:
        """Return the configuration as it is now; None if it cannot be read."""
        try:
            return None if self.configuration is None else read_toml(self.configuration)
        except (MlmgError, OSError):
            return None

    @cached_property
    def _source(self) -> Source:
        """Return the text of the configuration, with its own line ends, which count."""
        assert self._file is not None
        return Source(self._file.path.read_bytes().decode("utf-8-sig"), str(self._file.path.resolve()))

    def _place(self, key: tuple[str | int, ...]) -> Place | None:
        """Return the line on which a key stands."""
        line = None if self._file is None else self._file.lines.get(key)
        if line is None:
            return None
        text = self._source.text
        starts = (*self._source.line_starts[line - 1 : line + 1], len(text) + 1)
        return Place(self._source.name, Span(starts[0], starts[0] + len(text[starts[0] : starts[1]].rstrip("\r\n"))))


def configuration_of(library: Library) -> Path | None:
    """Return the file that a library was built from; None if it is not there.

    Where the library does not know, it is probably the file beside it that is called as it is, or `library.toml`.
    """
    beside = (library.path.with_suffix(".toml"), library.path.with_name("library.toml"))
    known = beside if library.configuration is None else (library.configuration,)
    return next((path for path in known if path.is_file()), None)
