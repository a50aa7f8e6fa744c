"""Putting graphs together: which lies below which, and how well a motion's part can stand in for another's."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mlmg_runtime.building.configuration import GraphConfiguration, LibraryConfiguration
from mlmg_runtime.building.toml_files import did_you_mean
from mlmg_runtime.errors import ConfigurationError
from mlmg_runtime.point_cloud import Matrix
from mlmg_runtime.skeleton import Skeleton

OMS_BLOCK = 20


def graph_joints(configuration: LibraryConfiguration, graph: GraphConfiguration, skeleton: Skeleton) -> frozenset[int]:
    """Return the indices of a graph's joints.

    Raises
    ------
    ConfigurationError
        If a joint is not in the skeleton, or the graph is left without a joint of positive weight.
    """

    def subtree(key: str, name: str) -> frozenset[int]:
        if name not in skeleton.names:
            raise _no_joint(configuration, graph, skeleton, key, name)
        return skeleton.subtree(skeleton.names.index(name))

    wanted = frozenset(skeleton.body)
    if graph.joints is not None:
        wanted = frozenset().union(*(subtree("joints", name) for name in graph.joints))
    wanted -= frozenset().union(*(subtree("without", name) for name in graph.without))
    wanted &= frozenset(skeleton.body)
    for name in graph.weights:
        subtree("weights", name)
    if not any(graph.weights.get(skeleton.names[joint], 1.0) > 0 for joint in wanted):
        raise ConfigurationError(configuration.path, graph.line, f"no joint is left for the graph `{graph.name}`")
    return wanted


def _no_joint(
    configuration: LibraryConfiguration, graph: GraphConfiguration, skeleton: Skeleton, key: str, name: str
) -> ConfigurationError:
    """Return what to say of a joint that is named under a graph's key and that no clip has."""
    at = ("graph", configuration.graphs.index(graph), key)
    line = configuration.lines.get((*at, name), configuration.lines.get(at, graph.line))
    near = did_you_mean(name, skeleton.names) or f"; it has {', '.join(skeleton.names)}"
    message = f"the graph `{graph.name}` names a joint `{name}` that the skeleton has not{near}"
    return ConfigurationError(configuration.path, line, message)


def graph_parents(
    configuration: LibraryConfiguration, joints: Sequence[frozenset[int]], skeleton: Skeleton
) -> tuple[int | None, ...]:
    """Return for each graph the index of the graph above it: the smallest whose joints contain all of its own.

    Raises
    ------
    ConfigurationError
        If no graph, or more than one, holds the whole body, two graphs share some of their joints only, or a part of
        the body holds the travel joint.
    """
    graphs = configuration.graphs
    parents: list[int | None] = []
    for index, own in enumerate(joints):
        above = [other for other in range(len(joints)) if own < joints[other]]
        parents.append(min(above, key=lambda other: len(joints[other]), default=None))
        if above and skeleton.travel in own:
            raise ConfigurationError(
                configuration.path,
                graphs[index].line,
                f"`{graphs[index].name}` holds {skeleton.names[skeleton.travel]}, which carries the whole body and "
                "cannot move on its own; name joints below it",
            )
        for other in range(index):
            shared = own & joints[other]
            if shared and not (own < joints[other] or joints[other] < own):
                names = ", ".join(skeleton.names[joint] for joint in sorted(shared))
                raise ConfigurationError(
                    configuration.path,
                    graphs[index].line,
                    f"`{graphs[other].name}` and `{graphs[index].name}` share {names}; one of two graphs must "
                    "hold all joints of the other and more, or they must share none",
                )
    if not any(own == frozenset(skeleton.body) for own in joints):
        raise ConfigurationError(
            configuration.path, graphs[0].line, "no graph holds the whole body; leave `joints` out of one"
        )
    return tuple(parents)


def overall_motion_similarity(distances: Matrix, block: int = OMS_BLOCK) -> float:
    """Return the OMS of two motions: the mean, over blocks of windows, of the least distance in the block [MLMG].

    Smaller means that the one can stand in for the other. The last blocks may be ragged and count as blocks.

    Parameters
    ----------
    distances : array, shape (m, n). Window distances.
    block : s, windows along the side of a block.
    """
    if distances.size == 0:
        return float("inf")
    rows = np.minimum.reduceat(distances, np.arange(0, distances.shape[0], block), axis=0)
    blocks = np.minimum.reduceat(rows, np.arange(0, distances.shape[1], block), axis=1)
    return float(np.mean(blocks, dtype=np.float64))
