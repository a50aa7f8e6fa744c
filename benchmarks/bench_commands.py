"""How long a person waits: building a library, and a script compiled, played and written by a cold process.

    python benchmarks/bench_commands.py

On the reference clips where ../shared/mocap is present, else on the demo library. Each figure is the median of several
cold processes, beside its limit; the process that only imports numpy tells how fast the machine is just now.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parents[1]
MOCAP = ROOT.parent / "shared" / "mocap" / "reference"
N_RUNS = 7
SHORT = "Idle_01\nWALK for 10 sec\nWALK with Sub TALK for 10 sec\nIDLE for 2 sec\n"
LONG = "Idle_01\n" + "WALK for 50 sec\nWALK with Sub TALK for 50 sec\nIDLE for 20 sec\n" * 5


def median_s(command: Sequence[str]) -> float:
    """Return the median time of a command over several cold processes, after one that is not counted."""
    times = []
    for _ in range(N_RUNS + 1):
        begin = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True, env=os.environ | {"PYTHONDONTWRITEBYTECODE": ""})
        times.append(time.perf_counter() - begin)
    return statistics.median(times[1:])


def main() -> int:
    mlmg, mlmgc = ([sys.executable, "-m", f"mlmg_lang.commands.{name}"] for name in ("mlmg", "mlmgc"))
    missed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        library = folder / "reference.mlmg"
        (folder / "short.ms").write_text(SHORT)
        (folder / "long.ms").write_text(LONG)
        rows = [("import numpy, for comparison", [sys.executable, "-c", "import numpy"], None)]
        if MOCAP.is_dir():
            configuration = (ROOT / "tests" / "reference.toml").read_text()
            (folder / "library.toml").write_text(configuration.replace("CLIPS", f'"{MOCAP.as_posix()}/*.bvh"'))
            build = [*mlmg, "build", str(folder / "library.toml"), "-o", str(library)]
            rows.append(("mlmg build, 2,173 frames, two graphs", build, 5.0))
        else:
            print("../shared/mocap is absent: the demo library is played on, and no build is measured")
            from mlmg_runtime.demo.library import demo_library

            library = demo_library()
        play = [*mlmgc, "--library", str(library), "-o", str(folder / "out.bvh")]
        rows += [
            ("mlmg check, a small script, no library", [*mlmg, "check", str(folder / "short.ms")], None),
            ("mlmg check, a small script", [*mlmg, "check", "--library", str(library), str(folder / "short.ms")], None),
            ("mlmgc, half a minute of motion", [*play, str(folder / "short.ms")], 0.6),
            ("mlmgc, ten minutes of motion", [*play, str(folder / "long.ms")], 3.0),
        ]
        print(f"{'cold process, median of ' + str(N_RUNS):<42} {'seconds':>8} {'limit':>6}")
        for label, command, limit in rows:
            seconds = median_s(command)
            missed += limit is not None and seconds > limit
            print(f"{label:<42} {seconds:8.2f} {'' if limit is None else f'{limit:6.1f}'}")
    return int(missed > 0)


if __name__ == "__main__":
    sys.exit(main())
