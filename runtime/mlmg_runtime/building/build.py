"""From clips to a library: the one module that knows the order of the stages of building."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from functools import partial
from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np

from mlmg_runtime.arrays import BoolArray, FloatArray, IntArray
from mlmg_runtime.building.candidates import Candidates, find_candidates
from mlmg_runtime.building.combine import graph_joints, graph_parents, overall_motion_similarity
from mlmg_runtime.building.configuration import GraphConfiguration, LibraryConfiguration, check_start
from mlmg_runtime.building.connect import Edges, Positions, bridges
from mlmg_runtime.building.hurry import hurry
from mlmg_runtime.building.load_clips import Clips, load_clips
from mlmg_runtime.built_library import BuiltLibrary, GraphReport
from mlmg_runtime.motion_graph import TRANSITION, UNREACHABLE, MotionGraph, transition_cost
from mlmg_runtime.pace import creep, stature
from mlmg_runtime.point_cloud import PointCloud, point_cloud, window_distances
from mlmg_runtime.skeleton import world_positions

# Windows this alike, root mean square over the joints, blend without being seen; a share of the body's height.
SMOOTH_SHARE = 0.02
# A bridge may lead a joint by steps this many times as long as its longest in the two clips. Blends of rotations make
# steps up to a tenth longer than blends of positions tell; what is shown is not to go half as fast again.
LARGEST_HURRY = 1.3

Progress = Callable[[str, int, int], None]


class _PairResult(NamedTuple):
    candidates: Candidates
    oms: float
    sample: FloatArray


def build_library(configuration: LibraryConfiguration, executor: Executor | None, progress: Progress) -> BuiltLibrary:
    """Build all graphs of a configuration.

    Parameters
    ----------
    configuration : checked, from `read_configuration`.
    executor : runs the comparisons of motions; None compares one after the other. The result is the same.
    progress : called with what is being done, how much of it is done, and of how much.

    Raises
    ------
    ConfigurationError, BvhError, LibraryError
        If clips and configuration do not fit together.
    """
    clips = load_clips(configuration, lambda done, total: progress("reading clips", done, total))
    joints = [graph_joints(configuration, graph, clips.skeleton) for graph in configuration.graphs]
    parents = graph_parents(configuration, joints, clips.skeleton)
    check_start(configuration, configuration.graphs[parents.index(None)])
    points = {name: world_positions(clips.skeleton, poses) for name, poses in clips.poses.items()}
    height = stature(clips.skeleton, points.values())
    built = []
    for index in _highest_first(joints):
        settings, parent = configuration.graphs[index], parents[index]
        tell = partial(progress, f"comparing the motions of {settings.name}")
        own = tuple(sorted(joints[index]))
        name_above = None if parent is None else configuration.graphs[parent].name
        built.append(_build_graph(settings, name_above, own, clips, points, height, executor, tell))
    root = built[0][0]
    return BuiltLibrary(
        skeleton=clips.skeleton,
        frame_rate=clips.frame_rate,
        up=configuration.up,
        start=configuration.start or root.motions[0],
        poses=clips.poses,
        graphs=tuple(graph for graph, _ in built),
        reports=tuple(report for _, report in built),
        sources={clip.name: _relative(clip.path, configuration) for clip in configuration.clips},
        warnings=clips.warnings,
        configuration=configuration.path,
    )


def _relative(path: object, configuration: LibraryConfiguration) -> str:
    import os

    return os.path.relpath(str(path), configuration.path.parent)


def _highest_first(joints: Sequence[frozenset[int]]) -> list[int]:
    """Return the graphs' indices, parents before children, otherwise in configuration order."""
    depth = [sum(own < other for other in joints) for own in joints]
    return sorted(range(len(joints)), key=lambda index: depth[index])


def _build_graph(
    settings: GraphConfiguration,
    parent: str | None,
    joints: tuple[int, ...],
    clips: Clips,
    points: Mapping[str, FloatArray],
    height: float,
    executor: Executor | None,
    tell: Callable[[int, int], None],
) -> tuple[MotionGraph, GraphReport]:
    motions = tuple(settings.motions)
    weights = np.array([settings.weights.get(clips.skeleton.names[joint], 1.0) for joint in joints])
    clouds = [point_cloud(points[motion][:, list(joints)], weights, settings.window) for motion in motions]
    n_frames = np.array([clips.poses[motion].n_frames for motion in motions])
    pairs = list(combinations_with_replacement(range(len(motions)), 2))
    wants_sample = settings.threshold.kind == "quantile"
    compare = partial(_compare, clouds, wants_sample)
    results: list[_PairResult] = []
    for result in map(compare, pairs) if executor is None else executor.map(compare, pairs):
        tell(len(results), len(pairs))
        results.append(result)
    tell(len(pairs), len(pairs))
    points_in_window = settings.window * float(weights.sum())
    sigma = _sigma(settings, results, points_in_window * (SMOOTH_SHARE * height) ** 2)
    forbidden = np.array([[(x, y) in settings.forbidden for y in motions] for x in motions])
    edges = _edges(settings.window, forbidden, pairs, results)
    positions = Positions(n_frames)
    if settings.threshold.kind == "auto":
        own = [points[motion][:, list(joints)] for motion in motions]
        moves = hurry(own, weights, settings.window, settings.blend, creep(height, clips.frame_rate))
        kept = edges.where(bridges(positions, edges, sigma, settings.window, lambda e: moves.of(e) > LARGEST_HURRY))
    else:
        kept = edges.where(edges.distance <= sigma)
    component = positions.component(kept)
    kept = kept.where(positions.inside(kept, component))
    graph = MotionGraph(
        name=settings.name,
        parent=parent,
        joints=joints,
        weights=weights,
        window=settings.window,
        sigma=sigma,
        blend=settings.blend,
        motions=motions,
        tags=dict(settings.motions),
        n_frames=n_frames,
        transitions=_packed(kept, sigma),
        forbidden=forbidden,
        oms=_oms(len(motions), pairs, results),
        hops=_hops(len(motions), kept),
    )
    n_candidates = sum(len(result.candidates.i) for result in results)
    return graph, _report(graph, positions, component, n_candidates, points_in_window)


