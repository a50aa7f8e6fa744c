"""The table of rules: each has its file and a script with what it makes of it, golden/rules, rewritten with a flag."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from mlmg_lang.front_end import analyse
from mlmg_lang.planning import rules
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolution import Resolution
from mlmg_lang.planning.resolve import resolve
from mlmg_lang.planning.rules.table import RULES, Rule
from mlmg_lang.rendering import render_full
from mlmg_lang.source import Source

FOLDER = Path(__file__).parents[3] / "golden" / "rules"
NO_RULES = {"__init__", "attempt", "ruling", "table"}
by_name = pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.judge.__name__)


def asked_for(text: str, libraries: Mapping[str, Any]) -> Any:
    """Return the library that a script is for, as its comments say."""
    (name,) = re.findall(r"^# library: (\S+)$", text, re.MULTILINE)
    lost = [line.split() for line in re.findall(r"^# lost: (.+)$", text, re.MULTILINE)]
    cut = {tuple(line.split()) for line in re.findall(r"^# cut: (.+)$", text, re.MULTILINE)}
    cut |= {way for graph, motion in lost for way in _ways_of(libraries[name], graph, motion)}
    forbid = {tuple(line.split()) for line in re.findall(r"^# forbid: (.+)$", text, re.MULTILINE)}
    far = [line.split() for line in re.findall(r"^# far: (.+)$", text, re.MULTILINE)]
    distances = {(graph, one, other): float(times) for graph, one, other, times in far}
    return replace(libraries[name], cut=frozenset(cut), forbidden=frozenset(forbid), far=distances)


def _ways_of(library: Any, graph: str, motion: str) -> Iterator[tuple[str, str, str]]:
    """Yield all ways to and from a motion that is cut off from the others."""
    for other in library.motions(graph):
        if other != motion:
            yield from ((graph, motion, other), (graph, other, motion))


def resolved(rule: Rule, libraries: Mapping[str, Any]) -> Resolution:
    path = FOLDER / f"{rule.judge.__name__}.ms"
    text = path.read_text(encoding="utf-8")
    source, library = Source(text, path.name), asked_for(text, libraries)
    plan = analyse(source, library).plan
    assert plan is not None
    return resolve(plan, Names(library), library, source)


def told(resolution: Resolution) -> Iterator[str]:
    """Yield what of the motions that each command finds is left, and by which rule others are not."""
    source = resolution.plan.source
    for command in sorted(resolution.commands, key=lambda one: one.span):
        line, _ = source.position(command.span.start)
        yield f"{line}: {source.slice(command.span)}"
        for layer in command.layers:
            yield f"  {layer.graph}: {' '.join(layer.candidates)}"
            yield from (f"    {one.motion} ({one.reason}): {one.because}" for one in layer.left_out)


@by_name
def test_a_rule_makes_of_its_script_what_it_did_before(
    rule: Rule, libraries: Mapping[str, Any], golden: Callable[[Path, str], None]
) -> None:
    resolution = resolved(rule, libraries)
    drawn = render_full(resolution.diagnostics, resolution.plan.source)
    lines = "".join(f"{line}\n" for line in told(resolution))
    golden(FOLDER / f"{rule.judge.__name__}.txt", f"{lines}\n{drawn}" if drawn else lines)


def test_every_rule_stands_in_the_file_of_its_name() -> None:
    files = {path.stem for path in Path(rules.__file__).parent.glob("*.py")} - NO_RULES
    assert {rule.judge.__name__ for rule in RULES} == files
    for rule in RULES:
        assert rule.judge.__module__ == f"{rules.__name__}.{rule.judge.__name__}"
        assert rule.name == rule.judge.__name__.replace("_", " ")


def test_no_golden_file_is_left_without_its_rule() -> None:
    assert {path.stem for path in FOLDER.iterdir()} == {rule.judge.__name__ for rule in RULES}


@by_name
def test_a_candidate_that_is_left_out_is_so_by_a_rule_of_the_table(rule: Rule, libraries: Mapping[str, Any]) -> None:
    commands = resolved(rule, libraries).commands
    reasons = {one.reason for command in commands for layer in command.layers for one in layer.left_out}
    assert reasons <= {one.name for one in RULES}
    assert rule.name in reasons or rule.name == "way on"
