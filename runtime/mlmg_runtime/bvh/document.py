"""A BVH file as data: the hierarchy and the channel values, exactly as the file says them."""

from __future__ import annotations

from dataclasses import dataclass

from mlmg_runtime.arrays import FloatArray

POSITION_CHANNELS = ("Xposition", "Yposition", "Zposition")
ROTATION_CHANNELS = ("Xrotation", "Yrotation", "Zrotation")


@dataclass(frozen=True, slots=True)
class Joint:
    """One joint of a hierarchy.

    Attributes
    ----------
    name : as the file spells it; dots and spaces allowed.
    parent : index of the parent joint, -1 for the root. A parent stands before its children.
    offset : position in the parent's frame, file units; replaced by the position channels, if there are any.
    channels : channel names in file order, in the spelling of `POSITION_CHANNELS` and `ROTATION_CHANNELS`.
    end_site : offset of the End Site, file units, or None.
    """

    name: str
    parent: int
    offset: tuple[float, float, float]
    channels: tuple[str, ...]
    end_site: tuple[float, float, float] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Bvh:
    """The content of a BVH file.

    Attributes
    ----------
    joints : depth first, as in the file; the first is the root.
    frame_time_s : seconds from one frame to the next.
    frames : array, shape (n_frames, n_channels), read-only. Channel values in file order: degrees and
        file units.
    warnings : what was odd in the file but could be read, one sentence each.
    """

    joints: tuple[Joint, ...]
    frame_time_s: float
    frames: FloatArray
    warnings: tuple[str, ...] = ()

    @property
    def n_channels(self) -> int:
        """Return how many values a frame holds."""
        return sum(len(joint.channels) for joint in self.joints)