def _compare(clouds: Sequence[PointCloud], wants_sample: bool, pair: tuple[int, int]) -> _PairResult:
    a, b = pair
    distances = window_distances(clouds[a], clouds[b])
    candidates = find_candidates(distances, within_motion=a == b, window=clouds[a].window)
    sample = np.empty(0)
    if wants_sample:
        shares_no_frame = clouds[a].window if a == b else -math.inf
        rows, columns = np.ogrid[: distances.shape[0], : distances.shape[1]]
        sample = distances[columns - rows >= shares_no_frame]
    return _PairResult(candidates, overall_motion_similarity(distances), sample)


def _sigma(settings: GraphConfiguration, results: Sequence[_PairResult], smooth: float) -> float:
    threshold = settings.threshold
    if threshold.kind == "number":
        return threshold.value
    if threshold.kind == "auto":
        return smooth
    everything = np.concatenate([result.sample for result in results])
    return float(np.quantile(everything, threshold.value)) if len(everything) else smooth


def _edges(
    k: int,
    forbidden: BoolArray,
    pairs: Sequence[tuple[int, int]],
    results: Sequence[_PairResult],
) -> Edges:
    """Return the transitions of all candidates, both ways, less those that the configuration forbids."""
    counts = [len(result.candidates.i) for result in results]
    a, b = (np.repeat([pair[side] for pair in pairs], counts) for side in (0, 1))
    i, s, distance = (np.concatenate([result.candidates[field] for result in results]) for field in range(3))
    edges = Edges(
        src_motion=np.concatenate((a, b)),
        src_frame=np.concatenate((i, s)),
        dst_motion=np.concatenate((b, a)),
        dst_frame=np.concatenate((s, i)) + k - 1,
        distance=np.concatenate((distance, distance)),
    )
    return edges.where(~forbidden[edges.src_motion, edges.dst_motion])


def _packed(edges: Edges, sigma: float) -> np.ndarray[tuple[int], np.dtype[np.void]]:
    packed = np.zeros(len(edges.distance), dtype=TRANSITION)
    for name in ("src_motion", "src_frame", "dst_motion", "dst_frame", "distance"):
        packed[name] = getattr(edges, name)
    packed["cost"] = transition_cost(edges.distance, sigma)
    return np.sort(packed, order=["src_motion", "src_frame", "dst_motion", "dst_frame"])


def _oms(n_motions: int, pairs: Sequence[tuple[int, int]], results: Sequence[_PairResult]) -> FloatArray:
    table = np.zeros((n_motions, n_motions))
    for (a, b), result in zip(pairs, results, strict=True):
        table[a, b] = table[b, a] = result.oms
    return table


def _hops(n_motions: int, edges: Edges) -> IntArray:
    """Return the fewest transitions from each motion to each other: the motion table, by Floyd-Warshall."""
    from scipy.sparse.csgraph import floyd_warshall

    direct = np.full((n_motions, n_motions), np.inf)
    direct[edges.src_motion, edges.dst_motion] = 1.0
    np.fill_diagonal(direct, 0.0)
    steps = floyd_warshall(direct)
    return np.where(np.isfinite(steps), steps, UNREACHABLE).astype(np.int64)


def _report(
    graph: MotionGraph,
    positions: Positions,
    component: np.ndarray[tuple[int], np.dtype[np.bool_]],
    n_candidates: int,
    points_in_window: float,
) -> GraphReport:
    dear = graph.transitions[graph.transitions["distance"] > graph.sigma]
    lost = dict(_lost_frames(graph, positions, component))
    reached = positions.motions_in(component)
    return GraphReport(
        n_candidates=n_candidates,
        n_transitions=len(graph.transitions),
        threshold=math.sqrt(graph.sigma / points_in_window),
        bridges=tuple(
            (
                graph.motions[edge["src_motion"]],
                graph.motions[edge["dst_motion"]],
                math.sqrt(edge["distance"] / points_in_window),
            )
            for edge in dear
        ),
        lost_frames=lost,
        lost_motions=tuple(motion for motion, ok in zip(graph.motions, reached, strict=True) if not ok),
    )


def _lost_frames(
    graph: MotionGraph, positions: Positions, component: np.ndarray[tuple[int], np.dtype[np.bool_]]
) -> Iterator[tuple[str, int]]:
    """Count the frames that no endless walk passes; the first k and last k - 1 never can, and do not count."""
    for index, motion in enumerate(graph.motions):
        inside = component[positions.first[index] : positions.first[index + 1]]
        n_lost = int(np.count_nonzero(~inside[graph.window : len(inside) - graph.window + 1]))
        if n_lost:
            yield motion, n_lost
