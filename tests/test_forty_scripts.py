"""Forty scripts on the reference library: what each of them must choose, and why (see scripts/README.md).

What stands behind `#=` in a script is held twice: against what this file works out from LANGUAGE.md 5 and 6, slowly
and without the performer (arrivals by shortest paths over all frames, fits from the table of similarities), and
against the report of the run. Only where the character is before a command is taken from the report.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from mlmg_lang.execution import drawing, executed
from mlmg_lang.front_end import Analysis, analyse
from mlmg_lang.perform import perform
from mlmg_lang.planning.resolved import Command, Cycles, End, Layer, Once, Seconds, Wait
from mlmg_lang.script_files import used_files
from mlmg_lang.source import Source
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph

FOLDER = Path(__file__).parent / "scripts"
SCRIPTS = sorted(path for path in FOLDER.rglob("*.ms") if path.parent.name != "used")
CLAIM = re.compile(r"#= *(.*?) *$")
FRAMES_A_SECOND = 30
SMALL = 1e-2
"""What a transition's cost is worth in frames: less than one, whatever the walk; so costs have ten decimals."""


@dataclass(frozen=True)
class Script:
    """A script with what it claims: header lines `# key: value`, and behind `#=` what each step does."""

    path: Path

    @cached_property
    def text(self) -> str:
        return self.path.read_text(encoding="utf-8")

    def header(self, key: str) -> str | None:
        found = re.search(rf"^# {key}: *(.*?) *$", self.text, re.MULTILINE)
        return found and found[1]

    @cached_property
    def claims(self) -> dict[int, list[str]]:
        """Return the claims by the line of the statement that they are about."""
        claims: dict[int, list[str]] = {}
        for statement, line in self._lines():
            if claim := CLAIM.search(line):
                claims.setdefault(statement, []).append(claim[1])
        return claims

    def with_claims(self, told: Mapping[int, list[str]]) -> str:
        """Return the text with other claims in the places of its own."""
        rest = {statement: iter(claims) for statement, claims in told.items()}
        lines = (CLAIM.sub(lambda _, at=at: f"#= {next(rest[at])}", line) for at, line in self._lines())
        return "\n".join(lines)

    def _lines(self) -> Iterator[tuple[int, str]]:
        """Yield each line, and which one above it, or it itself, is the last with more than comments and braces."""
        statement = 0
        for number, line in enumerate(self.text.split("\n"), start=1):
            statement = number if line.split("#")[0].strip(" }") else statement
            yield statement, line

    def analysis(self, library: Library) -> Analysis:
        return analyse(Source(self.text, str(self.path)), library, self.header("start"), used_files(self.path))


