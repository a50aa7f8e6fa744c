"""An expression that stands for nothing -> the reason, as one who knows the library would tell it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.structure import group_of
from mlmg_lang.planning.names import Entry, Kind, Names
from mlmg_lang.source import Source
from mlmg_lang.spelling import joined, listed, some


@dataclass(frozen=True, slots=True)
class Room:
    """The graphs that a command leaves to one of its operands.

    Attributes
    ----------
    taken : the graphs that the command has named or found so far.
    tops : the topmost of those left of this operand's `with`, which it has to be below; none before it.
    last : the graph last named or found.
    """

    taken: tuple[str, ...] = ()
    tops: tuple[str, ...] = ()
    last: str | None = None

    def allowed(self, names: Names) -> tuple[str, ...]:
        """Return the graphs that are left, nearest first."""
        graphs = names.below(self.tops) if self.tops else names.all_levels()
        return tuple(graph for graph in graphs if graph not in self.taken)


def nothing_found(
    motion: syntax.Motion, tried: Sequence[str], room: Room, names: Names, source: Source, *, chosen: bool
) -> Diagnostic:
    """Say why an expression is empty on all graphs tried; `chosen`: the script names the graph."""
    find = names.find if chosen else names.find_unqualified
    for name in _wanted(motion):
        if not any(find(graph, name.text) for graph in tried):
            return _not_on(name, motion, tried, room, names) if chosen else _out_of_room(name, room, names)
    return _no_combination(motion, tried if chosen else (), source)


def several_graphs(motion: syntax.Motion, written: Sequence[syntax.Name]) -> Diagnostic:
    """Say that the parts of one set of motions are said to be on different graphs."""
    names = listed(dict.fromkeys(name.text for name in written))
    message = f"this is one set of motions, but its parts are on {names}"
    return Diagnostic("MS035", message, motion.span, "what different graphs do at once is joined by `with` or `and`")


def sub_leads_nowhere(name: syntax.Name, room: Room, names: Names) -> Diagnostic:
    """Say that there is no graph below the last one."""
    lowest = room.last or names.root
    message = f"`{name.text}` is the graph below `{lowest}`, and there is none"
    return Diagnostic("MS033", message, name.span, f"the graphs are {listed(names.graphs)}")


def wrong_graph(name: syntax.Name, graph: str, room: Room, names: Names) -> Diagnostic:
    """Say why the command leaves no room on a graph that it names."""
    if graph in room.taken:
        message = f"this command says twice what `{graph}` does"
        advice = f"join the two by `and` or `or`, as in `{script_name(graph)} (A or B)`"
        return Diagnostic("MS031", message, name.span, advice)
    tops = listed(room.tops)
    message = f"`{graph}` is not below {tops}"
    if any(graph in names.ancestors(top) for top in room.tops):
        return Diagnostic("MS030", message, name.span, f"write the higher graph first: `{graph}` stands above {tops}")
    advice = f"parts beside each other are joined by `and`, or both by `with` to one above, as `{names.root}`"
    return Diagnostic("MS030", message, name.span, advice)


def _wanted(motion: syntax.Motion) -> Iterator[syntax.Name]:
    """Yield the names that an expression asks for: not those that it excludes."""
    match motion:
        case syntax.Reference(name):
            yield name
        case syntax.Qualified(_, inner) | syntax.Group(inner):
            yield from _wanted(inner)
        case syntax.And(operands) | syntax.Or(operands):
            for operand in operands:
                yield from _wanted(operand)
        case syntax.Call():
            group = group_of(motion)
            if group is not None:
                yield from _wanted(group)


# --- a name that is elsewhere ---


def _not_on(name: syntax.Name, motion: syntax.Motion, tried: Sequence[str], room: Room, names: Names) -> Diagnostic:
    """Say that a name means nothing on the graph that was named, and what it means on others."""
    entry = _elsewhere(name, names)
    graphs = listed(tried, "or")
    places = names.places(name.text)
    message = f"{_kind(entry)} `{entry.name}` is not on {graphs}"
    advice = f"it is on {listed(places)}"
    tags = _tags_of(entry, tried[0], names) if entry.kind is Kind.TAG else ()
    if tags:
        advice += f"; the same motions are {listed(tags)} on `{tried[0]}`"
    fixes = [Fix(name.span, script_name(tag), safe=False) for tag in tags]
    if isinstance(motion, syntax.Qualified) and motion.motion.span == name.span and name.span.end == motion.span.end:
        free = (graph for graph in room.allowed(names) if graph in places)
        fixes += [Fix(motion.span, f"{script_name(graph)} {script_name(entry.name)}", safe=False) for graph in free]
    if not fixes and (near := names.nearest(name.text, tried[:1])):
        advice += f"; on `{tried[0]}` there is `{near[0]}`"
        fixes.append(Fix(name.span, script_name(near[0]), safe=False))
    return Diagnostic("MS022", message, name.span, advice, fixes=tuple(fixes))


def _elsewhere(name: syntax.Name, names: Names) -> Entry:
    """Return what a name means on the first graph on which it means something."""
    for graph in names.places(name.text):
        match = names.find_unqualified(graph, name.text)
        if match is not None:
            return match.entry
    raise AssertionError("binding lets no unknown name through")


def _kind(entry: Entry) -> str:
    return "tag" if entry.kind is Kind.TAG else "motion"


def _tags_of(entry: Entry, graph: str, names: Names) -> tuple[str, ...]:
    """Return the tags on a graph of the motions that an entry stands for elsewhere."""
    found = []
    for word in names.spellings_on(graph):
        match = names.find(graph, word)
        if match and match.entry.kind is Kind.TAG and set(match.entry.motions) & set(entry.motions):
            found.append(word)
    return tuple(found)


def _out_of_room(name: syntax.Name, room: Room, names: Names) -> Diagnostic:
    """Say that a name means something only on graphs that the command does not leave to it."""
    entry = _elsewhere(name, names)
    places = names.places(name.text)
    tops = listed(room.tops or (names.root,))
    if not names.below(room.tops):
        message = f"there is no graph below {tops} to do this"
        return Diagnostic("MS030", message, name.span, f"{_kind(entry)} `{entry.name}` is on {listed(places)}")
    where = f"{_kind(entry)} `{entry.name}` is on {listed(places)} alone"
    if set(places) <= set(room.taken):
        message = f"{where}, and the command has said already what {'that does' if len(places) == 1 else 'they do'}"
        return Diagnostic("MS031", message, name.span, "each graph is named once in a command")
    message = f"{where}, which is not below {tops}" if len(places) == 1 else f"{where}, none of them free below {tops}"
    left = joined((f"`{graph}`" for graph in room.allowed(names)), "or") if room.allowed(names) else "nothing"
    return Diagnostic("MS030", message, name.span, f"what comes after `with` is on {left} here")


# --- a combination that is nowhere ---


def _no_combination(motion: syntax.Motion, chosen: Sequence[str], source: Source) -> Diagnostic:
    place = f" on {listed(chosen)}" if chosen else ""
    if isinstance(motion, syntax.And):
        parts = [source.slice(operand.span) for operand in motion.operands]
        message = f"nothing{place} has {'both ' if len(parts) == 2 else ''}{some(parts)}"
        advice = "nor can they be shared out over different graphs"
        if chosen:
            advice = "`or` instead of `and` takes what has either" if len(parts) == 2 else "`or` takes what has any"
        return Diagnostic("MS032", message, motion.span, advice)
    inner = next((node for node in syntax.walk(motion) if isinstance(node, syntax.And)), None)
    if inner is not None and not isinstance(motion, syntax.Not):
        return _no_combination(inner, chosen, source)
    return Diagnostic("MS032", f"no motion{place or ' of any graph'} is left by this", motion.span)
