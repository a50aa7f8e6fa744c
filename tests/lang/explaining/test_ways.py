"""The soonest ways from everywhere: held against the search that playing uses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.explaining.ways import exits_of, ways_into
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.search import find_path


def check(graph: MotionGraph, step: int, to_begin: bool) -> int:
    """Hold the ways between all motions, from every `step`-th frame, against the search; return how many lead there."""
    exits, found = exits_of(graph), 0
    dst_frame = graph.window - 1 if to_begin else None
    for target, name in enumerate(graph.motions):
        into = ways_into(graph, exits, target, to_begin)
        for motion, n_frames in enumerate(graph.n_frames.tolist()):
            frames = np.arange(0, n_frames, step)
            motions = np.full(len(frames), motion)
            for frame, way, arrival in zip(
                frames.tolist(), into.ways(motions, frames), into.arrivals(motions, frames), strict=True
            ):
                path = find_path(graph, Position(motion, frame), [target], dst_frame=dst_frame)
                place = (graph.name, graph.motions[motion], frame, name)
                if path is None:
                    assert not np.isfinite(way.real), place
                    assert arrival == -1, place
                else:
                    found += 1
                    assert way.real == path.n_frames, place
                    assert way.imag == pytest.approx(path.cost), place
                    assert arrival == path.arrival.frame, place
    return found


@pytest.mark.parametrize("to_begin", [False, True])
def test_every_way_is_as_soon_and_as_smooth_as_the_search_finds_it(made_library, to_begin):
    assert all(check(graph, 3, to_begin) for graph in made_library.by_name.values())


def test_every_way_of_the_demo_library_is_as_soon_and_as_smooth_as_the_search_finds_it(demo_library: Library):
    assert all(check(graph, 41, to_begin=False) for graph in demo_library.by_name.values())


def test_every_way_of_real_clips_is_as_soon_and_as_smooth_as_the_search_finds_it(reference_library: Library):
    assert all(check(graph, 47, to_begin=False) for graph in reference_library.by_name.values())


@given(data=st.data(), to_begin=st.booleans())
def test_of_any_transitions_the_ways_are_those_of_the_search(data, to_begin, made_library):
    """Some of a graph's transitions are left, so that some ways end; costs differ, so that no two are as good."""
    graph = made_library.root
    kept = data.draw(st.lists(st.booleans(), min_size=len(graph.edges), max_size=len(graph.edges)))
    edges = graph.transitions[np.array(kept)].copy()
    edges["cost"] = 1.0 / (2.0 + np.sqrt(np.arange(len(edges))))
    check(_with_hops(replace(graph, transitions=edges)), 11, to_begin)


def _with_hops(graph: MotionGraph) -> MotionGraph:
    """Return a graph with the motion table of its transitions, which the search relies on."""
    n = len(graph.motions)
    hops = np.where(np.eye(n, dtype=bool), 0, n + 1)
    for edge in graph.edges:
        hops[edge.src_motion, edge.dst_motion] = min(1, hops[edge.src_motion, edge.dst_motion])
    for middle in range(n):
        hops = np.minimum(hops, hops[:, [middle]] + hops[[middle], :])
    return replace(graph, hops=np.where(hops > n, -1, hops))


def test_from_a_motion_that_a_graph_does_not_have_no_way_leads(made_library):
    graph = made_library.root
    into = ways_into(graph, exits_of(graph), 2)
    assert not np.isfinite(into.ways(np.array([-1]), np.array([5])).real).any()
