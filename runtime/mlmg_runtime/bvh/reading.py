"""Reading BVH files."""

from __future__ import annotations

from pathlib import Path

from mlmg_runtime.arrays import frozen
from mlmg_runtime.bvh.document import Bvh
from mlmg_runtime.bvh.hierarchy import joints_from_lines
from mlmg_runtime.bvh.lines import Lines, shown
from mlmg_runtime.bvh.motion import motion_from_lines
from mlmg_runtime.errors import BvhError

_HEAD_BYTES = 4096
_BYTE_ORDER_MARK = b"\xef\xbb\xbf"
_BINARY = "binary data (or UTF-16)"


def read(path: str | Path) -> Bvh:
    """Return the content of the BVH file `path`.

    Raises
    ------
    BvhError
        If the file is no BVH file, with the line, what was expected there and what was found.
    OSError
        If the file cannot be opened.
    """
    if Path(path).is_dir():
        raise BvhError(path, None, "expected a BVH file, found a folder")
    with open(path, "rb") as file:
        head = file.read(_HEAD_BYTES)
        _check_start(head, str(path))
        if not file.seekable():
            return read_bytes(head + file.read(), str(path))
        # Once more from the start: putting the two together costs a tenth of the whole.
        file.seek(0)
        return read_bytes(file.read(), str(path))


def read_bytes(data: bytes, name: str) -> Bvh:
    """Return the BVH document that `data`, the bytes of a file, spells; `name` stands for the file in errors.

    Raises
    ------
    BvhError
        As `read`.
    """
    _check_start(data[:_HEAD_BYTES], name)
    if b"\0" in data:
        line = 1 + data.count(b"\n", 0, data.index(b"\0"))
        raise BvhError(name, line, f"expected text, found {_BINARY}")
    data = data.removeprefix(_BYTE_ORDER_MARK)
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    lines = Lines(data, name)
    joints = joints_from_lines(lines)
    frame_time_s, frames = motion_from_lines(lines, sum(len(joint.channels) for joint in joints))
    return Bvh(joints, frame_time_s, frozen(frames), tuple(lines.warnings))


def _check_start(head: bytes, name: str) -> None:
    """Raise for a file that does not start as a BVH file does, before the rest of it is read."""
    text = head.removeprefix(_BYTE_ORDER_MARK).lstrip()
    if text[:9].upper() == b"HIERARCHY":
        return
    line = 1 + head.count(b"\n", 0, len(head) - len(text))
    first = shown(text.splitlines()[0].decode("latin-1")) if text else "an empty file"
    found = _BINARY if b"\0" in head else first
    raise BvhError(name, line, f"expected HIERARCHY, found {found}")
