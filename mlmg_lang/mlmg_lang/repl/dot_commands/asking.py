"""Commands that ask: what is in the library, what is playing, what has been played."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from mlmg_lang.explaining.tree import table
from mlmg_lang.explaining.wording import fit_number
from mlmg_lang.planning.names import Kind, Names
from mlmg_lang.rendering.wording import harmless
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.reply import Refusal, Reply
from mlmg_lang.spelling import listed, nearest
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph

_COUNTS = ("joints", "motions", "tags", "transitions")


def graphs(desk: Desk, _argument: str) -> Reply:
    """Tell of the graphs: what each is below, and how much is on it."""
    library = desk.session.library
    rows = [_graph_data(own) for own in library.by_name.values()]
    told: list[tuple[str, ...]] = [("graph", "below", *_COUNTS)]
    told += [(row["graph"], row["below"] or "-", *(str(row[key]) for key in _COUNTS)) for row in rows]
    return Reply(_lines(table(told)), {"graphs": rows})


def _graph_data(own: MotionGraph) -> dict[str, Any]:
    tags = {tag for of_motion in own.tags.values() for tag in of_motion}
    return {
        "graph": own.name,
        "below": own.parent,
        "joints": len(own.joints),
        "motions": len(own.motions),
        "tags": len(tags),
        "transitions": len(own.transitions),
    }


def motions(desk: Desk, argument: str) -> Reply:
    """Tell of the motions of a graph: how long each is, and its tags."""
    library, graph = desk.session.library, _graph(desk, argument)
    own = library.by_name[graph]
    rows: list[dict[str, Any]] = [
        {
            "motion": name,
            "seconds": round(int(n) / library.frame_rate, 3),
            "frames": int(n),
            "tags": list(own.tags[name]),
        }
        for name, n in zip(own.motions, own.n_frames, strict=True)
    ]
    told = [(f"on {graph}", "seconds", "frames", "tags")]
    told += [(r["motion"], f"{r['seconds']:.1f}", str(r["frames"]), ", ".join(r["tags"])) for r in rows]
    return Reply(_lines(table(told)), {"graph": graph, "motions": rows})


def tags(desk: Desk, argument: str) -> Reply:
    """Tell of the tags of a graph: which motions have each."""
    graph = _graph(desk, argument)
    entries = [entry for entry in desk.session.names.entries(graph) if entry.kind is Kind.TAG]
    told = [(f"on {graph}", "motions"), *((entry.name, ", ".join(entry.motions)) for entry in entries)]
    text = _lines(table(told)) if entries else f"no motion on {graph} has a tag\n"
    return Reply(text, {"graph": graph, "tags": {entry.name: list(entry.motions) for entry in entries}})


def oms(desk: Desk, argument: str) -> Reply:
    """Tell, for each graph that a motion is on, which motions could stand in for it: the most alike first."""
    library, motion = desk.session.library, _motion(desk, argument)
    told: list[str] = []
    data: dict[str, list[dict[str, Any]]] = {}
    for graph, own in library.by_name.items():
        if motion in own.index:
            data[graph] = _alike(library, graph, motion)
            rows = [(r["motion"], fit_number(r["oms"]), f"{r['of_usual']:.2f} of usual") for r in data[graph]]
            told += [f"on {graph}, like {motion}:", *(f"  {line}" for line in table(rows))]
    return Reply(_lines(told), {"motion": motion, "oms": data})


def _alike(library: Library, graph: str, motion: str) -> list[dict[str, Any]]:
    own = library.by_name[graph]
    others = [other for other in own.motions if other != motion]
    value = {other: float(own.oms[own.index[motion], own.index[other]]) for other in others}
    return [
        {"motion": other, "oms": round(value[other], 6), "of_usual": round(library.unlikeness(graph, motion, other), 3)}
        for other in sorted(others, key=value.__getitem__)
    ]


def state(desk: Desk, _argument: str) -> Reply:
    """Tell what is playing on each graph, and where the conversation stands."""
    session = desk.session
    playing = {one.graph: one for one in session.playing}
    rows = []
    for graph in session.library.graphs:
        one = playing.get(graph)
        rows.append((graph, f"{one.motion}, frame {one.frame}" if one else "goes with the body"))
    told = [
        *table(rows),
        f"{session.n_seconds:.1f} s of motion, started in {session.starts_in}, seed {session.seed}",
        f"library {session.library.path.name}, {'unsaved' if desk.unsaved else 'nothing unsaved'}",
    ]
    data = {
        "playing": {one.graph: {"motion": one.motion, "frame": one.frame} for one in session.playing},
        "seconds": round(session.n_seconds, 3),
        "start": session.starts_in,
        "seed": session.seed,
        "library": str(session.library.path),
        "unsaved": desk.unsaved,
    }
    return Reply(_lines(told), data)


def timeline(desk: Desk, _argument: str) -> Reply:
    """Tell what has been played when: each statement, from its beginning over its arrival to its end."""
    rows: list[tuple[str, ...]] = [("begins", "arrives", "ends", "")]
    data: list[Mapping[str, Any]] = []
    for turn in desk.session.turns:
        for deed in turn.deeds:
            went = deed.went
            arrive = went.begin_s + went.arrived_s
            end = arrive + went.lasted_s
            rows.append((f"{went.begin_s:.1f} s", f"{arrive:.1f} s", f"{end:.1f} s", deed.text))
            data.append({"text": deed.text, "begin": went.begin_s, "arrive": round(arrive, 3), "end": round(end, 3)})
    return Reply(_lines(table(rows)) if data else "nothing has been played yet\n", {"timeline": data})


def _lines(lines: Iterable[str]) -> str:
    return "".join(f"{harmless(line)}\n" for line in lines)


def _graph(desk: Desk, written: str) -> str:
    """Return the graph that an argument names; without one, the root.

    Raises
    ------
    Refusal
        If there is none of that name.
    """
    names = desk.session.names
    if not written:
        return names.root
    found = names.graph(written.strip('"'))
    if found is None:
        raise Refusal(f"there is no graph `{written}`; {_instead(written, names.graphs)}")
    return found


def _motion(desk: Desk, written: str) -> str:
    """Return the motion that an argument names.

    Raises
    ------
    Refusal
        If there is none of that name, or none is named.
    """
    names: Names = desk.session.names
    every = list(dict.fromkeys(motion for graph in names.graphs for motion in names.motions(graph)))
    if not written:
        raise Refusal(f"name a motion, such as `.oms {every[0]}`")
    for graph in names.graphs:
        match = names.find(graph, written.strip('"'))
        if match is not None and match.entry.kind is Kind.MOTION:
            return match.entry.name
    raise Refusal(f"there is no motion `{written}`; {_instead(written, every)}")


def _instead(written: str, known: Sequence[str]) -> str:
    near = nearest(written, known)
    return f"did you mean {listed(near, 'or')}?" if near else "`.motions` and `.graphs` tell what there is"
