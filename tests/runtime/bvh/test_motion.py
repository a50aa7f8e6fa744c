from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime.bvh import Bvh, motion, read_bytes
from mlmg_runtime.bvh.lines import Lines
from mlmg_runtime.errors import BvhError

Changed = Callable[[str, str], Bvh]
FIRST, SECOND = range(1, 10), range(11, 20)


def test_frames_and_frame_time_are_as_the_file_says_them(text: str) -> None:
    bvh = read_bytes(text.encode(), "clip.bvh")
    assert bvh.frame_time_s == 0.0333333
    np.testing.assert_array_equal(bvh.frames, [FIRST, SECOND])
    assert not bvh.frames.flags.writeable


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("Frames: 2", "frames:2"),
        ("Frames: 2", "Frames :\t2  "),
        ("Frames: 2", "Frames 2"),
        ("Frame Time: 0", "Frame\tTime:0"),
        ("Frame Time: 0.0333333", "FRAME TIME 333.333e-4"),
        ("1 2 3 4", "1e0 +2. 0.3E+1 0400e-2"),
        ("1 2 3 4", "  1\t2 \t 3\v4"),
        ("9\n11", "9 \t \n\n  \n11"),
        ("18 19\n", "18 19"),
        ("18 19\n", "18 19\n\n \n"),
    ],
)
def test_odd_ways_to_write_the_same_motion_are_read(old: str, new: str, changed: Changed) -> None:
    bvh = changed(old, new)
    assert bvh.frame_time_s == 0.0333333
    np.testing.assert_array_equal(bvh.frames, [FIRST, SECOND])
    assert bvh.warnings == ()


def test_one_frame_is_a_motion(changed: Changed) -> None:
    bvh = changed("Frames: 2", "Frames: 1")
    np.testing.assert_array_equal(bvh.frames, [FIRST])
    assert bvh.warnings == ("line 17 announces 1 frames, 2 are there: the rest is left out",)


def test_values_are_the_nearest_doubles(changed: Changed) -> None:
    words = ["0.1", "-123.456789012345678", "5e-324", "1.7976931348623157e308", "179.99999999999997"]
    np.testing.assert_array_equal(changed("1 2 3 4 5 6", " ".join([*words, "6"])).frames[0, :5], [*map(float, words)])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("MOTION\n", "", "16: expected MOTION after the one skeleton of the file, found `Frames: 2`"),
        ("Frames: 2\n", "", "17: expected Frames: and a number, found `Frame Time: 0.0333333`"),
        ("Frames: 2", "Frames: 3", "17: expected 3 frames, as announced, found 2"),
        ("Frames: 2", f"Frames: {10**12}", f"17: expected {10**12} frames, as announced, found 2"),
        ("Frames: 2", "Frames: 1e3", "17: expected a number of frames, 1 or more, found `1e3`"),
        ("Frames: 2", "Frames: -2", "17: expected a number of frames, 1 or more, found `-2`"),
        ("Frames: 2", "Frames: 0", "17: expected a number of frames, 1 or more, found `0`"),
        ("Frames: 2", "Frames:", "17: expected a number of frames, 1 or more, found nothing"),
        (
            "Frames: 2",
            "Frames: 1" + "0" * 9999,
            "17: expected a number of frames, 1 or more, found `" + "1" + "0" * 38 + "…`",
        ),
        ("Frame Time", "FrameTime", "18: expected Frame Time: and a number, found `FrameTime: 0.0333333`"),
        ("0.0333333", "0.0", "18: expected a frame time above 0, in seconds, found `0.0`"),
        ("0.0333333", "-0.03", "18: expected a frame time above 0, in seconds, found `-0.03`"),
        ("0.0333333", "nan", "18: expected a frame time above 0, in seconds, found `nan`"),
        ("0.0333333", "inf", "18: expected a frame time above 0, in seconds, found `inf`"),
        ("0.0333333", "1 / 30", "18: expected a frame time above 0, in seconds, found `1 / 30`"),
        ("5 6 7 8 9\n", "5 6 7 8\n", "19: expected 9 values, one for each channel, found 8"),
        ("5 6 7 8 9\n", "5 6 7 8 9 10\n", "19: expected 9 values, one for each channel, found 10"),
        ("5 6 7 8 9\n", "5\n6 7 8 9\n", "19: expected 9 values, one for each channel, found 5"),
        ("5 6 7 8 9\n", "5 6 7 8 9 ", "19: expected 9 values, one for each channel, found 18"),
        ("8 9\n", "8 9\n\n\n1\n", "22: expected 9 values, one for each channel, found 1"),
        ("18 19\n", "18", "20: expected 9 values, one for each channel, found 8"),
        ("18 19\n", "18 19 # end\n", "20: expected a finite number, found `#`"),
        ("18 19\n", "18 -", "20: expected a finite number, found `-`"),
        ("18 19\n", "18 19\nThe end", "21: expected a finite number, found `The`"),
        ("15 16", "15 nan", "20: expected a finite number, found `nan`"),
        ("15 16", "15 -inf", "20: expected a finite number, found `-inf`"),
        ("15 16", "15 1e999", "20: expected a finite number, found `1e999`"),
        ("15 16", "15 1.6.1", "20: expected a finite number, found `1.6.1`"),
        ("15 16", "15 1_6", "20: expected a finite number, found `1_6`"),
        ("15 16", "15 0x10", "20: expected a finite number, found `0x10`"),
        ("15 16", "15 １６", "20: expected a finite number, found `１６`"),
        ("15 16", "15, 16", "20: expected a finite number, found `15,`"),
        ("15 16", "15 # 16", "20: expected a finite number, found `#`"),
        ("15 16", '15 "16"', '20: expected a finite number, found `"16"`'),
    ],
)
def test_of_a_wrong_motion_the_error_says_where_and_what(old: str, new: str, message: str, changed: Changed) -> None:
    with pytest.raises(BvhError) as caught:
        changed(old, new)
    assert str(caught.value) == f"clip.bvh:{message}"


