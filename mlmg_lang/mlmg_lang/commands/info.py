"""Tells what is in a built library: graphs, motions, tags, transitions, and what was lost.

examples:
  mlmg info my.mlmg
  mlmg info my.mlmg --json
  mlmg info my.mlmg --transitions Full-Body > transitions.csv
"""

from __future__ import annotations

import argparse
import csv
import json
import sys
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

from mlmg_lang.commands.console import DONE
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.spelling import counted

if TYPE_CHECKING:
    from mlmg_runtime.library import Library


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("library", metavar="L.mlmg", nargs="?", help="a library; demo, or nothing, is the demo library")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--json", action="store_true", help="everything as JSON")
    what.add_argument("--transitions", metavar="GRAPH", help="the transitions of a graph as CSV")
    what.add_argument("--oms", metavar="GRAPH", help="the overall motion similarities of a graph as CSV")
    what.add_argument("--motions", metavar="GRAPH", help="the motions of a graph, and their tags, as CSV")


def run(arguments: argparse.Namespace) -> int:
    """Print what is asked for."""
    from mlmg_lang.commands.demo import demo_path, named_library
    from mlmg_runtime.library import open_library

    library = open_library(named_library("-", arguments.library) or demo_path())
    for rows, graph in (
        (_transitions, arguments.transitions),
        (_oms, arguments.oms),
        (_motions, arguments.motions),
    ):
        if graph is not None:
            csv.writer(sys.stdout, lineterminator="\n").writerows(rows(library, _graph(library, graph)))
            return DONE
    description = _description(library)
    if arguments.json:
        json.dump(description, sys.stdout, ensure_ascii=False, indent=1)
        print()
    else:
        print("\n".join(_lines(description)))
    return DONE


def _graph(library: Library, name: str) -> str:
    """Return the graph that a name means, as in scripts."""
    from mlmg_lang.planning.names import Names
    from mlmg_runtime.errors import LibraryError

    meant = Names(library).graph(name)
    if meant is None:
        raise LibraryError(library.path, None, f"there is no graph `{name}`; there are {', '.join(library.graphs)}")
    return meant


def _transitions(library: Library, graph: str) -> Iterator[Iterable[object]]:
    own = library.by_name[graph]
    yield "src_motion", "src_frame", "dst_motion", "dst_frame", "distance", "cost"
    for edge in own.edges:
        yield (
            own.motions[edge.src_motion],
            edge.src_frame,
            own.motions[edge.dst_motion],
            edge.dst_frame,
            edge.distance,
            edge.cost,
        )


def _oms(library: Library, graph: str) -> Iterator[Iterable[object]]:
    own = library.by_name[graph]
    yield "a", "b", "oms"
    for row, a in enumerate(own.motions):
        for column, b in enumerate(own.motions):
            yield a, b, float(own.oms[row, column])


def _motions(library: Library, graph: str) -> Iterator[Iterable[object]]:
    yield "motion", "n_frames", "seconds", "tags"
    for motion in library.motions(graph):
        n_frames = library.n_frames(motion)
        yield (
            motion,
            n_frames,
            round(n_frames / library.frame_rate, 3),
            " ".join(map(script_name, library.tags(graph, motion))),
        )


def _description(library: Library) -> dict[str, Any]:
    clips = dict.fromkeys(motion for graph in library.graphs for motion in library.motions(graph))
    return {
        "library": str(library.path),
        "bytes": library.path.stat().st_size,
        "frame_rate": library.frame_rate,
        "up": library.up,
        "start": library.start,
        "n_frames": sum(map(library.n_frames, clips)),
        "clips": {clip: library.n_frames(clip) for clip in clips},
        "joints": list(library.skeleton.names),
        "warnings": list(library.warnings),
        "graphs": [_graph_description(library, graph) for graph in library.graphs],
    }


def _graph_description(library: Library, graph: str) -> dict[str, Any]:
    from mlmg_runtime.playing.holding import hardly_held

    own = library.by_name[graph]
    return {
        "name": graph,
        "parent": own.parent,
        "joints": [library.skeleton.names[joint] for joint in own.joints],
        "window": own.window,
        "sigma": own.sigma,
        "blend": own.blend,
        "motions": {motion: list(own.tags[motion]) for motion in own.motions},
        "n_forbidden": int(own.forbidden.sum()),
        "hardly_held": dict(hardly_held(own)),
        **library.reports[graph],
    }


def _lines(description: dict[str, Any]) -> Iterator[str]:
    seconds = description["n_frames"] / description["frame_rate"]
    clips, joints = counted(len(description["clips"]), "clip"), counted(len(description["joints"]), "joint")
    yield (
        f"{description['library']}: {clips}, {counted(description['n_frames'], 'frame')} "
        f"({seconds:.0f} s at {description['frame_rate']:g} fps), {joints}, "
        f"{description['bytes'] / 1e6:.1f} MB; starts in {description['start']}"
    )
    for graph in description["graphs"]:
        yield ""
        yield from _graph_lines(graph, description)


def _graph_lines(graph: dict[str, Any], description: dict[str, Any]) -> Iterator[str]:
    below = f", below {graph['parent']}" if graph["parent"] else ""
    yield (
        f"{graph['name']}{below}: {counted(len(graph['motions']), 'motion')}, "
        f"{counted(graph['n_transitions'], 'transition')} of {counted(graph['n_candidates'], 'candidate')}; "
        f"smooth up to {graph['threshold']:.3g} (RMS over joints)"
    )
    width = max(map(len, graph["motions"]))
    for motion, tags in graph["motions"].items():
        n_frames = description["clips"][motion]
        notes = "".join(f"  {note}" for note in _notes(graph, motion))
        yield f"  {motion:<{width}}  {n_frames / description['frame_rate']:6.1f} s  {', '.join(tags) or '-'}{notes}"
    if graph["n_forbidden"]:
        yield f"  forbidden: {graph['n_forbidden']} of the pairs of motions, to follow each other directly"
    if graph["bridges"]:
        distances = [distance for _, _, distance in graph["bridges"]]
        above = counted(len(distances), "transition")
        yield f"  bridged: {above} above that, {min(distances):.3g} to {max(distances):.3g}"


def _notes(graph: dict[str, Any], motion: str) -> Iterator[str]:
    """Yield what is wrong with a motion on a graph."""
    lost, held = graph["lost_frames"].get(motion), graph["hardly_held"].get(motion)
    if motion in graph["lost_motions"]:
        yield "cannot be led to"
    elif lost:
        yield f"{counted(lost, 'frame')} lost"
    if held is not None:
        yield f"hardly held: shown {held:.0%} of the time"
