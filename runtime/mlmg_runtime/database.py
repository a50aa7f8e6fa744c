"""A library as one SQLite file: clips and transitions as packed blobs, everything else as small tables."""

from __future__ import annotations

import errno
import json
import os
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from mlmg_runtime.arrays import frozen
from mlmg_runtime.built_library import BuiltLibrary
from mlmg_runtime.bvh.document import Joint
from mlmg_runtime.files import atomic_output
from mlmg_runtime.library_file import APPLICATION_ID, FORMAT_VERSION, PARTS, check_rows, checksum_of, read_part
from mlmg_runtime.motion_graph import TRANSITION, MotionGraph
from mlmg_runtime.skeleton import Poses, Skeleton

_SCHEMA = """
CREATE TABLE property (name TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE clip (
    name TEXT PRIMARY KEY, n_frames INTEGER NOT NULL, source TEXT NOT NULL,
    rotations BLOB NOT NULL,   -- float32, (n_frames, n_joints, 4), w x y z
    positions BLOB NOT NULL,   -- float64, (n_frames, n_positioned, 3)
    checksum INTEGER NOT NULL  -- of n_frames and the two
);
CREATE TABLE graph (
    name TEXT PRIMARY KEY, ordinal INTEGER NOT NULL, parent TEXT REFERENCES graph (name),
    joints TEXT NOT NULL, weights TEXT NOT NULL, window INTEGER NOT NULL, sigma REAL NOT NULL, blend TEXT NOT NULL,
    report TEXT NOT NULL,
    transitions BLOB NOT NULL, -- packed, see motion_graph.TRANSITION
    forbidden BLOB NOT NULL,   -- a byte for each pair of motions, row by row: 1 where the configuration forbids it
    oms BLOB NOT NULL,         -- float64, (n_motions, n_motions)
    hops BLOB NOT NULL         -- int64, (n_motions, n_motions)
);
CREATE TABLE motion (
    graph TEXT NOT NULL REFERENCES graph (name), ordinal INTEGER NOT NULL,
    clip TEXT NOT NULL REFERENCES clip (name), tags TEXT NOT NULL,
    PRIMARY KEY (graph, ordinal)
);
CREATE TABLE checksum (part TEXT PRIMARY KEY, value INTEGER NOT NULL); -- of what opening reads, see `PARTS`
"""


def write_database(built: BuiltLibrary, path: Path) -> None:
    """Write a built library; the file appears whole or not at all.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    with atomic_output(path) as temporary:
        Path(temporary).unlink(missing_ok=True)
        with _system_errors(path), closing(sqlite3.connect(temporary)) as connection, connection:
            connection.executescript(_SCHEMA)
            connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")
            connection.execute(f"PRAGMA user_version = {FORMAT_VERSION}")
            _write_properties(connection, built, path)
            _write_clips(connection, built)
            _write_graphs(connection, built)
            checksums = [(part, checksum_of(connection.execute(query))) for part, query in PARTS.items()]
            connection.executemany("INSERT INTO checksum VALUES (?, ?)", checksums)


@contextmanager
def _system_errors(path: Path) -> Iterator[None]:
    """Raise what SQLite says of a disk as the system would: SQLite's own error tells no cause and names no file."""
    try:
        yield
    except sqlite3.OperationalError as error:
        is_full = error.sqlite_errorcode == sqlite3.SQLITE_FULL
        cause = (errno.ENOSPC, os.strerror(errno.ENOSPC)) if is_full else (errno.EIO, str(error))
        raise OSError(*cause, str(path)) from error


def _write_properties(connection: sqlite3.Connection, built: BuiltLibrary, path: Path) -> None:
    properties = {
        "frame_rate": built.frame_rate,
        "up": built.up,
        "start": built.start,
        "skeleton": [asdict(joint) for joint in built.skeleton.joints],
        "warnings": built.warnings,
        "usual_oms": {graph.name: graph.usual_oms for graph in built.graphs},
        "configuration": None if built.configuration is None else _from(path, built.configuration),
    }
    rows = [(name, json.dumps(value, ensure_ascii=False)) for name, value in properties.items()]
    connection.executemany("INSERT INTO property VALUES (?, ?)", rows)


def _from(path: Path, configuration: Path) -> str | None:
    """Return the way from a library to its configuration, if it leads only down, or only up.

    Else it would name folders that have nothing to do with the library, and a library would be another one wherever it
    is written.
    """
    folder = os.path.abspath(path.parent)
    try:
        way = Path(os.path.relpath(os.path.abspath(configuration), folder))
    except ValueError:  # on another drive
        return None
    ups = [part == os.pardir for part in way.parts[:-1]]
    return way.as_posix() if all(ups) or not any(ups) else None


