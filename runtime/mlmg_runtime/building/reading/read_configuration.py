"""A library's TOML file, read and checked, each mistake told with its line."""

from __future__ import annotations

from pathlib import Path

from mlmg_runtime.building.configuration import LibraryConfiguration
from mlmg_runtime.building.reading.clips import read_clips
from mlmg_runtime.building.reading.forbidden import with_forbidden
from mlmg_runtime.building.reading.graphs import read_graphs
from mlmg_runtime.building.reading.table import Table, composed, is_number
from mlmg_runtime.building.toml_files import read_toml


def read_configuration(path: Path) -> LibraryConfiguration:
    """Read a library's TOML file.

    Raises
    ------
    ConfigurationError
        With the line, if the file is not TOML, a key is unknown or a value is not what it must be.
    OSError
        If the file cannot be opened.
    """
    file = read_toml(path)
    document = Table(file, (), file.document)
    document.expect_keys("library", "clips", "graph", "tags", "groups", "transitions")
    library = document.table("library")
    library.expect_keys("clips", "frame_rate", "up", "start")
    clips = read_clips(document)
    names = [clip.name for clip in clips]
    graphs = with_forbidden(document, read_graphs(document, names))
    start = library.text("start")
    motions = {motion for graph in graphs for motion in graph.motions}
    return LibraryConfiguration(
        path=path,
        clips=tuple(clip for clip in clips if clip.name in motions),
        left_out=tuple(name for name in names if name not in motions),
        frame_rate=_frame_rate(library),
        up=library.choice("up", ("y", "z"), "y"),
        start=None if start is None else composed(start),
        graphs=graphs,
        lines=file.lines,
    )


def _frame_rate(library: Table) -> float | None:
    value = library.get("frame_rate", None)
    if value is not None and not (is_number(value) and 1 <= value <= 10000):
        library.fail(f"frame_rate must be a number from 1 to 10000, found {value!r}", "frame_rate")
    return None if value is None else float(value)
