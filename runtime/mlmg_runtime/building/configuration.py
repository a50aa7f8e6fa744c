"""The configuration of a library: one TOML file, read and checked, each mistake told with its line."""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NoReturn

from mlmg_runtime.building.toml_files import TomlFile, did_you_mean, read_toml
from mlmg_runtime.building.toml_lines import KeyPath
from mlmg_runtime.errors import ConfigurationError

_LINE_BREAK = re.compile("[\r\n]")

DEFAULT_WINDOW = 20
_BELOW = "sub"
METRICS = ("point-cloud",)
BLENDS = ("c1", "linear")


@dataclass(frozen=True, slots=True)
class ClipSource:
    """Where a motion comes from: a BVH file, and which of its frames (last + 1; None: all)."""

    name: str
    path: Path
    line: int | None
    frames: tuple[int, int] | None = None
    mirror: bool = False


@dataclass(frozen=True, slots=True)
class Threshold:
    """How alike two windows must be for a transition.

    `kind` is "auto", "number" (`value` is the largest point-cloud distance, squared length units) or "quantile"
    (`value` is the share of all window pairs that lie below it).
    """

    kind: str
    value: float = 0.0


@dataclass(frozen=True, slots=True)
class GraphConfiguration:
    """One motion graph: its joints (None: the whole skeleton), its motions in order with their tags, its settings."""

    name: str
    line: int | None
    joints: tuple[str, ...] | None
    without: tuple[str, ...]
    window: int
    threshold: Threshold
    metric: str
    blend: str
    weights: Mapping[str, float]
    motions: Mapping[str, tuple[str, ...]]
    forbidden: frozenset[tuple[str, str]] = frozenset()


@dataclass(frozen=True, slots=True)
class LibraryConfiguration:
    """A checked configuration; motions are in the order that decides ties.

    Attributes
    ----------
    frame_rate : None for the first clip's.
    left_out : the names of clips that are on no graph, and so are no motions of the library.
    """

    path: Path
    clips: tuple[ClipSource, ...]
    frame_rate: float | None
    up: str
    start: str | None
    graphs: tuple[GraphConfiguration, ...]
    lines: Mapping[KeyPath, int] = field(default_factory=dict, repr=False)
    left_out: tuple[str, ...] = ()


def read_configuration(path: Path) -> LibraryConfiguration:
    """Read a library's TOML file.

    Raises
    ------
    ConfigurationError
        With the line, if the file is not TOML, a key is unknown or a value is not what it must be.
    OSError
        If the file cannot be opened.
    """
    file = read_toml(path)
    return _Reader(file, file.document).library()


def check_start(configuration: LibraryConfiguration, root: GraphConfiguration) -> None:
    """Check that the start motion, if one is named, is on the graph that holds the whole body.

    Raises
    ------
    ConfigurationError
        If it is not.
    """
    start = configuration.start
    if start is not None and start not in root.motions:
        raise ConfigurationError(
            configuration.path,
            configuration.lines.get(("library", "start")),
            f"start `{start}` is not a motion of `{root.name}`{did_you_mean(start, list(root.motions))}",
        )


