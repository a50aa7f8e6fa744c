from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mlmg_runtime import rotations
from mlmg_runtime.building.load_clips import Clips, load_clips
from mlmg_runtime.building.mirror import mirrored
from mlmg_runtime.building.reading.read_configuration import read_configuration
from mlmg_runtime.bvh import Bvh, Joint, write
from mlmg_runtime.clips import poses_from_bvh, resample
from mlmg_runtime.errors import ConfigurationError, LibraryError
from mlmg_runtime.skeleton import Poses

Change = Callable[[tuple[Joint, ...]], tuple[Joint, ...]]


def load(folder: Path, text: str = "") -> Clips:
    (folder / "library.toml").write_text(text, encoding="utf-8")
    return load_clips(read_configuration(folder / "library.toml"), lambda *_: None)


def same_poses(found: Poses, expected: Poses) -> None:
    np.testing.assert_allclose(found.positions, expected.positions, atol=1e-5)
    assert found.rotations.shape == expected.rotations.shape
    assert np.degrees(rotations.angle_between(found.rotations, expected.rotations)).max() < 1e-4


@pytest.fixture
def clips(tmp_path: Path, small_clips: dict[str, Bvh]) -> Path:
    """Return a folder with two clips."""
    for name in ("Stand", "Stroll"):
        write(small_clips[name], tmp_path / f"{name}.bvh")
    return tmp_path


def test_clips_are_read_in_the_order_of_the_configuration_and_told_as_they_are(clips: Path, small_clips) -> None:
    told: list[tuple[int, int]] = []
    (clips / "library.toml").write_text("", encoding="utf-8")
    loaded = load_clips(read_configuration(clips / "library.toml"), lambda *done: told.append(done))
    assert list(loaded.poses) == ["Stand", "Stroll"]
    assert loaded.frame_rate == pytest.approx(30.0)
    assert told == [(0, 2), (1, 2), (2, 2)]
    for name, poses in loaded.poses.items():
        same_poses(poses, poses_from_bvh(small_clips[name]))


def test_frames_are_cut_from_the_first_to_before_the_last(clips: Path, small_clips) -> None:
    loaded = load(clips, "[clips.Stand]\nframes = [10, 31]")
    assert loaded.poses["Stand"].n_frames == 21
    same_poses(loaded.poses["Stand"], poses_from_bvh(small_clips["Stand"])[10:31])


def test_frames_that_a_clip_has_not_are_told_with_the_line_of_its_table(clips: Path) -> None:
    load(clips, "[clips.Stand]\nframes = [10, 120]")
    with pytest.raises(ConfigurationError) as caught:
        load(clips, "\n[clips.Stand]\nframes = [10, 121]")
    assert str(caught.value) == f"{clips}/library.toml:2: frames = [10, 121], but {clips}/Stand.bvh has 120 frames"


def test_clips_of_another_rate_are_resampled(clips: Path, small_clips) -> None:
    slower = load(clips, '[library]\nframe_rate = 20\nclips = ["*.bvh"]')
    assert slower.frame_rate == 20.0
    same_poses(slower.poses["Stand"], resample(poses_from_bvh(small_clips["Stand"]), 30.0, 20.0))
    assert slower.poses["Stand"].n_frames == 80


def test_without_a_rate_all_clips_get_that_of_the_first(clips: Path, small_clips) -> None:
    write(replace(small_clips["Stroll"], frame_time_s=1.0 / 120.0), clips / "Stroll.bvh")
    loaded = load(clips)
    assert loaded.frame_rate == pytest.approx(30.0)
    same_poses(loaded.poses["Stroll"], poses_from_bvh(small_clips["Stroll"])[::4])


