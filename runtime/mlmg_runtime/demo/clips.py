"""The clips of the demo library by name."""

from __future__ import annotations

from collections.abc import Callable

from mlmg_runtime.bvh.document import Bvh
from mlmg_runtime.clips import bvh_from_poses
from mlmg_runtime.demo.body import Performance, poses
from mlmg_runtime.demo.curves import FRAME_RATE
from mlmg_runtime.demo.dance import music_01
from mlmg_runtime.demo.gait import walk_01, walk_02, walk_03
from mlmg_runtime.demo.idle import idle_01, idle_02
from mlmg_runtime.demo.skeleton import human_skeleton
from mlmg_runtime.demo.talk import talk_01, talk_02
from mlmg_runtime.demo.wave import wave_01

_PERFORMANCES: tuple[tuple[str, Callable[[], Performance]], ...] = (
    ("Idle_01", idle_01),
    ("Idle_02", idle_02),
    ("Walk_01", walk_01),
    ("Walk_02", walk_02),
    ("Walk_03", walk_03),
    ("Music_01", music_01),
    ("Talk_01", talk_01),
    ("Talk_02", talk_02),
    ("Wave_01", wave_01),
)


def demo_clips() -> dict[str, Bvh]:
    """Return the clips of the demo library by motion name: the same values on every call, centimetres, y up.

    About 3,000 frames at 30 a second. All clips begin in one neutral stance. Those about standing end in it;
    those about doing something (walks, dance, raised hands) end in another, the left foot forward, that the
    former pass through: so there is a way out at every end, but none that leads back to the clip's own
    beginning, by which a person told to walk on would stop and start.
    """
    skeleton = human_skeleton()
    return {name: bvh_from_poses(skeleton, poses(perform()), 1.0 / FRAME_RATE) for name, perform in _PERFORMANCES}
