"""The runtime of Motion Script: clips, motion graphs, libraries, playing, BVH. It knows no language."""

from mlmg_runtime import bvh
from mlmg_runtime.library import Library, open_library

__all__ = ["Library", "bvh", "open_library"]
