"""Writing BVH files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TextIO

import numpy as np

from mlmg_runtime.bvh.checking import check
from mlmg_runtime.bvh.decimals import text_from_rows
from mlmg_runtime.bvh.document import Bvh, Joint
from mlmg_runtime.bvh.precision import decimals_needed
from mlmg_runtime.files import atomic_output

POSITION_TOLERANCE = 1e-4
"""How far rounding may move a joint at most, in file units."""


def write(bvh: Bvh, path: str | Path) -> None:
    """Write `bvh` to the file `path`, all or nothing: where it fails, a file of that name stays as it was.

    Reading the file gives the same hierarchy, and values so near that no joint moves by more than
    `POSITION_TOLERANCE`. The same document always gives the same bytes.

    Raises
    ------
    ShapeError
        If no file can hold the document; see `mlmg_runtime.bvh.checking.check`.
    OSError
        If the file cannot be written.
    """
    check(bvh)
    with atomic_output(path) as beside, open(beside, "wb") as file:
        file.writelines(_text(bvh))


def write_to(bvh: Bvh, stream: TextIO) -> None:
    """Write `bvh` to an open text stream, such as the standard output: the bytes that `write` writes.

    Raises
    ------
    ShapeError
        As `write`, before anything is written.
    """
    check(bvh)
    binary = getattr(stream, "buffer", None)
    if binary is None:
        stream.writelines(part.decode() for part in _text(bvh))
        return
    # Past the encoding and the line ends of the stream, which differ between systems.
    stream.flush()
    binary.writelines(_text(bvh))
    binary.flush()


def _text(bvh: Bvh) -> Iterator[bytes]:
    lines = [*_hierarchy_lines(bvh.joints), "MOTION", f"Frames: {len(bvh.frames)}"]
    lines.append(f"Frame Time: {_plain(bvh.frame_time_s)}")
    yield "".join(f"{line}\n" for line in lines).encode()
    yield from text_from_rows(bvh.frames, decimals_needed(bvh, POSITION_TOLERANCE))


def _hierarchy_lines(joints: tuple[Joint, ...]) -> Iterator[str]:
    yield "HIERARCHY"
    chain: list[int] = []
    for index, joint in enumerate(joints):
        while chain and chain[-1] != joint.parent:
            yield from _closing_lines(joints[chain.pop()], len(chain))
        yield from _opening_lines(joint, len(chain))
        chain.append(index)
    while chain:
        yield from _closing_lines(joints[chain.pop()], len(chain))


def _opening_lines(joint: Joint, depth: int) -> Iterator[str]:
    indent = "\t" * depth
    yield f"{indent}{'JOINT' if depth else 'ROOT'} {joint.name}"
    yield f"{indent}{{"
    yield f"{indent}\tOFFSET {' '.join(map(_plain, joint.offset))}"
    yield " ".join((f"{indent}\tCHANNELS", str(len(joint.channels)), *joint.channels))


def _closing_lines(joint: Joint, depth: int) -> Iterator[str]:
    indent = "\t" * depth
    if joint.end_site is not None:
        yield f"{indent}\tEnd Site"
        yield f"{indent}\t{{"
        yield f"{indent}\t\tOFFSET {' '.join(map(_plain, joint.end_site))}"
        yield f"{indent}\t}}"
    yield f"{indent}}}"


def _plain(number: float) -> str:
    """Return the shortest decimal that reads as the same number, without an exponent: some refuse it."""
    return np.format_float_positional(number, trim="0")
