"""The configuration of the demo library: its graphs, and what a person would call each motion."""

from __future__ import annotations

_CONFIGURATION = """\
# The demo library: nine motions made by code, three graphs.

[library]
clips = ["*.bvh"]
frame_rate = 30
up = "y"
start = "Idle_01"

[[graph]]
name = "Full-Body"

[[graph]]
name = "Upper-Body"
joints = ["Spine"]

# A wave of the hand takes the arm that carries it.
[[graph]]
name = "Left-Hand"
joints = ["LeftArm"]

[tags.Full-Body]
Idle_01 = ["IDLE"]
Idle_02 = ["IDLE"]
Walk_01 = ["WALK"]
Walk_02 = ["WALK"]
Walk_03 = ["WALK", "WAVE_HAND"]
Music_01 = ["Music", "IDLE"]
Talk_01 = ["TALK", "IDLE"]
Talk_02 = ["TALK"]

# Without Idle_02: while both hands are up, the upper body does nothing else.
[tags.Upper-Body]
Idle_01 = ["IDLE"]
Walk_01 = ["SWING_HAND"]
Walk_02 = ["SWING_HAND"]
Walk_03 = ["WAVE_HAND"]
Music_01 = ["Music", "IDLE"]
Talk_01 = ["TALK", "IDLE"]
Talk_02 = ["TALK"]

[tags.Left-Hand]
Idle_01 = ["IDLE"]
Walk_01 = ["SWING_HAND"]
Walk_02 = ["SWING_HAND"]
Walk_03 = ["WAVE_HAND"]
Music_01 = ["Music", "IDLE"]
Talk_01 = ["TALK", "IDLE"]
Talk_02 = ["TALK"]
Wave_01 = ["WAVE"]
"""


def demo_configuration() -> str:
    """Return the text of the demo library's configuration (TOML); clips are named `*.bvh` beside it."""
    return _CONFIGURATION