@dataclass
class Teller:
    """Goes through a script as LANGUAGE.md has it, one step after the other, and tells what has to happen.

    `own` are the motions of the graphs that run on their own, `now` is the frame of the output.
    """

    library: Library
    report: Mapping[str, Any]
    own: dict[str, str]
    now: int = 0
    counted: str = ""
    entries: Iterator[Mapping[str, Any]] = field(init=False)

    def __post_init__(self) -> None:
        self.counted = self.library.root.name
        self.entries = iter(self.report["commands"])

    def tell(self, step: Command | Wait | End, is_last: bool) -> str:
        match step:
            case Command():
                return self._command(step, is_last)
            case Wait(duration=duration):
                n_frames = self._n_frames(duration)
                self.now += n_frames
                return frames(n_frames)
            case End(graph=graph):
                return self._end(graph)

    def _command(self, command: Command, is_last: bool) -> str:
        """Tell of a command, and hold the report to it."""
        entry = next(self.entries)
        assert entry["begin"] == self.now
        named = [layer.graph for layer in command.layers]
        told, arrived = self._end_parts([part for part in self._below(named) if part not in named])
        for layer in command.layers:
            afresh = layer is command.layers[0] and isinstance(command.duration, Once)
            more, arrived = self._layer(layer, entry, arrived, afresh)
            told += more
        assert entry["motions"] == {graph: self._driver(graph) for graph in named}, told
        assert entry["arrive"] == arrived
        self.counted = named[0]
        n_frames = self._lasts(command, entry, is_last)
        assert entry["end"] - entry["arrive"] == n_frames
        self.now = entry["end"]
        return "; ".join([*told, frames(n_frames)] if n_frames else told)

    def _layer(self, layer: Layer, entry: Mapping[str, Any], from_then: int, afresh: bool) -> tuple[list[str], int]:
        """Tell what happens on a graph, where all above have arrived at a moment; and when it has arrived itself.

        `afresh`: its motion is wanted `once`, from where it begins.
        """
        graph = layer.graph
        # What is outranked is told with its rank, and never taken.
        outranked = {out.motion for out in layer.left_out if out.reason == "outranked"}
        candidates = tuple(m for m in self.library.motions(graph) if m in outranked or m in layer.candidates)
        left = "".join(
            f", without {out.motion} ({out.reason})" for out in layer.left_out if out.motion not in outranked
        )
        driver, above = self._driver(graph), self.library.parent(graph)
        if driver in candidates and not (afresh and not self._begins(graph, from_then)):
            assert driver not in outranked
            verb = "keeps" if graph in self.own else "follows"
            return [f"{graph} {verb} {driver} of {' '.join(candidates)}{left}"], from_then
        told, back = self._end_parts(self._below([graph]))
        from_then = max(from_then, back)
        if afresh:
            candidates, way = self._beginnings(graph, candidates)
            left += f", from frame {self.library.by_name[graph].window - 1} by a {way}"
        measured = self._fits(graph) if above else self._arrivals(self.library.root, from_then)
        best, numbers = best_of(candidates, measured, entry["begin"])
        assert best not in outranked
        if above and best == self._driver(above) and not afresh:
            del self.own[graph]
            return [*told, f"{graph} ends: {numbers}{left}"], self._run_ends(graph, from_then)
        self.own[graph] = best
        arrival = self._arrives(graph, entry, from_then, afresh)
        assert above or afresh or arrival == measured[best][0]
        return [*told, f"{graph} {numbers}{left}"], arrival

    def _begins(self, graph: str, time: int) -> bool:
        """Return whether a graph has just begun its motion, at its first frame or where transitions lead to."""
        if graph not in self.own:
            return False
        _, motion, frame = self._place(graph, time)
        return motion == self.own[graph] and frame in (0, self.library.by_name[graph].window)

    def _beginnings(self, graph: str, candidates: tuple[str, ...]) -> tuple[tuple[str, ...], str]:
        """Return which candidates can be begun by a transition; or, if there is none, that all take a blend."""
        own = self.library.by_name[graph]
        entered = {own.motions[edge.dst_motion] for edge in own.edges if edge.dst_frame == own.window - 1}
        begun = tuple(motion for motion in candidates if motion in entered)
        return (begun, "transition") if begun else (candidates, "blend")

    def _end(self, graph: str) -> str:
        told, until = self._end_parts([graph] if graph in self.own else [])
        n_frames, self.now = until - self.now, until
        return f"{told[0]} in {frames(n_frames)}" if told else f"{graph} does not run"

    def _end_parts(self, graphs: list[str]) -> tuple[list[str], int]:
        """End parts; tell of them, and when the last is back."""
        back = [self._run_ends(graph, self.now) for graph in graphs]
        for graph in graphs:
            del self.own[graph]
        return [f"{graph} ends" for graph in graphs], max([self.now, *back])

    # What the language says of time

    def _lasts(self, command: Command, entry: Mapping[str, Any], is_last: bool) -> int:
        if isinstance(command.duration, Once):
            return self._rest(entry["arrive"], to_exit=True)
        if command.duration is not None:
            return self._n_frames(command.duration)
        return self._rest(entry["arrive"], to_exit=False) if is_last else 0

    def _n_frames(self, duration: Seconds | Cycles) -> int:
        if isinstance(duration, Seconds):
            return round(duration.number * FRAMES_A_SECOND)
        return round(duration.number * self.library.n_frames(self._driver(self.counted)))

    def _rest(self, arrive: int, to_exit: bool) -> int:
        """Return how many frames the topmost named motion has left on arrival, up to its end or to its last exit."""
        name = next(g for g in (self.counted, *self.library.ancestors(self.counted)) if g in self.own)
        graph = self.library.by_name[name]
        time, motion, frame = self._place(name, arrive)
        assert motion == self.own[name]
        exits = [edge.src_frame for edge in graph.edges if edge.src_motion == graph.index[motion]]
        return time - arrive + (max(exits) if to_exit else self.library.n_frames(motion)) - frame

    # What the language says of choices

    def _arrivals(self, graph: MotionGraph, time: int) -> dict[str, tuple[int, float]]:
        """Return at what frame each motion can be reached, and at what cost of transitions.

        A frame of a clip is one step, a transition k.
        """
        at, motion, frame = self._place(graph.name, time)
        firsts = np.concatenate([[0], np.cumsum(graph.n_frames)])
        clips = np.setdiff1d(np.arange(firsts[-1]), firsts[1:] - 1)
        edges = graph.transitions
        leaves, lands = (firsts[edges[f"{end}_motion"]] + edges[f"{end}_frame"] for end in ("src", "dst"))
        tails, heads = np.concatenate([clips, leaves]), np.concatenate([clips + 1, lands + 1])
        last_steps = graph.window + SMALL * edges["cost"]
        steps = np.concatenate([np.ones(len(clips)), last_steps])
        walks = coo_array((steps, (tails, heads)), shape=(firsts[-1], firsts[-1])).tocsr()
        lasts = dijkstra(walks, indices=firsts[graph.index[motion]] + frame)[leaves] + last_steps
        ways = list(zip(edges["dst_motion"], lasts, strict=True))
        found = {target: min(last for into, last in ways if into == graph.index[target]) for target in graph.motions}
        return {
            target: (at + int(last), round(last % 1 / SMALL, 10)) for target, last in found.items() if np.isfinite(last)
        }

    def _fits(self, graph: str) -> dict[str, tuple[float, float]]:
        """Return the overall motion similarity of each motion to what the graph above plays."""
        own = self.library.by_name[graph]
        above = own.index[self._driver(str(own.parent))]
        return {motion: (float(own.oms[above, own.index[motion]]), 0.0) for motion in own.motions}

    def _driver(self, graph: str) -> str:
        return next(self.own[g] for g in (graph, *self.library.ancestors(graph)) if g in self.own)

    def _below(self, graphs: list[str]) -> list[str]:
        """Return what runs on its own below one of some graphs."""
        return [part for part in self.own if any(above in graphs for above in self.library.ancestors(part))]

    # What the report tells of where the character is

    def _place(self, graph: str, time: int) -> tuple[int, str, int]:
        """Return the next moment at which a graph may leave its clip, with the clip and the frame shown then."""
        entry = next(e for e in self.report["tracks"][graph] if e["begin"] <= time < e["end"])
        if entry["kind"] == "clip":
            return time, entry["motion"], entry["clip_begin"] + time - entry["begin"]
        if entry["begin"] == time:
            return time, *entry["from"]
        motion, frame = entry["to"]
        return entry["end"], motion, frame + 1

    def _run_ends(self, graph: str, time: int) -> int:
        """Return until when a graph runs without a pause from a moment on."""
        for entry in self.report["tracks"].get(graph, ()):
            time = max(time, entry["end"]) if entry["begin"] <= time else time
        return time

    def _arrives(self, graph: str, entry: Mapping[str, Any], from_then: int, afresh: bool) -> int:
        """Return when a graph, which sets out at a moment or later, comes into the motion it has on arrival."""
        begins = self.library.by_name[graph].window - 1
        ways = [e for e in self.report["tracks"][graph] if e["kind"] != "clip" and from_then <= e["begin"]]
        into = [e for e in ways if e["to"] is not None and e["to"][0] == self.own[graph]]
        return next(e["end"] for e in into if not afresh or e["to"][1] == begins)


