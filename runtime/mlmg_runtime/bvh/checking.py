"""Whether a BVH document can be written, and read again."""

from __future__ import annotations

import math
import re

import numpy as np

from mlmg_runtime.bvh.document import POSITION_CHANNELS, ROTATION_CHANNELS, Bvh, Joint
from mlmg_runtime.bvh.lines import BLANKS
from mlmg_runtime.errors import ShapeError

_CHANNELS = {*POSITION_CHANNELS, *ROTATION_CHANNELS}
_NOT_IN_A_NAME = re.compile("[{}\r\n\0\ud800-\udfff]")


def check(bvh: Bvh) -> None:
    """Do nothing if a file can hold `bvh`.

    Raises
    ------
    ShapeError
        If the joints are not one tree in depth-first order, with different names that fit on a line and
        with different channels; if there is no frame or no channel, or they do not match; if a number is
        NaN or infinite; or if the frame time is not above 0.
    """
    _check_tree(bvh.joints)
    _check_names([joint.name for joint in bvh.joints])
    for joint in bvh.joints:
        _check_joint(joint)
    if not (math.isfinite(bvh.frame_time_s) and bvh.frame_time_s > 0.0):
        raise ShapeError(f"expected a frame time above 0, found {bvh.frame_time_s}")
    _check_frames(bvh)


def _check_tree(joints: tuple[Joint, ...]) -> None:
    chain: list[int] = []
    for index, joint in enumerate(joints):
        while chain and chain[-1] != joint.parent:
            chain.pop()
        if (index > 0) != bool(chain) or (index == 0 and joint.parent != -1):
            raise ShapeError(f"expected one tree of joints, depth first, found parent {joint.parent} of joint {index}")
        chain.append(index)


def _check_names(names: list[str]) -> None:
    seen: set[str] = set()
    for name in names:
        if not name or name != name.strip(BLANKS) or _NOT_IN_A_NAME.search(name):
            raise ShapeError(f"expected a joint name that fits on a line, without braces, found {name!r}")
        if name in seen:
            raise ShapeError(f"expected different joint names, found {name!r} twice")
        seen.add(name)


def _check_joint(joint: Joint) -> None:
    if len(_CHANNELS.intersection(joint.channels)) < len(joint.channels):
        raise ShapeError(f"expected different channels of BVH files, found {joint.channels} in joint {joint.name!r}")
    if not all(map(math.isfinite, (*joint.offset, *(joint.end_site or ())))):
        raise ShapeError(f"expected finite offsets, found {joint.offset}, {joint.end_site} in joint {joint.name!r}")


def _check_frames(bvh: Bvh) -> None:
    shape = bvh.frames.shape
    if len(shape) != 2 or shape[1] != bvh.n_channels or bvh.frames.size == 0:
        raise ShapeError(f"expected frames of shape (1 or more, {bvh.n_channels or '1 or more'}), found {shape}")
    finite = np.isfinite(bvh.frames)
    if not finite.all():
        frame, column = np.argwhere(~finite)[0]
        channels = [f"{channel} of joint {joint.name!r}" for joint in bvh.joints for channel in joint.channels]
        raise ShapeError(
            f"expected finite values, found {bvh.frames[frame, column]} in frame {frame}, {channels[column]}"
        )
