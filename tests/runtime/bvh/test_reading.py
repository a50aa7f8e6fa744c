import os
import re
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime import bvh
from mlmg_runtime.bvh import Bvh, read_bytes
from mlmg_runtime.errors import BvhError

from_text = {
    "as usual": str.encode,
    "a carriage return and a newline at the end of lines": lambda text: text.replace("\n", "\r\n").encode(),
    "a carriage return alone": lambda text: text.replace("\n", "\r").encode(),
    "a byte order mark": lambda text: text.encode("utf-8-sig"),
    "no newline at the end": lambda text: text.rstrip().encode(),
    "blank lines around": lambda text: f"\n \n{text}\n\n \t\n".encode(),
    "tabs": lambda text: text.replace(" ", "\t").encode(),
    "blanks at the end of lines": lambda text: text.replace("\n", " \t\n").encode(),
}


@pytest.mark.parametrize("encode", from_text.values(), ids=from_text)
def test_however_the_text_is_laid_out_the_content_is_the_same(
    encode: Callable[[str], bytes], text: str, tmp_path: Path
) -> None:
    path = tmp_path / "clip.bvh"
    path.write_bytes(encode(text))
    plain, odd = read_bytes(text.encode(), "clip.bvh"), bvh.read(path)
    assert (odd.joints, odd.frame_time_s, odd.warnings) == (plain.joints, plain.frame_time_s, ())
    np.testing.assert_array_equal(odd.frames, plain.frames)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "1: expected HIERARCHY, found an empty file"),
        (b"\xef\xbb\xbf", "1: expected HIERARCHY, found an empty file"),
        (b"\n\n<html>\n", "3: expected HIERARCHY, found `<html>`"),
        (b"HIERARCH", "1: expected HIERARCHY, found `HIERARCH`"),
        (b"HIERARCHY", "1: expected ROOT and a name, found the end of the file"),
        (b"\xff\xd8\xff\xe1Exif", "1: expected HIERARCHY, found `ÿØÿáExif`"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\r", "1: expected HIERARCHY, found binary data (or UTF-16)"),
        ("HIERARCHY\nROOT".encode("utf-16"), "1: expected HIERARCHY, found binary data (or UTF-16)"),
        (b"HIERARCHY\nROOT \0", "2: expected text, found binary data (or UTF-16)"),
    ],
)
def test_what_is_no_bvh_file_is_said_to_be_none(data: bytes, message: str, tmp_path: Path) -> None:
    path = tmp_path / "clip.bvh"
    path.write_bytes(data)
    with pytest.raises(BvhError) as caught:
        bvh.read(path)
    assert str(caught.value) == f"{path}:{message}"


def test_an_error_counts_the_lines_of_files_with_carriage_returns_alone(text: str) -> None:
    with pytest.raises(BvhError, match=r"clip\.bvh:19: "):
        read_bytes(text.replace("1 2 3", "1 2 x").replace("\n", "\r").encode(), "clip.bvh")


def test_a_folder_is_no_bvh_file(tmp_path: Path) -> None:
    with pytest.raises(BvhError, match="expected a BVH file, found a folder"):
        bvh.read(tmp_path)


def test_a_file_that_is_not_there_is_the_systems_own_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        bvh.read(tmp_path / "clip.bvh")


def test_a_pipe_can_be_read(text: str, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    writer = threading.Thread(target=pipe.write_text, args=(text,), daemon=True)
    writer.start()
    assert bvh.read(pipe).frames.shape == (2, 9)
    writer.join()


def test_an_endless_file_that_is_no_bvh_is_not_read_to_its_end() -> None:
    with pytest.raises(BvhError, match="found binary data"):
        bvh.read("/dev/zero")


def content_or_error(data: bytes) -> Bvh | BvhError:
    try:
        return read_bytes(data, "clip.bvh")
    except BvhError as error:
        return error


@given(data=st.data())
def test_a_damaged_file_is_read_or_refused_and_nothing_else(data: st.DataObject, text: str) -> None:
    whole = text.encode()
    start = data.draw(st.integers(0, len(whole)))
    end = data.draw(st.integers(start, min(len(whole), start + 30)))
    patch = data.draw(st.one_of(st.binary(max_size=4), st.sampled_from([b"{", b"}", b"\n", b" ", b"9", b"ROOT x"])))
    result = content_or_error(whole[:start] + patch + whole[end:])
    if isinstance(result, BvhError):
        assert result.path == "clip.bvh"
        assert result.line is not None
        assert re.fullmatch("expected .+, found .+", result.message)
    else:
        assert result.frames.shape == (len(result.frames), result.n_channels)
        assert np.isfinite(result.frames).all()


@pytest.mark.mocap
def test_every_real_clip_is_read(mocap: Path) -> None:
    clips: dict[Path, Bvh] = {path: bvh.read(path) for path in sorted(mocap.rglob("*.bvh"))}
    assert len(clips) > 100
    for path, clip in clips.items():
        assert len(clip.frames) > 1, path
        assert clip.frame_time_s == pytest.approx(1.0 / 30.0, rel=1e-3), path