@dataclass(frozen=True, slots=True)
class _Reader:
    """Takes a parsed document apart; every value that is taken is checked."""

    file: TomlFile
    document: dict[str, Any]

    def library(self) -> LibraryConfiguration:
        self._known(self.document, (), ("library", "clips", "graph", "tags", "groups", "transitions"))
        library = self._table(self.document, ("library",))
        self._known(library, ("library",), ("clips", "frame_rate", "up", "start"))
        clips = self._clips(library)
        names = [clip.name for clip in clips]
        tags = self._tags(names)
        graphs = self._graphs(names, tags)
        self._no_double_meaning(names, graphs)
        graphs = self._with_forbidden(graphs)
        start = self._text(library, ("library", "start"), None)
        motions = {motion for graph in graphs for motion in graph.motions}
        return LibraryConfiguration(
            path=self.file.path,
            clips=tuple(clip for clip in clips if clip.name in motions),
            left_out=tuple(name for name in names if name not in motions),
            frame_rate=self._rate(library, ("library", "frame_rate")),
            up=self._choice(library, ("library", "up"), ("y", "z"), "y"),
            start=None if start is None else _nfc(start),
            graphs=graphs,
            lines=self.file.lines,
        )

    # Clips

    def _clips(self, library: dict[str, Any]) -> list[ClipSource]:
        tables = self._table(self.document, ("clips",))
        named = {_nfc(name): self._clip(name, table) for name, table in tables.items()}
        at: KeyPath = ("library", "clips")
        patterns = self._texts(library, at, () if named else ("*.bvh",))
        found: dict[str, ClipSource] = {}
        for pattern in patterns:
            for path in self._matches(pattern, at):
                name = _nfc(path.stem)
                if name in named:
                    continue
                if name in found and found[name].path.resolve() != path.resolve():
                    self._fail(
                        at,
                        f"two clips are named `{name}`: {found[name].path} and {path}; name one with [clips.NAME]",
                    )
                found.setdefault(name, ClipSource(name, path, self.file.lines.get(at)))
        found.update(named)
        if not found:
            self._fail(at, "no clip is named; expected globs or paths of BVH files")
        return list(found.values())

    def _matches(self, pattern: str, at: KeyPath) -> list[Path]:
        folder = self.file.path.parent
        if not any(character in pattern for character in "*?["):
            path = folder / pattern
            if not path.is_file():
                self._fail(at, f"there is no clip {path}")
            return [path]
        try:
            found = sorted(path for path in folder.glob(pattern) if path.is_file())
        except (ValueError, NotImplementedError):
            found = sorted(path for path in Path(pattern).parent.glob(Path(pattern).name) if path.is_file())
        if not found:
            self._fail(at, f"no clip matches {pattern}; {_what_is_in((folder / pattern).parent)}")
        return found

    def _clip(self, name: str, table: Any) -> ClipSource:
        at: KeyPath = ("clips", name)
        if not isinstance(table, dict):
            self._fail(at, f"[clips.{name}] must be a table with the keys file, frames, mirror")
        self._known(table, at, ("file", "frames", "mirror"))
        path = self.file.path.parent / str(self._text(table, (*at, "file"), f"{name}.bvh"))
        if not path.is_file():
            self._fail((*at, "file") if "file" in table else at, f"there is no clip {path}")
        mirror = table.get("mirror", False)
        if not isinstance(mirror, bool):
            self._fail((*at, "mirror"), f"mirror must be true or false, found {mirror!r}")
        return ClipSource(_nfc(name), path, self.file.lines.get(at), self._frames(table, at), mirror)

    def _frames(self, table: dict[str, Any], at: KeyPath) -> tuple[int, int] | None:
        frames = table.get("frames")
        if frames is None:
            return None
        if not (
            isinstance(frames, list)
            and len(frames) == 2
            and all(type(f) is int for f in frames)
            and 0 <= frames[0] < frames[1]
        ):
            self._fail(
                (*at, "frames"),
                f"frames must be [first, last + 1] with 0 <= first < last + 1, found {frames!r}",
            )
        return frames[0], frames[1]

    # Graphs and tags

    def _graphs(self, names: list[str], tags: dict[str, dict[str, tuple[str, ...]]]) -> tuple[GraphConfiguration, ...]:
        tables = self.document.get("graph", [{"name": "Full-Body"}])
        if not isinstance(tables, list) or not tables or not all(isinstance(table, dict) for table in tables):
            self._fail(("graph",), "graphs are written as [[graph]] tables, one a graph")
        graphs = tuple(self._graph(index, table, names, tags) for index, table in enumerate(tables))
        graph_names = [graph.name for graph in graphs]
        for index, graph in enumerate(graphs):
            if graph.name in graph_names[:index]:
                self._fail(("graph", index), f"two graphs are named `{graph.name}`")
        for name in tags:
            if name not in graph_names:
                self._fail(("tags", name), f"[tags.{name}] names no graph{did_you_mean(name, graph_names)}")
        return graphs

    def _graph(
        self,
        index: int,
        table: dict[str, Any],
        names: list[str],
        tags: Mapping[str, Mapping[str, tuple[str, ...]]],
    ) -> GraphConfiguration:
        at: KeyPath = ("graph", index)
        keys = ("name", "joints", "without", "window", "threshold", "metric", "weights", "blend", "motions")
        self._known(table, at, keys)
        name = self._text(table, (*at, "name"), None)
        if not name:
            self._fail((*at, "name"), "a graph must have a name")
        if name.casefold() == _BELOW:
            message = f"no graph can be named `{name}`: in a script that word stands for the graph below another"
            self._fail((*at, "name"), message)
        window = table.get("window", DEFAULT_WINDOW)
        if type(window) is not int or not 2 <= window <= 1000:
            self._fail((*at, "window"), f"window must be a number of frames from 2 to 1000, found {window!r}")
        motions = self._choice(table, (*at, "motions"), ("all", "tagged"), "tagged" if name in tags else "all")
        own = tags.get(_nfc(name), {})
        return GraphConfiguration(
            name=_nfc(name),
            line=self.file.lines.get(at),
            joints=self._texts(table, (*at, "joints"), ()) if "joints" in table else None,
            without=self._texts(table, (*at, "without"), ()),
            window=window,
            threshold=self._threshold(table, at),
            metric=self._choice(table, (*at, "metric"), METRICS, METRICS[0]),
            blend=self._choice(table, (*at, "blend"), BLENDS, BLENDS[0]),
            weights=self._weights(table, at),
            motions=dict(own) if motions == "tagged" else {**own, **{m: () for m in names if m not in own}},
        )

    def _threshold(self, table: dict[str, Any], at: KeyPath) -> Threshold:
        value = table.get("threshold", "auto")
        if value == "auto":
            return Threshold("auto")
        if (
            isinstance(value, dict)
            and list(value) == ["quantile"]
            and _is_number(value["quantile"])
            and 0 < value["quantile"] <= 1
        ):
            return Threshold("quantile", float(value["quantile"]))
        if _is_number(value) and value > 0:
            return Threshold("number", float(value))
        self._fail(
            (*at, "threshold"),
            f'threshold must be "auto", a number above 0 or {{ quantile = 0.01 }}, found {value!r}',
        )

    def _weights(self, table: dict[str, Any], at: KeyPath) -> dict[str, float]:
        weights = table.get("weights", {})
        if not isinstance(weights, dict) or not all(_is_number(weight) and weight >= 0 for weight in weights.values()):
            self._fail(
                (*at, "weights"),
                f"weights must be a table of joint = number, none below 0, found {weights!r}",
            )
        return {joint: float(weight) for joint, weight in weights.items()}

    def _tags(self, names: list[str]) -> dict[str, dict[str, tuple[str, ...]]]:
        """Return graph -> motion -> tags; motions keep the order of their entries."""
        found: dict[str, dict[str, tuple[str, ...]]] = {}
        for graph, table in self._table(self.document, ("tags",)).items():
            if not isinstance(table, dict):
                self._fail(("tags", graph), f"[tags.{graph}] must be a table of motion = [tags]")
            found[_nfc(graph)] = {}
            for motion in table:
                at: KeyPath = ("tags", graph, motion)
                if _nfc(motion) not in names:
                    self._fail(at, f"there is no clip `{motion}`{did_you_mean(motion, names)}")
                found[_nfc(graph)][_nfc(motion)] = tuple(map(_nfc, self._texts(table, at, ())))
        return found

    def _no_double_meaning(self, names: list[str], graphs: tuple[GraphConfiguration, ...]) -> None:
        graph_names = {graph.name for graph in graphs}
        for name in names:
            if name in graph_names:
                self._fail(("clips", name), f"`{name}` is a clip and a graph; a name can mean one thing only")
        for index, graph in enumerate(graphs):
            if not graph.motions:
                at: KeyPath = ("tags", graph.name)
                self._fail(
                    at if at in self.file.lines else ("graph", index),
                    f"the graph `{graph.name}` has no motion; give it clips under [tags.{graph.name}]",
                )
            for motion, tags in graph.motions.items():
                for tag in tags:
                    if tag in names or tag in graph_names:
                        what = "clip" if tag in names else "graph"
                        self._fail(
                            ("tags", graph.name, motion),
                            f"the tag `{tag}` is spelt like a {what}; a name can mean one thing only",
                        )
                    if not tag:
                        self._fail(("tags", graph.name, motion), "a tag must not be empty")
                    if _LINE_BREAK.search(tag):
                        self._fail(("tags", graph.name, motion), f"a tag must stand on one line, found {tag!r}")

    # Groups and transitions

    def _with_forbidden(self, graphs: tuple[GraphConfiguration, ...]) -> tuple[GraphConfiguration, ...]:
        groups = self._groups(graphs)
        entries = self.document.get("transitions", [])
        if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
            self._fail(("transitions",), "rules for transitions are written as [[transitions]] tables")
        forbidden: dict[str, set[tuple[str, str]]] = {graph.name: set() for graph in graphs}
        for index, entry in enumerate(entries):
            at: KeyPath = ("transitions", index)
            self._known(entry, at, ("graph", "forbid", "allow"))
            name = self._choice(entry, (*at, "graph"), tuple(forbidden), _whole(graphs).name)
            graph = next(graph for graph in graphs if graph.name == name)
            forbidden[name] |= self._pairs(entry, (*at, "forbid"), graph, groups)
            if "allow" in entry:
                everything = {(a, b) for a in graph.motions for b in graph.motions if a != b}
                forbidden[name] |= everything - self._pairs(entry, (*at, "allow"), graph, groups)
        return tuple(_replace_forbidden(graph, frozenset(forbidden[graph.name])) for graph in graphs)

    def _groups(self, graphs: tuple[GraphConfiguration, ...]) -> dict[str, tuple[str, ...]]:
        """Return the members of each group: names of motions, tags and groups."""
        table = self._table(self.document, ("groups",))
        groups = {_nfc(name): tuple(map(_nfc, self._texts(table, ("groups", name), ()))) for name in table}
        motions = {motion for graph in graphs for motion in graph.motions}
        tags = {tag for graph in graphs for own in graph.motions.values() for tag in own}
        for name, members in groups.items():
            at: KeyPath = ("groups", name)
            if name in motions | tags:
                what = "motion" if name in motions else "tag"
                self._fail(at, f"the group `{name}` is spelt like a {what}; a name can mean one thing only")
            for member in members:
                if member not in motions | tags | groups.keys():
                    near = did_you_mean(member, sorted(motions | tags | groups.keys()))
                    self._fail(at, f"the group `{name}` names `{member}`, which is no motion, tag or group{near}")
        for name in groups:
            if name in _inside(name, groups):
                self._fail(("groups", name), f"the group `{name}` is a member of itself")
        return groups

    def _pairs(
        self, entry: dict[str, Any], at: KeyPath, graph: GraphConfiguration, groups: Mapping[str, tuple[str, ...]]
    ) -> set[tuple[str, str]]:
        pairs = entry.get(str(at[-1]), [])
        if not isinstance(pairs, list) or not all(isinstance(pair, list) and len(pair) == 2 for pair in pairs):
            self._fail(at, f"{at[-1]} must be a list of [from, to] pairs, found {pairs!r}")
        found: set[tuple[str, str]] = set()
        for source, target in pairs:
            sources, targets = (self._members(str(name), at, graph, groups) for name in (source, target))
            found |= {(a, b) for a in sources for b in targets}
        return found

    def _members(
        self,
        name: str,
        at: KeyPath,
        graph: GraphConfiguration,
        groups: Mapping[str, tuple[str, ...]],
    ) -> set[str]:
        name = _nfc(name)
        if name in graph.motions:
            return {name}
        tagged = {motion for motion, tags in graph.motions.items() if name in tags}
        if tagged:
            return tagged
        if name in groups:
            return set().union(*(self._members(member, at, graph, groups) for member in groups[name]))
        known = [*graph.motions, *{tag for tags in graph.motions.values() for tag in tags}, *groups]
        self._fail(at, f"`{name}` is no motion or tag of `{graph.name}` and no group{did_you_mean(name, known)}")

    # Values

    def _known(self, table: dict[str, Any], at: KeyPath, keys: Iterable[str]) -> None:
        self.file.check_keys(table, at, keys)

    def _table(self, parent: dict[str, Any], at: KeyPath) -> dict[str, Any]:
        value = parent.get(str(at[-1]), {})
        if not isinstance(value, dict):
            self._fail(at, f"{at[-1]} must be a table, found {value!r}")
        return value

    def _text(self, table: dict[str, Any], at: KeyPath, default: str | None) -> str | None:
        value = table.get(str(at[-1]), default)
        if value is not None and not isinstance(value, str):
            self._fail(at, f"{at[-1]} must be a text, found {value!r}")
        return value

    def _texts(self, table: dict[str, Any], at: KeyPath, default: tuple[str, ...]) -> tuple[str, ...]:
        value = table.get(str(at[-1]), list(default))
        if isinstance(value, str):
            self._fail(at, f'{at[-1]} must be a list of texts, as in ["{value}"], found a text alone')
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            self._fail(at, f"{at[-1]} must be a list of texts, found {value!r}")
        return tuple(value)

    def _choice(self, table: dict[str, Any], at: KeyPath, choices: tuple[str, ...], default: str) -> str:
        value = self._text(table, at, default)
        if value not in choices:
            self._fail(at, f"{at[-1]} must be one of {', '.join(choices)}, found {value!r}")
        return str(value)

    def _rate(self, table: dict[str, Any], at: KeyPath) -> float | None:
        value = table.get(str(at[-1]))
        if value is not None and not (_is_number(value) and 1 <= value <= 10000):
            self._fail(at, f"{at[-1]} must be a number from 1 to 10000, found {value!r}")
        return None if value is None else float(value)

    def _fail(self, at: KeyPath, message: str) -> NoReturn:
        self.file.fail(at, message)


