"""The graphs of a configuration: their joints, settings, motions and tags."""

from __future__ import annotations

import re
from collections.abc import Container, Mapping, Sequence
from typing import Final

from mlmg_runtime.building.configuration import GraphConfiguration, Threshold
from mlmg_runtime.building.reading.table import Table, composed, is_number
from mlmg_runtime.building.toml_files import did_you_mean
from mlmg_runtime.building.toml_lines import KeyPath

_DEFAULT_WINDOW: Final = 20
_METRICS: Final = ("point-cloud",)
_BLENDS: Final = ("c1", "linear")
_LINE_BREAK: Final = re.compile("[\r\n]")
_BELOW: Final = "sub"
_KEYS: Final = ("name", "joints", "without", "window", "threshold", "metric", "weights", "blend", "motions")
_Tags = Mapping[str, Mapping[str, tuple[str, ...]]]


def read_graphs(document: Table, clips: Sequence[str]) -> tuple[GraphConfiguration, ...]:
    """Return the graphs of `[[graph]]` with the motions of `[tags.GRAPH]`; none forbids a transition yet."""
    message = "graphs are written as [[graph]] tables, one a graph"
    tables = document.tables("graph", [{"name": "Full-Body"}], message)
    if not tables:
        document.fail(message, "graph")
    tags = _tags(document, clips, [str(table.get("name", "Full-Body")) for table in tables])
    graphs = tuple(_graph(table, clips, tags) for table in tables)
    names = [graph.name for graph in graphs]
    for table, name, before in zip(tables, names, range(len(names)), strict=True):
        if name in names[:before]:
            table.fail(f"two graphs are named `{name}`")
    for name in tags:
        if name not in names:
            document.fail(f"[tags.{name}] names no graph{did_you_mean(name, names)}", "tags", name)
    _check_motions(document, graphs)
    _check_meanings(document, clips, graphs)
    return graphs


def _tags(document: Table, clips: Sequence[str], names: Sequence[str]) -> _Tags:
    """Return graph -> motion -> tags; motions keep the order of their entries. `names`: those of the graphs."""
    tables = document.table("tags")
    found: dict[str, dict[str, tuple[str, ...]]] = {}
    for graph in tables:
        if not isinstance(tables.get(graph, None), dict):
            tables.fail(_no_table(graph, clips, names), graph)
        table = tables.table(graph)
        own = found[composed(graph)] = {}
        for motion in table:
            if composed(motion) not in clips:
                table.fail(f"there is no clip `{motion}`{did_you_mean(motion, clips)}", motion)
            own[composed(motion)] = tuple(map(composed, table.texts(motion)))
    return found


def _no_table(key: str, clips: Sequence[str], graphs: Sequence[str]) -> str:
    """Return what to say of a key of `[tags]` that is no table, which may be a clip's."""
    if composed(key) in clips:
        return f"`{key}` is a clip; tags stand under the graph that they are for, as in [tags.{graphs[0]}]"
    return f"[tags.{key}] must be a table of motion = [tags]"


def _graph(table: Table, clips: Sequence[str], tags: _Tags) -> GraphConfiguration:
    table.expect_keys(*_KEYS)
    name = composed(_name(table))
    motions = table.choice("motions", ("all", "tagged"), "tagged" if name in tags else "all")
    own = tags.get(name, {})
    return GraphConfiguration(
        name=name,
        line=table.file.lines.get(table.at),
        joints=table.texts("joints") if "joints" in table else None,
        without=table.texts("without"),
        window=_window(table),
        threshold=_threshold(table),
        metric=table.choice("metric", _METRICS, _METRICS[0]),
        blend=table.choice("blend", _BLENDS, _BLENDS[0]),
        weights=_weights(table),
        motions=dict(own) if motions == "tagged" else {**own, **{clip: () for clip in clips if clip not in own}},
    )


def _name(table: Table) -> str:
    name = table.text("name")
    if not name:
        table.fail("a graph must have a name", "name")
    if name.casefold() == _BELOW:
        message = f"no graph can be named `{name}`: in a script that word stands for the graph below another"
        table.fail(message, "name")
    return name


def _window(table: Table) -> int:
    window = table.get("window", _DEFAULT_WINDOW)
    if type(window) is not int or not 2 <= window <= 1000:
        table.fail(f"window must be a number of frames from 2 to 1000, found {window!r}", "window")
    return window


def _threshold(table: Table) -> Threshold:
    value = table.get("threshold", "auto")
    if value == "auto":
        return Threshold("auto")
    if isinstance(value, dict) and list(value) == ["quantile"]:
        share = value["quantile"]
        if is_number(share) and 0 < share <= 1:
            return Threshold("quantile", float(share))
    elif is_number(value) and value > 0:
        return Threshold("number", float(value))
    message = f'threshold must be "auto", a number above 0 or {{ quantile = 0.01 }}, found {value!r}'
    table.fail(message, "threshold")


def _weights(table: Table) -> dict[str, float]:
    weights = table.get("weights", {})
    if not isinstance(weights, dict) or not all(is_number(weight) and weight >= 0 for weight in weights.values()):
        table.fail(f"weights must be a table of joint = number, none below 0, found {weights!r}", "weights")
    return {joint: float(weight) for joint, weight in weights.items()}


def _check_motions(document: Table, graphs: Sequence[GraphConfiguration]) -> None:
    for index, graph in enumerate(graphs):
        if not graph.motions:
            at = ("tags", graph.name) if ("tags", graph.name) in document.file.lines else ("graph", index)
            message = f"the graph `{graph.name}` has no motion; give it clips under [tags.{graph.name}]"
            document.fail(message, *at)


def _check_meanings(document: Table, clips: Sequence[str], graphs: Sequence[GraphConfiguration]) -> None:
    """Check that no name means two things, and that tags can be written in a script."""
    names = {graph.name for graph in graphs}
    for clip in clips:
        if clip in names:
            document.fail(f"`{clip}` is a clip and a graph; a name can mean one thing only", "clips", clip)
    for graph in graphs:
        for motion, tags in graph.motions.items():
            for tag in tags:
                _check_tag(tag, document, ("tags", graph.name, motion), clips, names)


def _check_tag(tag: str, document: Table, at: KeyPath, clips: Sequence[str], graphs: Container[str]) -> None:
    if tag in clips or tag in graphs:
        what = "clip" if tag in clips else "graph"
        document.fail(f"the tag `{tag}` is spelt like a {what}; a name can mean one thing only", *at)
    if not tag:
        document.fail("a tag must not be empty", *at)
    if _LINE_BREAK.search(tag):
        document.fail(f"a tag must stand on one line, found {tag!r}", *at)
