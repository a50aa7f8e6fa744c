"""What the front end may ask of a library of motions; nothing here reads a file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol


class Catalog(Protocol):
    """The names in a library, and what can be said of them before anything is played.

    Sequences are in the order of the library's configuration, which decides ties. The first graph is the root.
    """

    @property
    def graphs(self) -> Sequence[str]:
        """Return the names of the graphs; parents stand before children."""

    @property
    def start(self) -> str:
        """Return the motion of the root graph that the character starts in, unless told otherwise."""

    @property
    def frame_rate(self) -> float:
        """Return the library's frames a second."""

    def parent(self, graph: str) -> str | None:
        """Return the graph above `graph`, or None for the root."""

    def motions(self, graph: str) -> Sequence[str]:
        """Return the motions that are on `graph`."""

    def tags(self, graph: str, motion: str) -> Sequence[str]:
        """Return the tags of `motion` on `graph`."""

    def can_reach(self, graph: str, source: str, target: str) -> bool:
        """Return whether a walk on `graph` can lead from `source` to `target`."""

    def is_forbidden(self, graph: str, source: str, target: str) -> bool:
        """Return whether the library's configuration forbids to go from `source` to `target` on `graph` directly."""

    def unlikeness(self, graph: str, one: str, other: str) -> float:
        """Return how far apart two motions are on `graph`: their Overall Motion Similarity over the usual one.

        Usual is the median of all pairs of different motions of the graph.
        """

    def n_frames(self, motion: str) -> int:
        """Return how many frames a motion's clip has."""
