"""How fast BVH files are read and written, beside other packages, in one run.

    python benchmarks/bench_bvh.py [--frames 5000] [--rounds 7]

Makes a file of 96 channels (5000 frames are about 5 MB), lets each package read and write it in turn, and
takes the best of the rounds. A package that is missing or refuses the file is shown as such; all are there
after `pip install pybvh upc-pymotion bvhtoolbox`. Ends with code 1 where a target is missed.
"""

from __future__ import annotations

import argparse
import importlib
import io
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mlmg_runtime import bvh
from mlmg_runtime.bvh import Bvh, Joint

TARGET_MB_S = 80.0
TARGET_FRAMES_S = 30_000.0
TURNS = ("Zrotation", "Xrotation", "Yrotation")


@dataclass(frozen=True)
class Tool:
    name: str
    read: Callable[[Path], Any]
    write: Callable[[Any, Path], object] | None = None
    note: str = ""


def mlmg() -> Tool:
    return Tool("mlmg", bvh.read, bvh.write)


def pybvh() -> Tool:
    package = importlib.import_module("pybvh")
    return Tool("pybvh", package.read_bvh_file, package.write_bvh_file)


def pymotion() -> Tool:
    package = importlib.import_module("pymotion.io.bvh")

    def read(path: Path) -> Any:
        document = package.BVH()
        document.load(str(path))
        return document

    return Tool("pymotion", read, lambda document, path: document.save(str(path)))


def bvhtoolbox() -> Tool:
    package = importlib.import_module("bvhtoolbox")
    return Tool(
        "bvhtoolbox",
        lambda path: package.BvhTree(path.read_text()),
        lambda document, path: document.write_file(str(path)),
        "keeps numbers as text: neither parses nor formats them",
    )


def loadtxt() -> Tool:
    return Tool("numpy.loadtxt", lambda path: np.loadtxt(io.BytesIO(motion_text(path))), note="the values alone")


def fromstring() -> Tool:
    return Tool("numpy.fromstring", lambda path: np.fromstring(motion_text(path), sep=" "), note="the values alone")


TOOLS = [mlmg, pybvh, pymotion, bvhtoolbox, loadtxt, fromstring]


def motion_text(path: Path) -> bytes:
    return path.read_bytes().partition(b"Frame Time:")[2].partition(b"\n")[2]


def made_up(n_frames: int) -> Bvh:
    """Return a body of 31 joints in five chains, 96 channels, whose joints swing smoothly."""
    joints = [Joint("Hips", -1, (0.0, 0.0, 0.0), ("Xposition", "Yposition", "Zposition", *TURNS))]
    for chain in range(5):
        for link in range(6):
            parent = len(joints) - 1 if link else 0
            end_site = (0.0, 5.0, 0.0) if link == 5 else None
            joints.append(Joint(f"Chain{chain}_{link}", parent, (2.5 * chain, 17.25, 0.0), TURNS, end_site))
    random = np.random.default_rng(0)
    time_s = np.arange(n_frames)[:, None] / 30.0
    swing = random.uniform(5.0, 90.0, 96) * np.sin(random.uniform(0.2, 4.0, 96) * time_s + random.uniform(0, 6, 96))
    return Bvh(tuple(joints), 1.0 / 30.0, swing)


def seconds(tools: list[Tool], task: Callable[[Tool], object], rounds: int) -> dict[str, float | str]:
    """Return each tool's best time, or its error; they take turns, so that all meet the same noise."""
    best: dict[str, float | str] = {}
    for _ in range(rounds):
        for tool in tools:
            so_far = best.get(tool.name, float("inf"))
            if isinstance(so_far, str):
                continue
            start = time.perf_counter()
            try:
                task(tool)
            except Exception as error:
                best[tool.name] = f"refused: {type(error).__name__}: {error}"
            else:
                best[tool.name] = min(so_far, time.perf_counter() - start)
    return best


def print_table(title: str, amount: float, unit: str, best: dict[str, float | str], notes: dict[str, str]) -> float:
    """Print speeds and how they compare to ours, and return ours."""
    own = best["mlmg"]
    assert isinstance(own, float), own
    print(f"\n{title}\n{'':18}{unit:>12}{'mlmg is':>14}")
    for name, result in best.items():
        if isinstance(result, str):
            print(f"{name:18}{result}")
        else:
            print(f"{name:18}{amount / result:12,.0f}{result / own:12.2f} x  {notes[name]}".rstrip())
    return amount / own


def installed() -> tuple[list[Tool], dict[str, float | str]]:
    tools: list[Tool] = []
    missing: dict[str, float | str] = {}
    for make in TOOLS:
        try:
            tools.append(make())
        except ImportError as error:
            missing[make.__name__] = f"not installed ({error})"
    return tools, missing


def print_agreement(path: Path) -> None:
    """Print how far our values are from those of pybvh, which gives angles in radians."""
    try:
        theirs = importlib.import_module("pybvh").read_bvh_file(path)
    except Exception as error:
        print(f"\nno comparison with pybvh: {error}")
        return
    angles = np.rad2deg(theirs.joint_angles).reshape(theirs.frame_count, -1)
    difference = bvh.read(path).frames - np.concatenate((theirs.root_pos, angles), axis=1)
    print(f"\nlargest difference from the values of pybvh: {np.abs(difference).max():.1e}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=int, default=5000)
    parser.add_argument("--rounds", type=int, default=7)
    options = parser.parse_args()
    tools, missing = installed()
    notes = {tool.name: tool.note for tool in tools}
    with tempfile.TemporaryDirectory() as folder:
        path, out = Path(folder, "clip.bvh"), Path(folder, "out.bvh")
        bvh.write(made_up(options.frames), path)
        size_mb = path.stat().st_size / 1e6
        print(f"{size_mb:.1f} MB, {options.frames} frames of 96 channels, best of {options.rounds}")
        read = seconds(tools, lambda tool: tool.read(path), options.rounds)
        documents = {tool.name: tool.read(path) for tool in tools if tool.write and isinstance(read[tool.name], float)}
        writers = [tool for tool in tools if tool.name in documents]
        written = seconds(writers, lambda tool: tool.write and tool.write(documents[tool.name], out), options.rounds)
        mb_s = print_table("reading", size_mb, "MB/s", read | missing, notes)
        frames_s = print_table("writing", options.frames, "frames/s", written | missing, notes)
        print_agreement(path)
    print(f"reading: {mb_s:,.0f} MB/s, target {TARGET_MB_S:,.0f}")
    print(f"writing: {frames_s:,.0f} frames/s, target {TARGET_FRAMES_S:,.0f}")
    return 0 if mb_s >= TARGET_MB_S and frames_s >= TARGET_FRAMES_S else 1


if __name__ == "__main__":
    sys.exit(main())