@pytest.mark.parametrize(
    ("frame_time_s", "bound"), [(33.3, "at most 1: is it in milliseconds?"), (1e-300, "at least 0.0001")]
)
def test_frame_times_that_nobody_means_are_told_with_the_clip(clips: Path, small_clips, frame_time_s, bound) -> None:
    write(small_clips["Stand"], clips / "Stand.bvh")
    text = (clips / "Stand.bvh").read_text().splitlines(keepends=True)
    at = next(index for index, line in enumerate(text) if line.startswith("Frame Time"))
    (clips / "Stand.bvh").write_text("".join([*text[:at], f"Frame Time: {frame_time_s}\n", *text[at + 1 :]]))
    with pytest.raises(LibraryError) as caught:
        load(clips)
    assert str(caught.value) == f"{clips}/Stand.bvh: a frame lasts {frame_time_s:g} s; expected {bound}"


def test_cutting_comes_before_resampling(clips: Path, small_clips) -> None:
    loaded = load(clips, "[library]\nframe_rate = 15\n[clips.Stand]\nframes = [20, 41]")
    same_poses(loaded.poses["Stand"], poses_from_bvh(small_clips["Stand"])[20:41:2])


def test_a_clip_can_be_there_twice_once_in_a_mirror(clips: Path) -> None:
    loaded = load(clips, '[clips.Stroll]\n[clips.Llorts]\nfile = "Stroll.bvh"\nmirror = true')
    same_poses(loaded.poses["Llorts"], mirrored(loaded.skeleton, loaded.poses["Stroll"]))


def test_a_body_whose_sides_are_unlike_is_not_mirrored(clips: Path, small_clips) -> None:
    stroll = small_clips["Stroll"]
    longer = [
        replace(joint, offset=(9.0, 300.0, 9.0)) if "Left" in joint.name or joint.name.endswith("_L") else joint
        for joint in stroll.joints
    ]
    for name in ("Stand", "Stroll"):
        write(replace(small_clips[name], joints=tuple(longer)), clips / f"{name}.bvh")
    load(clips, "")
    with pytest.raises(ConfigurationError, match="do not mirror each other; expected the OFFSETs") as caught:
        load(clips, "\n[clips.Stroll]\nmirror = true")
    assert str(caught.value).startswith(f"{clips}/library.toml:2: {clips}/Stroll.bvh cannot be mirrored: the bones ")


def test_z_up_clips_stand_upright_inside_the_library(clips: Path, small_clips) -> None:
    loaded = load(clips, '[library]\nup = "z"')
    same_poses(loaded.poses["Stand"], poses_from_bvh(small_clips["Stand"], "z"))
    raw = small_clips["Stand"].frames[:, :3]
    x, y, z = np.moveaxis(loaded.poses["Stand"].positions[:, 0], -1, 0)
    np.testing.assert_allclose(np.stack((x, y, z), axis=1), raw[:, [0, 2, 1]] * (1.0, 1.0, -1.0), atol=1e-5)


def last_child_first(bvh: Bvh) -> Bvh:
    """Return the same motion as a program might write it that goes through the children the other way round."""
    order: list[int] = []

    def visit(joint: int) -> None:
        order.append(joint)
        for child in reversed([at for at, other in enumerate(bvh.joints) if other.parent == joint]):
            visit(child)

    visit(0)
    ends = np.cumsum([len(joint.channels) for joint in bvh.joints])
    joints = [replace(bvh.joints[at], parent=order.index(max(bvh.joints[at].parent, 0)) if at else -1) for at in order]
    columns = [column for at in order for column in range(ends[at] - len(bvh.joints[at].channels), ends[at])]
    return Bvh(tuple(joints), bvh.frame_time_s, bvh.frames[:, columns])


def test_which_child_of_a_joint_a_file_names_first_makes_no_difference(clips: Path, small_clips) -> None:
    other = last_child_first(small_clips["Stroll"])
    assert [joint.name for joint in other.joints] != [joint.name for joint in small_clips["Stroll"].joints]
    write(other, clips / "Stroll.bvh")
    loaded = load(clips)
    assert loaded.skeleton.names == tuple(joint.name for joint in small_clips["Stand"].joints)
    same_poses(loaded.poses["Stroll"], poses_from_bvh(small_clips["Stroll"]))


def swap(joints: tuple[Joint, ...], a: int, b: int) -> tuple[Joint, ...]:
    changed = list(joints)
    changed[a], changed[b] = replace(joints[a], name=joints[b].name), replace(joints[b], name=joints[a].name)
    return tuple(changed)


