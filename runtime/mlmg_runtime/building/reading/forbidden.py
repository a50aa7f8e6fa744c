"""Which transitions a configuration forbids, between motions, tags and groups of these."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from mlmg_runtime.building.configuration import GraphConfiguration
from mlmg_runtime.building.reading.table import Table, composed
from mlmg_runtime.building.toml_files import did_you_mean

_Groups = Mapping[str, tuple[str, ...]]


def with_forbidden(document: Table, graphs: Sequence[GraphConfiguration]) -> tuple[GraphConfiguration, ...]:
    """Return the graphs without the transitions that `[[transitions]]` forbids or does not allow."""
    groups = _read_groups(document, graphs)
    forbidden: dict[str, set[tuple[str, str]]] = {graph.name: set() for graph in graphs}
    for entry in document.tables("transitions", [], "rules for transitions are written as [[transitions]] tables"):
        entry.expect_keys("graph", "forbid", "allow")
        name = entry.choice("graph", tuple(forbidden), _whole(graphs).name)
        graph = next(graph for graph in graphs if graph.name == name)
        forbidden[name] |= _pairs(entry, "forbid", graph, groups)
        if "allow" in entry:
            everything = {(a, b) for a in graph.motions for b in graph.motions if a != b}
            forbidden[name] |= everything - _pairs(entry, "allow", graph, groups)
    return tuple(replace(graph, forbidden=frozenset(forbidden[graph.name])) for graph in graphs)


def _read_groups(document: Table, graphs: Sequence[GraphConfiguration]) -> _Groups:
    """Return the members of each group: names of motions, tags and groups."""
    table = document.table("groups")
    groups = {composed(name): tuple(map(composed, table.texts(name))) for name in table}
    motions = {motion for graph in graphs for motion in graph.motions}
    tags = {tag for graph in graphs for own in graph.motions.values() for tag in own}
    for name, members in groups.items():
        if name in motions | tags:
            what = "motion" if name in motions else "tag"
            table.fail(f"the group `{name}` is spelt like a {what}; a name can mean one thing only", name)
        for member in members:
            if member not in motions | tags | groups.keys():
                near = did_you_mean(member, sorted(motions | tags | groups.keys()))
                table.fail(f"the group `{name}` names `{member}`, which is no motion, tag or group{near}", name)
    for name in groups:
        if name in _inside(name, groups):
            table.fail(f"the group `{name}` is a member of itself", name)
    return groups


def _pairs(entry: Table, key: str, graph: GraphConfiguration, groups: _Groups) -> set[tuple[str, str]]:
    pairs = entry.get(key, [])
    if not isinstance(pairs, list) or not all(isinstance(pair, list) and len(pair) == 2 for pair in pairs):
        entry.fail(f"{key} must be a list of [from, to] pairs, found {pairs!r}", key)
    found: set[tuple[str, str]] = set()
    for pair in pairs:
        sources, targets = (_members(entry, key, composed(str(name)), graph, groups) for name in pair)
        found |= {(source, target) for source in sources for target in targets}
    return found


def _members(entry: Table, key: str, name: str, graph: GraphConfiguration, groups: _Groups) -> set[str]:
    """Return the motions that a name stands for on a graph."""
    if name in graph.motions:
        return {name}
    tagged = {motion for motion, tags in graph.motions.items() if name in tags}
    if tagged:
        return tagged
    if name in groups:
        return set().union(*(_members(entry, key, member, graph, groups) for member in groups[name]))
    known = [*graph.motions, *{tag for tags in graph.motions.values() for tag in tags}, *groups]
    entry.fail(f"`{name}` is no motion or tag of `{graph.name}` and no group{did_you_mean(name, known)}", key)


def _inside(name: str, groups: _Groups) -> set[str]:
    """Return the members of a group, and theirs, however deep."""
    found: set[str] = set()
    waiting = list(groups[name])
    while waiting:
        member = waiting.pop()
        if member not in found:
            found.add(member)
            waiting += groups.get(member, ())
    return found


def _whole(graphs: Sequence[GraphConfiguration]) -> GraphConfiguration:
    """Return the graph that is written as the whole body: the first that names no joints, or else the first."""
    return next((graph for graph in graphs if graph.joints is None and not graph.without), graphs[0])
