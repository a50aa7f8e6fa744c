"""Where a graph is -> how soon each of its motions can be reached from there."""

from __future__ import annotations

import numpy as np

from mlmg_lang.explaining.ways import exits_of
from mlmg_runtime.arrays import FloatArray
from mlmg_runtime.motion_graph import MotionGraph, Position


def arrivals(graph: MotionGraph, position: Position) -> FloatArray:
    """Return the fewest frames until a transition has led into each motion; infinite where no way leads.

    The soonest moments at which transitions can be left are worked out in rounds, each of which lets ways be one
    transition longer.

    Returns
    -------
    array, shape (n_motions,).
    """
    edges, n_motions = graph.transitions, len(graph.motions)
    reached = np.full(n_motions, np.inf)
    if not len(edges):
        return reached
    exits = exits_of(graph)
    first = int(exits.first(np.array([position.motion]), np.array([position.frame]))[0])
    # By transition: from which moment on, less its frame, the clip can be on the way to it.
    lead = np.full(len(edges) + 1, np.inf)
    lead[first] = -position.frame
    while True:
        along = _along(lead[:-1], graph)
        leaves = along + edges["src_frame"]
        later = lead.copy()
        np.minimum.at(later, exits.onward, leaves + graph.window - edges["dst_frame"] - 1)
        later[-1] = np.inf
        if np.array_equal(later, lead):
            break
        lead = later
    np.minimum.at(reached, edges["dst_motion"], leaves + graph.window)
    return reached


def _along(lead: FloatArray, graph: MotionGraph) -> FloatArray:
    """Return the least of each transition and those before it in its clip."""
    parts = np.split(lead, graph.first_edge[1:-1])
    return np.concatenate([np.minimum.accumulate(part) for part in parts])