def best_of(candidates: tuple[str, ...], measured: Mapping[str, tuple[float, float]], begin: int) -> tuple[str, str]:
    """Return the best of some candidates, the first of those that are equally good, and how they compare in words.

    Frames are whole numbers and told from the begin of the command on; fits are told in thousands.
    """
    ranked = sorted(candidates, key=measured.__getitem__)
    told = ""
    for before, motion in pairwise([None, *ranked]):
        number, cost = measured[motion]
        if before is not None:
            told += " = " if measured[before] == measured[motion] else " < "
        told += f"{motion} {number - begin}" if isinstance(number, int) else f"{motion} {number / 1000:.3g}"
        if sum(measured[other][0] == number for other in candidates) > 1:
            told += f" costing {cost:.3g}"
    return ranked[0], told


def frames(n_frames: int) -> str:
    return f"{n_frames} frame{'' if n_frames == 1 else 's'}"


def told_of(script: Script, library: Library) -> dict[int, list[str]]:
    """Return what a script must do, by line."""
    analysis = script.analysis(library)
    codes = ", ".join(one.code for one in analysis.diagnostics)
    assert codes == (script.header("diagnostics") or ""), analysis.diagnostics
    plan, seed = analysis.resolved, int(script.header("seed") or 0)
    report = perform(plan, library, seed).report
    steps = list(executed(plan, drawing(seed)))
    teller = Teller(library, report, {library.root.name: plan.start})
    told: dict[int, list[str]] = {}
    for at, step in enumerate(steps, start=1):
        last_line = analysis.source.location(step.span)[2]
        told.setdefault(last_line, []).append(teller.tell(step, is_last=at == len(steps)))
    assert teller.now == report["n_frames"]
    return told


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: str(path.relative_to(FOLDER).with_suffix("")))
def test_a_script_chooses_what_is_written_beside_it(path, reference_library, request):
    script = Script(path)
    told = told_of(script, reference_library)
    if request.config.getoption("update_golden"):
        path.write_text(script.with_claims(told), encoding="utf-8")
    else:
        assert script.claims == told


def test_there_are_forty():
    assert len(SCRIPTS) >= 40
