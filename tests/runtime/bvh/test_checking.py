from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from mlmg_runtime.bvh import Bvh, Joint
from mlmg_runtime.bvh.checking import check
from mlmg_runtime.errors import ShapeError

ROOT = Joint("a", -1, (0.0, 0.0, 0.0), ("Xposition", "Zrotation"))
CHILD = Joint("b", 0, (0.0, 1.0, 0.0), ("Xrotation",), (0.0, 1.0, 0.0))
GOOD = Bvh((ROOT, CHILD), 0.02, np.zeros((4, 3)))


def with_value(value: float) -> np.ndarray:
    frames = np.zeros((4, 3))
    frames[2, 1] = value
    return frames


def test_a_good_document_passes() -> None:
    check(GOOD)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"joints": ()}, "expected frames of shape (1 or more, 1 or more), found (4, 3)"),
        ({"joints": (CHILD, ROOT)}, "expected one tree of joints, depth first, found parent 0 of joint 0"),
        ({"joints": (ROOT, replace(CHILD, parent=-1))}, "depth first, found parent -1 of joint 1"),
        ({"joints": (ROOT, replace(CHILD, parent=1))}, "depth first, found parent 1 of joint 1"),
        (
            {"joints": (ROOT, CHILD, replace(ROOT, name="c", parent=0), replace(ROOT, name="d", parent=1))},
            "depth first, found parent 1 of joint 3",
        ),
        ({"joints": (ROOT, replace(CHILD, name="a"))}, "expected different joint names, found 'a' twice"),
        (
            {"joints": (ROOT, replace(CHILD, name=""))},
            "expected a joint name that fits on a line, without braces",
        ),
        ({"joints": (ROOT, replace(CHILD, name=" b"))}, "without braces, found ' b'"),
        ({"joints": (ROOT, replace(CHILD, name="b{"))}, "without braces, found 'b{'"),
        ({"joints": (ROOT, replace(CHILD, name="b\n"))}, r"without braces, found 'b\n'"),
        ({"joints": (ROOT, replace(CHILD, name="\ud800"))}, r"without braces, found '\ud800'"),
        ({"joints": (ROOT, replace(CHILD, channels=("Xscale",)))}, "found ('Xscale',) in joint 'b'"),
        (
            {"joints": (replace(ROOT, channels=("Xposition",) * 2), CHILD)},
            "expected different channels of BVH files",
        ),
        (
            {"joints": (ROOT, replace(CHILD, offset=(0.0, np.nan, 0.0)))},
            "expected finite offsets, found (0.0, nan, 0.0)",
        ),
        ({"joints": (ROOT, replace(CHILD, end_site=(np.inf, 0.0, 0.0)))}, "(inf, 0.0, 0.0) in joint 'b'"),
        ({"frame_time_s": 0.0}, "expected a frame time above 0, found 0.0"),
        ({"frame_time_s": np.nan}, "expected a frame time above 0, found nan"),
        ({"frames": np.zeros((0, 3))}, "expected frames of shape (1 or more, 3), found (0, 3)"),
        ({"frames": np.zeros((4, 2))}, "expected frames of shape (1 or more, 3), found (4, 2)"),
        ({"frames": np.zeros(3)}, "expected frames of shape (1 or more, 3), found (3,)"),
        (
            {"frames": with_value(np.nan)},
            "expected finite values, found nan in frame 2, Zrotation of joint 'a'",
        ),
        (
            {"frames": with_value(-np.inf)},
            "expected finite values, found -inf in frame 2, Zrotation of joint 'a'",
        ),
    ],
)
def test_what_no_file_can_hold_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ShapeError) as caught:
        check(replace(GOOD, **changes))
    assert message in str(caught.value)
