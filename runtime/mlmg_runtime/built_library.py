"""A library in memory, as building gives it and the database keeps it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from mlmg_runtime.motion_graph import MotionGraph
from mlmg_runtime.skeleton import Poses, Skeleton


@dataclass(frozen=True, slots=True)
class GraphReport:
    """What became of a graph's candidates and frames; distances are root mean squares over joints, length units.

    Attributes
    ----------
    n_candidates : local minima found. n_transitions : transitions kept.
    threshold : sigma as such a distance.
    bridges : source motion, target motion and distance of each transition above the threshold.
    lost_frames : motion -> frames that no endless walk passes, though a window of theirs could be in a transition.
    lost_motions : motions that cannot be reached from the others.
    """

    n_candidates: int
    n_transitions: int
    threshold: float
    bridges: tuple[tuple[str, str, float], ...]
    lost_frames: Mapping[str, int]
    lost_motions: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class BuiltLibrary:
    """A library in memory, ready to be written.

    Attributes
    ----------
    sources : clip -> its file, as a path from the folder of the configuration.
    configuration : the file that it was built from; None if that is not to be kept.
    """

    skeleton: Skeleton
    frame_rate: float
    up: str
    start: str
    poses: Mapping[str, Poses]
    graphs: tuple[MotionGraph, ...]
    reports: tuple[GraphReport, ...]
    sources: Mapping[str, str]
    warnings: tuple[str, ...]
    configuration: Path | None = None
