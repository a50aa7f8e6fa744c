from collections.abc import Callable

import pytest

from mlmg_runtime.bvh import Bvh, read_bytes

TEXT = """\
HIERARCHY
ROOT Hips
{
\tOFFSET 0 0 0
\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
\tJOINT Spine
\t{
\t\tOFFSET 0 5 0
\t\tCHANNELS 3 Zrotation Xrotation Yrotation
\t\tEnd Site
\t\t{
\t\t\tOFFSET 0 1 0
\t\t}
\t}
}
MOTION
Frames: 2
Frame Time: 0.0333333
1 2 3 4 5 6 7 8 9
11 12 13 14 15 16 17 18 19
"""


@pytest.fixture(scope="session")
def text() -> str:
    """Return a whole file of two joints and two frames."""
    return TEXT


@pytest.fixture(scope="session")
def changed() -> Callable[[str, str], Bvh]:
    """Return a function that reads the whole file with its only `old` replaced by `new`."""

    def read_changed(old: str, new: str) -> Bvh:
        assert TEXT.count(old) == 1
        return read_bytes(TEXT.replace(old, new).encode(), "clip.bvh")

    return read_changed
