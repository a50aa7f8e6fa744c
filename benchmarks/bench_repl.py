"""How fast the interactive session is: its start, what it offers while one types, its replies.

    python benchmarks/bench_repl.py

What is offered is measured on a library of 10,000 names, 2,000 motions and 8,000 tags on two graphs, made of random
numbers, as only their amount counts. Starts are cold processes in a terminal, up to the prompt. Ends with code 1 where
a limit is missed.
"""

from __future__ import annotations

import os
import pty
import random
import select
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator

import numpy as np
from prompt_toolkit.completion import CompleteEvent
from prompt_toolkit.document import Document

from mlmg_lang.repl.conversation import Conversation
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.terminal.completing import ScriptCompleter
from mlmg_lang.repl.terminal.marking import ScriptLexer
from mlmg_lang.session.session import Session
from mlmg_runtime.demo.library import demo_library
from mlmg_runtime.library import Library, open_library
from mlmg_runtime.motion_graph import TRANSITION, MotionGraph

N_MOTIONS, N_TAGS, N_EDGES, N_STARTS = 2_000, 8_000, 40_000, 7
TYPED = (
    "TAG_17 with Upper-Body TAG_4021 for 10 sec",
    "(Motion_0100 or TAG_5) with Upper-Body (TAG_31 and not TAG_9) for 3 sec",
    "Upper-Body TAG_777 once",
)
COMMANDS = ("WALK for 3 sec", "WALK with Upper-Body TALK for 3 sec", "IDLE", "IDLE with Left-Hand WAVE for 2 sec")


def large_library(like: Library) -> Library:
    """Return a library of 10,000 names with random transitions and similarities, on the skeleton of another."""
    draw = np.random.default_rng(1)
    names = tuple(f"Motion_{n:04}" for n in range(N_MOTIONS))
    graphs = {}
    for name, parent in (("Full-Body", None), ("Upper-Body", "Full-Body")):
        own = like.by_name[name]
        edges = np.zeros(N_EDGES, TRANSITION)
        for end in ("src", "dst"):
            edges[f"{end}_motion"] = draw.integers(0, N_MOTIONS, N_EDGES)
            edges[f"{end}_frame"] = draw.integers(own.window, 280, N_EDGES)
        edges.sort(order=["src_motion", "src_frame", "dst_motion", "dst_frame"])
        tags = {
            motion: tuple(f"TAG_{n % N_TAGS}" for n in range(4 * at, 4 * at + 4)) for at, motion in enumerate(names)
        }
        oms, hops = draw.random((N_MOTIONS, N_MOTIONS)), np.ones((N_MOTIONS, N_MOTIONS), int)
        graphs[name] = MotionGraph(
            name, parent, own.joints, own.weights, own.window, own.sigma, own.blend, names, tags,
            np.full(N_MOTIONS, 300), edges, np.zeros(oms.shape, bool), oms, hops,
        )  # fmt: skip
    return Library(like.path, like.skeleton, like.frame_rate, like.up, names[0], graphs, {}, ())


def starts() -> Iterator[float]:
    """Yield how long cold processes take from their start until the prompt stands in the terminal."""
    environment = os.environ | {"MLMG_HISTORY": os.devnull, "TERM": "xterm-256color"}
    for _ in range(N_STARTS + 1):
        master, slave = pty.openpty()
        begin = time.perf_counter()
        program = [sys.executable, "-m", "mlmg_lang.commands.mlmg", "repl", str(demo_library())]
        with subprocess.Popen(program, stdin=slave, stdout=slave, stderr=slave, env=environment) as process:
            shown = b""
            while b"Script>>>" not in shown and select.select([master], [], [], 30)[0]:
                shown += os.read(master, 1 << 16)
            yield time.perf_counter() - begin
            process.kill()
        os.close(master)
        os.close(slave)


def offering(desk: Desk) -> Iterator[float]:
    """Yield how long it takes, after each key of some lines, to know what to offer."""
    completer = ScriptCompleter(desk)
    for text in TYPED:
        for end in range(1, len(text) + 1):
            yield timed(
                lambda end=end, text=text: list(completer.get_completions(Document(text[:end]), CompleteEvent()))
            )


def marking(desk: Desk) -> Iterator[float]:
    """Yield how long it takes, after each key of some lines, to colour and check what stands there."""
    lexer = ScriptLexer(desk)
    for text in TYPED:
        for end in range(1, len(text) + 1):
            yield timed(lambda end=end, text=text: lexer.lex_document(Document(text[:end]))(0))


def replying(desk: Desk) -> Iterator[float]:
    """Yield how long commands take until they are answered."""
    conversation, draw = Conversation(desk), random.Random(2)
    for _ in range(200):
        line = draw.choice(COMMANDS)
        yield timed(lambda line=line: conversation.say(line))


def timed(work: Callable[[], object]) -> float:
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def main() -> int:
    demo = open_library(demo_library())
    large = Desk(Session(large_library(demo)), lambda *_: "")
    small = Desk(Session(demo), lambda *_: "")
    rows = [
        ("start, cold, to the prompt", statistics.median(list(starts())[1:]), 0.5),
        ("what is offered, 10,000 names, p95", percentile(offering(large)), 0.016),
        ("colours and underlines, 10,000 names, p95", percentile(marking(large)), 0.016),
        ("reply to a command, demo library, p95", percentile(replying(small)), None),
    ]
    for label, seconds, limit in rows:
        print(f"{label:<44} {seconds:8.4f} s {'' if limit is None else f'limit {limit:g} s'}")
    return int(any(limit is not None and seconds > limit for _, seconds, limit in rows))


def percentile(times: Iterator[float]) -> float:
    return statistics.quantiles(list(times), n=20)[-1]


if __name__ == "__main__":
    sys.exit(main())