def _write_clips(connection: sqlite3.Connection, built: BuiltLibrary) -> None:
    for name, poses in built.poses.items():
        rotations, positions = poses.rotations.astype("<f4").tobytes(), poses.positions.astype("<f8").tobytes()
        checksum = checksum_of([(poses.n_frames, rotations, positions)])
        row = (name, poses.n_frames, built.sources[name], rotations, positions, checksum)
        connection.execute("INSERT INTO clip VALUES (?, ?, ?, ?, ?, ?)", row)


def _write_graphs(connection: sqlite3.Connection, built: BuiltLibrary) -> None:
    for ordinal, (graph, report) in enumerate(zip(built.graphs, built.reports, strict=True)):
        connection.execute(
            "INSERT INTO graph VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
            (
                graph.name,
                ordinal,
                graph.parent,
                json.dumps(graph.joints),
                json.dumps(graph.weights.tolist()),
                graph.window,
                graph.sigma,
                graph.blend,
                json.dumps(asdict(report), ensure_ascii=False),
                graph.transitions.tobytes(),
                graph.forbidden.tobytes(),
                graph.oms.astype("<f8").tobytes(),
                graph.hops.astype("<i8").tobytes(),
            ),
        )
        connection.executemany(
            "INSERT INTO motion VALUES (?, ?, ?, ?)",
            (
                (graph.name, at, motion, json.dumps(graph.tags[motion], ensure_ascii=False))
                for at, motion in enumerate(graph.motions)
            ),
        )


def skeleton_from_json(joints: list[dict[str, Any]]) -> Skeleton:
    """Return the skeleton that `read_properties` tells of."""
    return Skeleton(
        tuple(
            Joint(
                name=joint["name"],
                parent=joint["parent"],
                offset=tuple(joint["offset"]),
                channels=tuple(joint["channels"]),
                end_site=None if joint["end_site"] is None else tuple(joint["end_site"]),
            )
            for joint in joints
        )
    )


def read_graphs(connection: sqlite3.Connection) -> list[tuple[MotionGraph, dict[str, Any]]]:
    """Return the graphs, parents before children, each with the report of its building."""
    frames = dict(read_part(connection, "clip"))
    motions = read_part(connection, "motion")
    graphs = []
    for row in read_part(connection, "graph"):
        name, parent, joints, weights, window, sigma, blend, report, transitions, forbidden, oms, hops = row
        tags = {clip: tuple(json.loads(words)) for graph_of, clip, words in motions if graph_of == name}
        shape = (len(tags), len(tags))
        graph = MotionGraph(
            name=name,
            parent=parent,
            joints=tuple(json.loads(joints)),
            weights=np.array(json.loads(weights)),
            window=window,
            sigma=sigma,
            blend=blend,
            motions=tuple(tags),
            tags=tags,
            n_frames=np.array([frames[motion] for motion in tags], dtype=np.int64),
            transitions=np.frombuffer(transitions, dtype=TRANSITION),
            forbidden=np.frombuffer(forbidden, dtype=bool).reshape(shape),
            oms=np.frombuffer(oms, dtype="<f8").reshape(shape),
            hops=np.frombuffer(hops, dtype="<i8").reshape(shape),
        )
        graphs.append((graph, json.loads(report)))
    return graphs


def read_source(connection: sqlite3.Connection, name: str) -> str | None:
    """Return the file of one clip, as its path from the folder of the configuration; None if there is no such clip."""
    row = connection.execute("SELECT source FROM clip WHERE name = ?", (name,)).fetchone()
    return None if row is None else str(row[0])


def read_clip(connection: sqlite3.Connection, name: str, skeleton: Skeleton) -> Poses:
    """Return the poses of one clip; rotations are scaled to unit length after their storage as float32."""
    query = "SELECT n_frames, rotations, positions, checksum FROM clip WHERE name = ?"
    row = connection.execute(query, (name,)).fetchone()
    n_frames, rotations, positions, checksum = row or (0, b"", b"", None)
    check_rows(f"the clip {name}", [(n_frames, rotations, positions)], checksum)
    turned = np.frombuffer(rotations, dtype="<f4").astype(np.float64).reshape(n_frames, len(skeleton.joints), 4)
    turned /= np.linalg.norm(turned, axis=-1, keepdims=True)
    moved = np.frombuffer(positions, dtype="<f8").reshape(n_frames, len(skeleton.positioned), 3)
    return Poses(frozen(turned), moved)
