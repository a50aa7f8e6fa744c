"""The file of a library: SQLite, with what it holds by part; whose file it is, and whether it is whole.

Nothing here needs numpy: a check of a script reads names alone, and is done before numpy would have started.
"""

from __future__ import annotations

import json
import sqlite3
import zlib
from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

from mlmg_runtime.errors import LibraryError

# "mlmg" in ASCII: says whose SQLite file this is.
APPLICATION_ID = 0x6D6C6D67
FORMAT_VERSION = 4
SQLITE = b"SQLite format 3\0"
"""What every SQLite file begins with."""

# SQLite puts a whole damaged column into its message.
_LONGEST_REASON = 60

# What is read when a library is opened, in the order of the rows' writing; any other would have SQLite sort the tables
# of pairs, which takes ten times as long as to read them.
PARTS = {
    "property": "SELECT name, value FROM property ORDER BY rowid",
    "clip": "SELECT name, n_frames FROM clip ORDER BY rowid",
    "graph": (
        "SELECT name, parent, joints, weights, window, sigma, blend, report, transitions, forbidden, oms, hops "
        "FROM graph ORDER BY rowid"
    ),
    "motion": "SELECT graph, clip, tags FROM motion ORDER BY rowid",
}


def checksum_of(rows: Iterable[tuple[object, ...]]) -> int:
    """Return the CRC-32 of all values of some rows."""
    checksum = 0
    for row in rows:
        for value in row:
            checksum = zlib.crc32(value if isinstance(value, bytes) else repr(value).encode(), checksum)
    return checksum


@contextmanager
def open_database(path: Path) -> Iterator[sqlite3.Connection]:
    """Open a library's file for reading, and say plainly if it is none.

    Raises
    ------
    LibraryError
        If the file is not a library, is damaged, or was built by another version.
    OSError
        If it cannot be opened.
    """
    with path.open("rb") as file:  # a missing or unreadable file is the operating system's to tell
        is_sqlite = file.read(len(SQLITE)) == SQLITE
    if path.suffix.lower() == ".toml" and not is_sqlite:
        built = path.with_suffix(".mlmg").name
        message = f"a configuration, not a library: build it first, by `mlmg build {path.name} -o {built}`"
        raise LibraryError(path, None, f"{message}, and name {built} here")
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as connection:
            _check_file(connection, path)
            yield connection
    except (sqlite3.DatabaseError, UnicodeDecodeError) as error:  # the latter: a damaged schema in a message
        reason = str(error)[:_LONGEST_REASON]
        raise LibraryError(
            path,
            None,
            f"not a readable library ({reason}); expected a file that `mlmg build` wrote: build it again",
        ) from None


def _check_file(connection: sqlite3.Connection, path: Path) -> None:
    (application,) = connection.execute("PRAGMA application_id").fetchone()
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    if application != APPLICATION_ID:
        raise LibraryError(path, None, "an SQLite file, but no library; expected a file that `mlmg build` wrote")
    if version != FORMAT_VERSION:
        raise LibraryError(
            path,
            None,
            f"library format {version}, expected {FORMAT_VERSION}: build it again with this version",
        )
    (n_pages,) = connection.execute("PRAGMA page_count").fetchone()
    (page_size,) = connection.execute("PRAGMA page_size").fetchone()
    if path.stat().st_size != n_pages * page_size:
        raise sqlite3.DatabaseError("the file is cut short")


def read_part(connection: sqlite3.Connection, part: str) -> list[tuple[Any, ...]]:
    """Return the rows of one of `PARTS`; damage that SQLite does not see is an error of its kind."""
    rows = connection.execute(PARTS[part]).fetchall()
    (checksum,) = connection.execute("SELECT value FROM checksum WHERE part = ?", (part,)).fetchone() or (None,)
    check_rows(part, rows, checksum)
    return rows


def check_rows(what: str, rows: Iterable[tuple[object, ...]], checksum: int | None) -> None:
    """Hold rows to the checksum that was written with them.

    Raises
    ------
    sqlite3.DatabaseError
        That says what is damaged; `open_database` makes a `LibraryError` of it.
    """
    if checksum_of(rows) != checksum:
        raise sqlite3.DatabaseError(f"the checksum of {what} differs")


def read_properties(connection: sqlite3.Connection) -> dict[str, Any]:
    """Return the library's properties by name: frame_rate, up, start, skeleton, warnings, usual_oms, configuration.

    The last is the way from the library to the file that it was built from, or None; the one before it, for each graph,
    the median overall motion similarity of two different motions.
    """
    return {name: json.loads(value) for name, value in read_part(connection, "property")}
