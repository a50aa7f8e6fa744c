import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime import bvh
from mlmg_runtime.bvh import Bvh, Joint, read_bytes
from mlmg_runtime.clips import poses_from_bvh, skeleton_from_bvh
from mlmg_runtime.errors import ShapeError
from mlmg_runtime.skeleton import world_positions

CHANNELS = ("Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation")
BLANKS = " \t\v\f"
NAMES = st.text(max_size=8).filter(lambda name: name and name == name.strip(BLANKS) and not set(name) & set("{}\r\n\0"))


def written(document: Bvh) -> bytes:
    stream = io.StringIO()
    bvh.write_to(document, stream)
    return stream.getvalue().encode()


def largest_move(a: Bvh, b: Bvh) -> float:
    before, after = (world_positions(skeleton_from_bvh(one), poses_from_bvh(one)) for one in (a, b))
    return float(np.abs(after - before).max())


@st.composite
def documents(draw: st.DrawFn, largest: float = 1e4) -> Bvh:
    numbers = st.floats(-largest, largest)
    offsets = st.tuples(numbers, numbers, numbers)
    names = draw(st.lists(NAMES, min_size=1, max_size=8, unique=True))
    joints: list[Joint] = []
    chain: list[int] = []
    for index, name in enumerate(names):
        del chain[draw(st.integers(1, max(1, len(chain)))) :]
        channels = draw(st.permutations(CHANNELS))[: draw(st.integers(0 if index else 1, 6))]
        end_site = draw(st.none() | offsets)
        joints.append(Joint(name, chain[-1] if chain else -1, draw(offsets), tuple(channels), end_site))
        chain.append(index)
    n_channels = sum(len(joint.channels) for joint in joints)
    frames = draw(st.lists(st.lists(numbers, min_size=n_channels, max_size=n_channels), min_size=1, max_size=3))
    return Bvh(tuple(joints), draw(st.floats(1e-6, 1e3)), np.array(frames))


@given(documents())
def test_what_was_written_is_read_with_every_joint_in_its_place(document: Bvh) -> None:
    again = read_bytes(written(document), "clip.bvh")
    assert again.joints == document.joints
    assert again.frame_time_s == document.frame_time_s
    assert again.warnings == ()
    np.testing.assert_allclose(again.frames, document.frames, atol=0.51e-6)
    assert largest_move(document, again) < 1e-4


@given(documents(largest=200.0))
def test_what_was_read_is_written_with_the_same_bytes(document: Bvh) -> None:
    data = written(document)
    assert written(read_bytes(data, "clip.bvh")) == data


def test_even_far_down_a_long_chain_no_joint_moves_by_more_than_the_tolerance() -> None:
    root = Joint("j0", -1, (0.0, 0.0, 0.0), CHANNELS)
    joints = (root, *(Joint(f"j{at}", at - 1, (0.0, 400.0, 0.0), CHANNELS[3:]) for at in range(1, 60)))
    frames = np.random.default_rng(0).uniform(-1.0, 1.0, size=(20, 3 * 60 + 3))
    document = Bvh(joints, 1.0 / 30.0, frames)
    assert largest_move(document, read_bytes(written(document), "clip.bvh")) < 1e-4


def test_a_file_is_laid_out_as_usual(text: str) -> None:
    document = read_bytes(text.encode(), "clip.bvh")
    head, motion = text.replace(" 0 0 0", " 0.0 0.0 0.0").replace(" 0 5 0", " 0.0 5.0 0.0").split("1 2", 1)
    expected = head.replace(" 0 1 0", " 0.0 1.0 0.0") + f"1 2{motion}".replace(" ", ".000000 ").replace(
        "\n", ".000000\n"
    )
    assert written(document).decode() == expected


def test_offsets_and_the_frame_time_are_written_to_the_last_digit_without_exponents(text: str) -> None:
    document = read_bytes(text.encode(), "clip.bvh")
    offset = (1e-7, -1.0 / 3.0, 1e20)
    odd = replace(document, joints=(replace(document.joints[0], offset=offset), document.joints[1]), frame_time_s=1e-5)
    data = written(odd)
    assert b"OFFSET 0.0000001 -0.3333333333333333 100000000000000000000.0\n" in data
    assert b"Frame Time: 0.00001\n" in data
    assert read_bytes(data, "clip.bvh").joints == odd.joints


def test_a_file_and_a_stream_get_the_same_bytes_whatever_the_encoding_of_the_stream(text: str, tmp_path: Path) -> None:
    document = read_bytes(text.replace("Spine", "走").encode(), "clip.bvh")
    path = tmp_path / "clip.bvh"
    bvh.write(document, path)
    binary = io.BytesIO()
    stream = io.TextIOWrapper(binary, encoding="ascii", newline="\r\n")
    stream.write("before\n")
    bvh.write_to(document, stream)
    assert binary.getvalue() == b"before\r\n" + path.read_bytes()
    assert path.read_bytes() == written(document)


def test_what_cannot_be_written_leaves_the_file_and_the_folder_as_they_were(text: str, tmp_path: Path) -> None:
    path = tmp_path / "clip.bvh"
    path.write_text("precious")
    document = read_bytes(text.encode(), "clip.bvh")
    stream = io.StringIO()
    for frames in (np.full((2, 9), np.nan), np.zeros((2, 8))):
        with pytest.raises(ShapeError):
            bvh.write(replace(document, frames=frames), path)
        with pytest.raises(ShapeError):
            bvh.write_to(replace(document, frames=frames), stream)
    assert stream.getvalue() == ""
    assert path.read_text() == "precious"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.mocap
def test_real_clips_are_written_and_read_with_every_joint_in_its_place(mocap: Path) -> None:
    for folder in ("reference", "reference-6channel", "cmu-29"):
        path = sorted((mocap / folder).glob("*.bvh"))[0]
        document = bvh.read(path)
        again = read_bytes(written(document), path.name)
        assert again.joints == document.joints
        assert largest_move(document, again) < 1e-4
