"""The runtime of Motion Script: clips, motion graphs, libraries, playing, BVH. It knows no language."""
