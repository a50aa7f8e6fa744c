"""Libraries without clips, and what tests of the language ask and print."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import pytest

from mlmg_lang.front_end import Analysis, analyse
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source, Span

Tags = Mapping[str, tuple[str, ...]]


@dataclass(frozen=True)
class FakeCatalog:
    """A library of nothing but names.

    Attributes
    ----------
    on : by graph, its motions with their tags; the first graph is the root.
    above : by graph, the one above it.
    cut : (graph, source, target) that no walk leads along.
    forbidden : (graph, source, target) that the configuration forbids to go directly; a way round may lead there.
    far : (graph, one, other) -> how unlike, where that is not as usual.
    """

    on: Mapping[str, Tags]
    above: Mapping[str, str]
    start: str = "Idle_01"
    frame_rate: float = 30.0
    cut: frozenset[tuple[str, str, str]] = field(default_factory=frozenset)
    forbidden: frozenset[tuple[str, str, str]] = field(default_factory=frozenset)
    far: Mapping[tuple[str, str, str], float] = field(default_factory=dict)

    @property
    def graphs(self) -> tuple[str, ...]:
        return tuple(self.on)

    def parent(self, graph: str) -> str | None:
        return self.above.get(graph)

    def motions(self, graph: str) -> tuple[str, ...]:
        return tuple(self.on[graph])

    def tags(self, graph: str, motion: str) -> tuple[str, ...]:
        return self.on[graph][motion]

    def can_reach(self, graph: str, source: str, target: str) -> bool:
        assert {source, target} <= set(self.on[graph]), f"a real library has no {source} and {target} on {graph}"
        return (graph, source, target) not in self.cut

    def is_forbidden(self, graph: str, source: str, target: str) -> bool:
        assert {source, target} <= set(self.on[graph]), f"a real library has no {source} and {target} on {graph}"
        return (graph, source, target) in self.forbidden

    def unlikeness(self, graph: str, one: str, other: str) -> float:
        return self.far.get((graph, one, other), 1.0)

    def n_frames(self, motion: str) -> int:
        return 400


FULL_BODY: Tags = {
    "Idle_01": ("IDLE",),
    "Idle_02": ("IDLE",),
    "Walk_01": ("WALK",),
    "Walk_02": ("WALK",),
    "Walk_03": ("WALK", "WAVE_HAND"),
    "Music_01": ("Music", "IDLE"),
    "Talk_01": ("TALK", "IDLE"),
    "Talk_02": ("TALK",),
}
UPPER_BODY: Tags = {
    "Idle_01": ("IDLE",),
    "Walk_01": ("SWING_HAND",),
    "Walk_02": ("SWING_HAND",),
    "Walk_03": ("WAVE_HAND",),
    "Music_01": ("Music", "IDLE"),
    "Talk_01": ("TALK", "IDLE"),
    "Talk_02": ("TALK",),
}
UNTAGGED: Tags = dict.fromkeys(UPPER_BODY, ())

REFERENCE = FakeCatalog({"Full-Body": FULL_BODY, "Upper-Body": UPPER_BODY}, {"Upper-Body": "Full-Body"})
LEFT_HAND = FakeCatalog(
    {"Full-Body": FULL_BODY, "Upper-Body": UPPER_BODY, "Left-Hand": {**UNTAGGED, "Wave_01": ("WAVE",)}},
    {"Upper-Body": "Full-Body", "Left-Hand": "Upper-Body"},
)
HANDS = FakeCatalog(
    {
        "Full-Body": FULL_BODY,
        "Left-Hand": {**UNTAGGED, "Wave_01": ("WAVE",)},
        "Right-Hand": {**UNTAGGED, "Point_01": ("POINT",), "Wave_01": ("WAVE",)},
    },
    {"Left-Hand": "Full-Body", "Right-Hand": "Full-Body"},
)
TWINS = FakeCatalog({"Body": {"Idle_01": (), "Walk_1": (), "WALK1": ()}}, {})
CUT = replace(
    REFERENCE,
    cut=frozenset(
        (graph, source, target)
        for graph in ("Full-Body", "Upper-Body")
        for source in ("Walk_01", "Idle_01")
        for target in ("Talk_01", "Talk_02")
    ),
)
FORBIDS = replace(CUT, forbidden=frozenset({("Full-Body", "Idle_01", "Talk_01"), ("Full-Body", "Idle_01", "Talk_02")}))
LIBRARIES: Mapping[str, FakeCatalog | None] = {
    "none": None,
    "reference": REFERENCE,
    "left-hand": LEFT_HAND,
    "hands": HANDS,
    "twins": TWINS,
    "cut": CUT,
    "forbids": FORBIDS,
    "far": replace(REFERENCE, far={("Upper-Body", "Walk_02", "Talk_02"): 4.0}),
}


@pytest.fixture
def reference() -> FakeCatalog:
    """Return the library of the published examples: two graphs, eight motions."""
    return REFERENCE


@pytest.fixture
def left_hand() -> FakeCatalog:
    """Return the reference library with a hand below the upper body."""
    return LEFT_HAND


@pytest.fixture(scope="session")
def left_hand_always() -> FakeCatalog:
    """Return the same for a whole session, as tests with many examples need it."""
    return LEFT_HAND


@pytest.fixture
def hands() -> FakeCatalog:
    """Return a library with two hands beside each other."""
    return HANDS


@pytest.fixture(scope="session")
def libraries() -> Mapping[str, FakeCatalog | None]:
    """Return all of them by name, and `none`."""
    return LIBRARIES


@pytest.fixture(scope="session")
def catalog() -> type[FakeCatalog]:
    """Return what makes a library of names."""
    return FakeCatalog


def layers_of(analysis: Analysis) -> list[dict[str, tuple[str, ...]]]:
    """Return the candidates of every command, by graph."""
    plan = analysis.resolved
    assert plan is not None, [one.message for one in analysis.diagnostics]
    return [
        {layer.graph: layer.candidates for layer in statement.layers}
        for statement in plan.statements
        if hasattr(statement, "layers")
    ]


@pytest.fixture
def resolves() -> Callable[..., list[dict[str, tuple[str, ...]]]]:
    """Return a function: script, library, start -> the candidates of every command."""

    def ask(text: str, library: FakeCatalog = REFERENCE, start: str | None = None) -> list[dict[str, tuple[str, ...]]]:
        return layers_of(analyse(Source(text), library, start))

    return ask


@pytest.fixture
def codes() -> Callable[..., list[str]]:
    """Return a function: script, library -> the codes of its diagnostics."""

    def ask(text: str, library: FakeCatalog | None = None, start: str | None = None) -> list[str]:
        return [one.code for one in analyse(Source(text), library, start).diagnostics]

    return ask


@pytest.fixture
def fixed() -> Callable[..., str]:
    """Return a function: script, library -> the script with the first fix of each diagnostic applied."""

    def ask(text: str, library: FakeCatalog | None = None) -> str:
        diagnostics = analyse(Source(text), library).diagnostics
        fixes = [one.fixes[0] for one in diagnostics if one.fixes]
        for fix in sorted(fixes, key=lambda fix: fix.span, reverse=True):
            text = text[: fix.span.start] + fix.replacement + text[fix.span.end :]
        return text

    return ask


@pytest.fixture
def golden(request: pytest.FixtureRequest) -> Callable[[Path, str], None]:
    """Return a function that compares a text with a file, or writes the file with --update-golden."""

    def compare(path: Path, text: str) -> None:
        if request.config.getoption("--update-golden"):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        assert path.is_file(), f"{path} is missing; write it with --update-golden and read it"
        assert text == path.read_text(encoding="utf-8")

    return compare


@pytest.fixture
def tree() -> Callable[[Any, Source], str]:
    """Return a function that prints a value of frozen dataclasses as a tree, spans as the text they cover."""
    return lambda value, source: "".join(f"{line}\n" for line in _lines(value, source))


def _lines(value: Any, source: Source, label: str = "") -> list[str]:
    lead = f"{label}: " if label else ""
    if isinstance(value, Token):
        return [f"{lead}{value.type} {value.text!r} {source.location(value.span)}"]
    if isinstance(value, tuple) and any(is_dataclass(part) for part in value):
        inner = [line for part in value for line in _lines(part, source)]
        return [f"{label}:", *(f"  {line}" for line in inner)] if label else inner
    if not is_dataclass(value):
        return [f"{lead}{value!r}"]
    shown = [
        field for field in fields(value) if field.name != "source" and not isinstance(getattr(value, field.name), Span)
    ]
    plain = [field.name for field in shown if not _is_deep(getattr(value, field.name))]
    said = " ".join(f"{name}={getattr(value, name)!r}" for name in plain)
    span = f" <{_short(source.slice(value.span))}>" if hasattr(value, "span") else ""
    deep = [field.name for field in shown if field.name not in plain]
    inner = [line for name in deep for line in _lines(getattr(value, name), source, name)]
    return [f"{lead}{type(value).__name__}{' ' if said else ''}{said}{span}", *(f"  {line}" for line in inner)]


def _short(text: str) -> str:
    """Return a stretch of a script on one line, without its middle if it is long."""
    line = " ".join(text.split())
    return line if len(line) <= 60 else f"{line[:40]} ... {line[-15:]}"


def _is_deep(value: Any) -> bool:
    return is_dataclass(value) or (isinstance(value, tuple) and any(is_dataclass(part) for part in value))
