"""A library of nothing, for texts without one."""

from __future__ import annotations

from collections.abc import Mapping


class Nothing:
    """A `Catalog` with one graph, on which there is no motion."""

    graphs = ("",)
    start = ""
    frame_rate = 1.0

    def parent(self, graph: str) -> None:
        """Return that the graph is the root."""

    def motions(self, graph: str) -> tuple[str, ...]:
        """Return no motion."""
        return ()

    def tags(self, graph: str, motion: str) -> tuple[str, ...]:
        """Return no tag."""
        return ()

    def can_reach(self, graph: str, source: str, target: str) -> bool:
        """Return that nothing is reached."""
        return False

    def is_forbidden(self, graph: str, source: str, target: str) -> bool:
        """Return that nothing is forbidden."""
        return False

    def unlikeness(self, graph: str, one: str, other: str) -> float:
        """Return that nothing differs."""
        return 0.0

    def n_frames(self, motion: str) -> int:
        """Return that nothing lasts."""
        return 0


class NoFits:
    """What goes with what is playing: nothing."""

    def fits(self, graph: str, above: object) -> Mapping[str, float]:
        """Return no motion."""
        return {}