def _inside(name: str, groups: Mapping[str, tuple[str, ...]]) -> set[str]:
    """Return the members of a group, and theirs, however deep."""
    found: set[str] = set()
    waiting = list(groups[name])
    while waiting:
        member = waiting.pop()
        if member not in found:
            found.add(member)
            waiting += groups.get(member, ())
    return found


def _what_is_in(folder: Path) -> str:
    """Return what there is instead of the clips that a pattern should match."""
    if any(character in str(folder) for character in "*?["):
        return "expected BVH files"
    if not folder.is_dir():
        missing = next(path for path in (*reversed(folder.parents), folder) if not path.is_dir())
        near = did_you_mean(missing.name, (path.name for path in missing.parent.iterdir() if path.is_dir()))
        return f"there is no folder {missing}{near}"
    files = sorted(path.name for path in folder.iterdir() if path.suffix.lower() == ".bvh")
    return f"{folder} has no BVH file" if not files else f"{folder} has {len(files)} BVH files, such as {files[0]}"


def _whole(graphs: tuple[GraphConfiguration, ...]) -> GraphConfiguration:
    """Return the graph that is written as the whole body: the first that names no joints, or else the first."""
    return next((graph for graph in graphs if graph.joints is None and not graph.without), graphs[0])


def _replace_forbidden(graph: GraphConfiguration, forbidden: frozenset[tuple[str, str]]) -> GraphConfiguration:
    return replace(graph, forbidden=forbidden)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _nfc(name: str) -> str:
    return unicodedata.normalize("NFC", name)
