"""An opened library: what playing, the compiler and the commands ask of a database."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from mlmg_runtime.database import read_clip, read_graphs, read_source, skeleton_from_json
from mlmg_runtime.library_file import open_database, read_properties
from mlmg_runtime.motion_graph import UNREACHABLE, MotionGraph
from mlmg_runtime.skeleton import Poses, Skeleton


@dataclass(frozen=True)
class Library:
    """A built library. Names and graphs are in memory; clips are read when they are first asked for.

    Attributes
    ----------
    path : the file.
    skeleton : shared by all clips. up : the vertical axis that outputs have, "y" or "z".
    frame_rate : frames a second. start : the root motion to start in.
    by_name : graph -> motion graph, the root first, parents before children.
    reports : graph -> what its building reported, see `built_library.GraphReport`.
    warnings : what was odd in the clips.
    configuration : the file that it was built from, where that was when it was built; None if it is not known.
    """

    path: Path
    skeleton: Skeleton = field(repr=False)
    frame_rate: float
    up: str
    start: str
    by_name: Mapping[str, MotionGraph] = field(repr=False)
    reports: Mapping[str, dict[str, Any]] = field(repr=False)
    warnings: tuple[str, ...]
    configuration: Path | None = field(default=None, repr=False)
    _poses: dict[str, Poses] = field(default_factory=dict, repr=False, compare=False)

    @cached_property
    def graphs(self) -> tuple[str, ...]:
        """Return the graphs' names, the root first."""
        return tuple(self.by_name)

    @cached_property
    def root(self) -> MotionGraph:
        """Return the graph that holds the whole body."""
        return next(graph for graph in self.by_name.values() if graph.parent is None)

    def parent(self, graph: str) -> str | None:
        """Return the graph above `graph`, or None for the root."""
        return self.by_name[graph].parent

    def ancestors(self, graph: str) -> list[str]:
        """Return the graphs above `graph`, nearest first."""
        above = []
        parent = self.parent(graph)
        while parent is not None:
            above.append(parent)
            parent = self.parent(parent)
        return above

    def motions(self, graph: str) -> Sequence[str]:
        """Return the motions on `graph`, in configuration order."""
        return self.by_name[graph].motions

    def tags(self, graph: str, motion: str) -> Sequence[str]:
        """Return the tags of `motion` on `graph`."""
        return self.by_name[graph].tags[motion]

    def can_reach(self, graph: str, source: str, target: str) -> bool:
        """Return whether transitions of `graph` lead from `source` to `target`."""
        own = self.by_name[graph]
        return bool(own.hops[own.index[source], own.index[target]] != UNREACHABLE)

    def is_forbidden(self, graph: str, source: str, target: str) -> bool:
        """Return whether the configuration forbids to go from `source` to `target` on `graph` directly."""
        own = self.by_name[graph]
        return bool(own.forbidden[own.index[source], own.index[target]])

    def unlikeness(self, graph: str, one: str, other: str) -> float:
        """Return how far apart two motions are on `graph`: their Overall Motion Similarity over the usual one.

        Usual is the median of all pairs of different motions of the graph; where that is 0, all are 0 apart.
        """
        own = self.by_name[graph]
        usual = own.usual_oms
        return float(own.oms[own.index[one], own.index[other]]) / usual if usual > 0 else 0.0

    def n_frames(self, motion: str) -> int:
        """Return how many frames a motion's clip has."""
        graph = next(graph for graph in self.by_name.values() if motion in graph.index)
        return int(graph.n_frames[graph.index[motion]])

    def source(self, motion: str) -> str | None:
        """Return the file of a motion's clip, as its path from the folder of the configuration."""
        with open_database(self.path) as connection:
            return read_source(connection, motion)

    def poses(self, motion: str) -> Poses:
        """Return a motion's clip, read on first use."""
        if motion not in self._poses:
            with open_database(self.path) as connection:
                self._poses[motion] = read_clip(connection, motion, self.skeleton)
        return self._poses[motion]


def open_library(path: str | Path) -> Library:
    """Open a library that `mlmg build` wrote, without reading its clips.

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
        graphs = read_graphs(connection)
    configuration = properties["configuration"]
    return Library(
        path=path,
        skeleton=skeleton_from_json(properties["skeleton"]),
        frame_rate=properties["frame_rate"],
        up=properties["up"],
        start=properties["start"],
        by_name={graph.name: graph for graph, _ in graphs},
        reports={graph.name: report for graph, report in graphs},
        warnings=tuple(properties["warnings"]),
        configuration=None if configuration is None else path.parent / configuration,
    )
