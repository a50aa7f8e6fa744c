"""Reading the clips of a configuration: one skeleton, one frame rate, y up."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mlmg_runtime import bvh
from mlmg_runtime.building.configuration import ClipSource, LibraryConfiguration
from mlmg_runtime.building.mirror import mirrored
from mlmg_runtime.bvh.document import Bvh, Joint
from mlmg_runtime.clips import poses_from_bvh, resample, same_rate, skeleton_from_bvh
from mlmg_runtime.errors import ConfigurationError, LibraryError
from mlmg_runtime.skeleton import Poses, Skeleton, has_positions

# Bones may differ by this, in centimetres or the like; by a hundredth of it where a body is so small that its unit
# must be the metre: a person's bones, laid end to end, are about 4 m long.
OFFSET_TOLERANCE = 0.05
_BONES_IN_METRES = 20.0
# Frames a second. A file with fewer has its frame time in another unit: resampled, it would fill the memory. One with
# more, if it is the first, would give its rate to all the others, which would.
SLOWEST_RATE = 1.0
FASTEST_RATE = 10000.0


@dataclass(frozen=True, slots=True)
class Clips:
    """The clips of a library, by motion name in configuration order; `frame_rate` in frames a second."""

    skeleton: Skeleton
    frame_rate: float
    poses: Mapping[str, Poses]
    warnings: tuple[str, ...]


def load_clips(configuration: LibraryConfiguration, progress: Callable[[int, int], None]) -> Clips:
    """Read, check, cut, mirror and resample the clips; `progress` is called with how many are read, and of how many.

    Raises
    ------
    BvhError, LibraryError, ConfigurationError
        If a clip cannot be read, has another skeleton than the first, or fewer frames than asked of it.
    """
    skeleton: Skeleton | None = None
    frame_rate = configuration.frame_rate
    poses: dict[str, Poses] = {}
    warnings: list[str] = []
    for done, clip in enumerate(configuration.clips):
        progress(done, len(configuration.clips))
        document = bvh.read(clip.path)
        warnings += [f"{clip.path}: {warning}" for warning in document.warnings]
        if skeleton is not None:
            document = _ordered(document, skeleton)
        own = skeleton_from_bvh(document)
        if skeleton is None:
            skeleton = own
        _check_agreement(skeleton, configuration.clips[0], own, clip)
        rate = _rate(document, clip)
        frame_rate = frame_rate or _usual(rate)
        poses[clip.name] = _poses(configuration, clip, document, skeleton, rate, frame_rate)
    progress(len(configuration.clips), len(configuration.clips))
    assert skeleton is not None  # a configuration has at least one clip
    assert frame_rate is not None
    return Clips(skeleton, frame_rate, poses, tuple(warnings))


def _ordered(document: Bvh, skeleton: Skeleton) -> Bvh:
    """Return the document with its joints in the skeleton's order, if both are one tree; else as it is.

    Programs differ in which child of a joint they write first.
    """
    own = {joint.name: joint for joint in document.joints}
    if _names_above(document.joints) != _names_above(skeleton.joints) or tuple(own) == skeleton.names:
        return document
    ends = np.cumsum([len(joint.channels) for joint in document.joints])
    columns = {joint.name: range(end - len(joint.channels), end) for joint, end in zip(own.values(), ends, strict=True)}
    joints = [replace(own[joint.name], parent=joint.parent) for joint in skeleton.joints]
    order = [column for joint in joints for column in columns[joint.name]]
    return replace(document, joints=tuple(joints), frames=document.frames[:, order])


def _names_above(joints: Sequence[Joint]) -> dict[str, str | None]:
    """Return the name of each joint's parent."""
    return {joint.name: joints[joint.parent].name if joint.parent >= 0 else None for joint in joints}


def _rate(document: Bvh, clip: ClipSource) -> float:
    """Return the frames a second of a clip, if these can be meant."""
    lasts = f"a frame lasts {document.frame_time_s:g} s; expected"
    if document.frame_time_s * SLOWEST_RATE > 1.0:
        raise LibraryError(clip.path, None, f"{lasts} at most {1.0 / SLOWEST_RATE:g}: is it in milliseconds?")
    if document.frame_time_s * FASTEST_RATE < 1.0:
        raise LibraryError(clip.path, None, f"{lasts} at least {1.0 / FASTEST_RATE:g}")
    return 1.0 / document.frame_time_s


def _poses(
    configuration: LibraryConfiguration,
    clip: ClipSource,
    document: Bvh,
    skeleton: Skeleton,
    rate: float,
    frame_rate: float,
) -> Poses:
    n_frames = document.frames.shape[0]
    poses = poses_from_bvh(document, configuration.up)
    if clip.frames is not None:
        first, end = clip.frames
        if end > n_frames:
            raise ConfigurationError(
                configuration.path,
                clip.line,
                f"frames = [{first}, {end}], but {clip.path} has {n_frames} frames",
            )
        poses = poses[first:end]
    if clip.mirror:
        try:
            poses = mirrored(skeleton, poses)
        except ValueError as error:
            message = f"{clip.path} cannot be mirrored: {error}"
            raise ConfigurationError(configuration.path, clip.line, message) from None
    return resample(poses, rate, frame_rate)


def _usual(rate: float) -> float:
    """Return the whole rate that a file's rounded frame time means, or the rate itself."""
    whole = float(round(rate))
    return whole if whole > 0 and same_rate(rate, whole) else rate


def _check_agreement(first: Skeleton, first_clip: ClipSource, own: Skeleton, clip: ClipSource) -> None:
    """Refuse a clip whose joints, tree or bones differ from the first clip's."""

    def fail(message: str) -> None:
        whose = f"this is not the skeleton of {first_clip.path}, which all clips of the library have to share"
        raise LibraryError(clip.path, None, f"{whose}: it {message}")

    bones = sum(math.hypot(*joint.offset) for joint in first.joints[first.travel + 1 :])
    tolerance = OFFSET_TOLERANCE if bones > _BONES_IN_METRES else 0.01 * OFFSET_TOLERANCE
    for name in own.names:
        if name not in first.names:
            fail(f"has a joint `{name}`, which that has not")
    for index, name in enumerate(first.names):
        if name not in own.names:
            fail(f"has no joint `{name}`, which that has")
        if own.names[index] != name:
            fail(f"has the joint `{own.names[index]}` where that has `{name}`")
        mine, theirs = own.joints[index], first.joints[index]
        if mine.parent != theirs.parent:
            fail(f"hangs the joint `{name}` on `{own.names[mine.parent]}`, that on `{first.names[theirs.parent]}`")
        if has_positions(mine) != has_positions(theirs):
            given, has = ("positions", "none") if has_positions(mine) else ("no positions", "some")
            fail(f"gives {given} to the joint `{name}`, that {has}")
        apart = float(np.abs(np.subtract(mine.offset, theirs.offset)).max())
        if apart > tolerance and not has_positions(mine) and index != own.travel:
            fail(f"has the joint `{name}` at OFFSET {_offset(mine.offset)}, that at {_offset(theirs.offset)}")


def _offset(offset: tuple[float, float, float]) -> str:
    return " ".join(f"{value:g}" for value in offset)