def with_joint(joints: tuple[Joint, ...], index: int, **values: object) -> tuple[Joint, ...]:
    return tuple(replace(joint, **values) if at == index else joint for at, joint in enumerate(joints))


DISAGREEMENTS = [
    (
        lambda joints: (*joints, Joint("Tail", 0, (0.0, 0.0, -9.0), ())),
        "has a joint `Tail`, which that has not",
    ),
    (lambda joints: joints[:-1], "has no joint `RightLeg`, which that has"),
    (lambda joints: swap(joints, 3, 7), "has the joint `RightLeg` where that has `LeftHand`"),
    (
        lambda joints: with_joint(joints, 6, parent=1),
        "hangs the joint `LeftLeg` on `Spine`, that on `Hips`",
    ),
    (
        lambda joints: with_joint(joints, 3, channels=("Xposition", "Yposition", "Zposition")),
        "gives positions to the joint `LeftHand`, that none",
    ),
    (
        lambda joints: with_joint(joints, 3, offset=(27.0, -3.0, 0.5)),
        "has the joint `LeftHand` at OFFSET 27 -3 0.5, that at 27 -3 0",
    ),
]


@pytest.mark.parametrize(("change", "message"), DISAGREEMENTS)
def test_a_clip_with_another_skeleton_is_refused_by_name_joint_and_difference(
    clips: Path, small_clips: dict[str, Bvh], change: Change, message: str
) -> None:
    joints = change(small_clips["Stroll"].joints)
    n_channels = sum(len(joint.channels) for joint in joints)
    write(Bvh(joints, 1.0 / 30.0, np.zeros((40, n_channels))), clips / "Stroll.bvh")
    with pytest.raises(LibraryError) as caught:
        load(clips)
    whose = f"this is not the skeleton of {clips}/Stand.bvh, which all clips of the library have to share"
    assert str(caught.value) == f"{clips}/Stroll.bvh: {whose}: it {message}"


def test_a_clip_that_lacks_positions_of_a_joint_is_refused(clips: Path, small_clips: dict[str, Bvh]) -> None:
    joints = with_joint(small_clips["Stand"].joints, 3, channels=("Xposition", "Yposition", "Zposition"))
    n_channels = sum(len(joint.channels) for joint in joints)
    write(Bvh(joints, 1.0 / 30.0, np.zeros((40, n_channels))), clips / "Stand.bvh")
    with pytest.raises(LibraryError, match="it gives no positions to the joint `LeftHand`, that some"):
        load(clips)


@pytest.mark.parametrize(("unit", "tolerated", "refused"), [(1.0, 0.04, 0.06), (0.01, 0.0004, 0.0006)])
def test_bones_may_differ_by_a_twentieth_of_a_centimetre_in_centimetres_and_in_metres(
    clips: Path, small_clips: dict[str, Bvh], unit: float, tolerated: float, refused: float
) -> None:
    def written(name: str, error: float) -> None:
        joints = (replace(j, offset=tuple(unit * x for x in j.offset)) for j in small_clips[name].joints)
        joints = with_joint(tuple(joints), 3, offset=(unit * 27.0 + error, unit * -3.0, 0.0))
        write(replace(small_clips[name], joints=joints), clips / f"{name}.bvh")

    written("Stand", 0.0)
    written("Stroll", tolerated)
    assert load(clips).poses["Stroll"].n_frames == 110
    written("Stroll", refused)
    with pytest.raises(LibraryError, match="has the joint `LeftHand` at OFFSET"):
        load(clips)


@pytest.mark.mocap
def test_real_clips_of_another_body_are_refused(mocap: Path, tmp_path: Path) -> None:
    text = f'[library]\nclips = ["{mocap}/cmu-14/14_02.bvh", "{mocap}/cmu-29/29_02.bvh"]'
    with pytest.raises(LibraryError, match=r"29_02\.bvh: .*14_02\.bvh.* has the joint `\w+` at OFFSET .*, that at "):
        load(tmp_path, text)