def test_a_file_that_ends_before_its_frames_says_so(text: str) -> None:
    with pytest.raises(BvhError, match="17: expected 2 frames, as announced, found 0"):
        read_bytes(text[: text.index("1 2 3")].encode(), "clip.bvh")
    with pytest.raises(BvhError, match="17: expected Frame Time: and a number, found the end of the file"):
        read_bytes(text[: text.index("Frame Time")].encode(), "clip.bvh")


def test_a_skeleton_without_channels_has_no_motion() -> None:
    text = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n}\nMOTION\nFrames: 1\nFrame Time: 1\n"
    with pytest.raises(BvhError, match="7: expected a skeleton with at least one channel, found none"):
        read_bytes(text.encode(), "clip.bvh")


def outcome(frames: Callable[[Lines, int], object], data: bytes) -> list[object]:
    try:
        return np.asarray(frames(Lines(data, "clip.bvh"), 3)).tolist()
    except BvhError as error:
        return [str(error)]


WORDS = st.one_of(
    st.sampled_from(
        ["1", "-0", "+2.5", ".5", "1e-3", "1E400", "nan", "-inf", "0x1", "1_0", "1.2.3", "e", "+", "é", '"1"']
    ),
    st.text(alphabet="019.-+eE", min_size=1, max_size=6),
)
BLANKS = st.sampled_from([" ", "  ", "\t", "\v", "\f", "\x1c", "\u00a0", "#", ",", " \n"])


@given(
    st.lists(st.tuples(WORDS, BLANKS, WORDS, BLANKS, WORDS), max_size=3),
    st.sampled_from(["", "\n", "\n \n\t"]),
)
def test_the_fast_way_and_the_way_line_by_line_agree_on_whatever_text(rows: list[tuple[str, ...]], end: str) -> None:
    data = ("1 2 3\n" + "\n".join("".join(row) for row in rows) + end).encode()
    assert outcome(motion._frames, data) == outcome(motion._frames_one_by_one, data)
