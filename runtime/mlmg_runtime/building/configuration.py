"""The configuration of a library, as data: which clips, which graphs with which joints, motions, tags and settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from mlmg_runtime.building.toml_files import did_you_mean
from mlmg_runtime.building.toml_lines import KeyPath
from mlmg_runtime.errors import ConfigurationError


@dataclass(frozen=True, slots=True)
class ClipSource:
    """Where a motion comes from: a BVH file, and which of its frames (last + 1; None: all)."""

    name: str
    path: Path
    line: int | None
    frames: tuple[int, int] | None = None
    mirror: bool = False


@dataclass(frozen=True, slots=True)
class Threshold:
    """How alike two windows must be for a transition.

    `kind` is "auto", "number" (`value` is the largest point-cloud distance, squared length units) or "quantile"
    (`value` is the share of all window pairs that lie below it).
    """

    kind: str
    value: float = 0.0


@dataclass(frozen=True, slots=True)
class GraphConfiguration:
    """One motion graph: its joints (None: the whole skeleton), its motions in order with their tags, its settings."""

    name: str
    line: int | None
    joints: tuple[str, ...] | None
    without: tuple[str, ...]
    window: int
    threshold: Threshold
    metric: str
    blend: str
    weights: Mapping[str, float]
    motions: Mapping[str, tuple[str, ...]]
    forbidden: frozenset[tuple[str, str]] = frozenset()


@dataclass(frozen=True, slots=True)
class LibraryConfiguration:
    """A checked configuration; motions are in the order that decides ties.

    Attributes
    ----------
    frame_rate : None for the first clip's.
    left_out : the names of clips that are on no graph, and so are no motions of the library.
    """

    path: Path
    clips: tuple[ClipSource, ...]
    frame_rate: float | None
    up: str
    start: str | None
    graphs: tuple[GraphConfiguration, ...]
    lines: Mapping[KeyPath, int] = field(default_factory=dict, repr=False)
    left_out: tuple[str, ...] = ()


def check_start(configuration: LibraryConfiguration, root: GraphConfiguration) -> None:
    """Check that the start motion, if one is named, is on the graph that holds the whole body.

    Raises
    ------
    ConfigurationError
        If it is not.
    """
    start = configuration.start
    if start is not None and start not in root.motions:
        raise ConfigurationError(
            configuration.path,
            configuration.lines.get(("library", "start")),
            f"start `{start}` is not a motion of `{root.name}`{did_you_mean(start, list(root.motions))}",
        )
