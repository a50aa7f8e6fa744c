"""What can be asked of a library before anything is played, read from its file without numpy.

`Library` answers all of this too, and much more; but numpy takes longer to start than the check of a script.
"""

from __future__ import annotations

import json
import sys
from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from mlmg_runtime.library_file import open_database, read_part, read_properties


@dataclass(frozen=True)
class GraphNames:
    """The motions of a graph, and how they are to each other.

    Attributes
    ----------
    tags : motion -> tags, in configuration order.
    hops : for each pair of motions, row by row, the fewest transitions that lead from the one to the other; else -1.
    oms : the same way, their overall motion similarity.
    usual_oms : the median overall motion similarity of two different motions; 0 where there are not two.
    forbidden : the same way, 1 where the configuration forbids to go from the one to the other.
    """

    parent: str | None
    tags: Mapping[str, tuple[str, ...]]
    hops: Sequence[int] = field(repr=False)
    oms: Sequence[float] = field(repr=False)
    usual_oms: float
    forbidden: bytes = field(repr=False)

    @cached_property
    def motions(self) -> tuple[str, ...]:
        """Return the motions' names, in configuration order."""
        return tuple(self.tags)

    def pair(self, one: str, other: str) -> int:
        """Return where a pair of motions stands in `hops`, `oms` and `forbidden`."""
        return self._index[one] * len(self.tags) + self._index[other]

    @cached_property
    def _index(self) -> Mapping[str, int]:
        return {motion: at for at, motion in enumerate(self.tags)}


@dataclass(frozen=True)
class LibraryNames:
    """The names in a library, and what can be said of them; see `library.Library`, which answers the same.

    Attributes
    ----------
    start : the root motion to start in. frame_rate : frames a second.
    by_name : graph -> its motions, the root first, parents before children.
    frames : motion -> frames of its clip.
    """

    path: Path
    start: str
    frame_rate: float
    by_name: Mapping[str, GraphNames] = field(repr=False)
    frames: Mapping[str, int] = field(repr=False)

    @cached_property
    def graphs(self) -> tuple[str, ...]:
        """Return the graphs' names, the root first."""
        return tuple(self.by_name)

    def parent(self, graph: str) -> str | None:
        """Return the graph above `graph`, or None for the root."""
        return self.by_name[graph].parent

    def motions(self, graph: str) -> Sequence[str]:
        """Return the motions on `graph`, in configuration order."""
        return self.by_name[graph].motions

    def tags(self, graph: str, motion: str) -> Sequence[str]:
        """Return the tags of `motion` on `graph`."""
        return self.by_name[graph].tags[motion]

    def can_reach(self, graph: str, source: str, target: str) -> bool:
        """Return whether transitions of `graph` lead from `source` to `target`."""
        own = self.by_name[graph]
        return own.hops[own.pair(source, target)] >= 0

    def is_forbidden(self, graph: str, source: str, target: str) -> bool:
        """Return whether the configuration forbids to go from `source` to `target` on `graph` directly."""
        own = self.by_name[graph]
        return own.forbidden[own.pair(source, target)] == 1

    def unlikeness(self, graph: str, one: str, other: str) -> float:
        """Return how far apart two motions are on `graph`: their Overall Motion Similarity over the usual one.

        Usual is the median of all pairs of different motions of the graph; where that is 0, all are 0 apart.
        """
        own = self.by_name[graph]
        return own.oms[own.pair(one, other)] / own.usual_oms if own.usual_oms > 0 else 0.0

    def n_frames(self, motion: str) -> int:
        """Return how many frames a motion's clip has."""
        return self.frames[motion]


def open_names(path: str | Path) -> LibraryNames:
    """Open a library that `mlmg build` wrote, for its names alone.

    Raises
    ------
    LibraryError
        If the file is not a library, is damaged, or was built by another version.
    OSError
        If it cannot be opened.
    """
    path = Path(path)
    with open_database(path) as connection:
        properties = read_properties(connection)
        frames = dict(read_part(connection, "clip"))
        motions = read_part(connection, "motion")
        graphs = {}
        for name, parent, *_, forbidden, oms, hops in read_part(connection, "graph"):
            tags = {clip: tuple(json.loads(words)) for graph_of, clip, words in motions if graph_of == name}
            between, usual = _unpacked("d", oms), properties["usual_oms"][name]
            graphs[name] = GraphNames(parent, tags, _unpacked("q", hops), between, usual, forbidden)
    return LibraryNames(path, properties["start"], properties["frame_rate"], graphs, frames)


def _unpacked(kind: str, packed: bytes) -> array[Any]:
    """Return numbers of 8 bytes each, least significant first."""
    numbers = array(kind, packed)
    if sys.byteorder == "big":
        numbers.byteswap()
    return numbers
