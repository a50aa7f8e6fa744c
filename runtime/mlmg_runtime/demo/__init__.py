"""The demo library's motions, made by code, so that everything can be tried without any motion capture.

A person is moved as a person moves: feet are planted by `footwork` and reached by `inverse_kinematics`, the
body floats above them as an inverted pendulum, trunk and arms answer (`carriage`), and what is meant (`gait`,
`idle`, `talk`, `dance`, `wave`) comes on top. Each clip's noise has a fixed seed: the clips never change.
"""

from __future__ import annotations

from mlmg_runtime.demo.clips import demo_clips
from mlmg_runtime.demo.configuration import demo_configuration

__all__ = ["demo_clips", "demo_configuration"]
