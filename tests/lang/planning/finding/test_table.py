"""The rules that find expressions: each has its file and a script with what it finds in it, golden/finding."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from mlmg_lang.front_end import Analysis, analyse
from mlmg_lang.planning import finding, typed
from mlmg_lang.planning.finding.table import RULES, Rule
from mlmg_lang.rendering import render_full
from mlmg_lang.source import Source

FOLDER = Path(__file__).parents[3] / "golden" / "finding"
NO_RULES = {"__init__", "search", "sets", "sharing", "table"}
by_name = pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)


def analysed(rule: Rule, libraries: Mapping[str, Any]) -> Analysis:
    path = FOLDER / f"{rule.name}.ms"
    text = path.read_text(encoding="utf-8")
    (library,) = re.findall(r"^# library: (\S+)$", text, re.MULTILINE)
    return analyse(Source(text, path.name), libraries[library])


def told(analysis: Analysis) -> Iterator[str]:
    """Yield the ways to understand each command, the best first."""
    assert analysis.plan is not None
    for command in analysis.plan.statements:
        if isinstance(command, typed.Command):
            line, _ = analysis.source.position(command.span.start)
            yield f"{line}: {analysis.source.slice(command.span)}"
            for way in command.ways:
                yield "  " + "; ".join(f"{layer.graph}: {' '.join(layer.motions)}" for layer in way.layers)


@by_name
def test_a_rule_finds_in_its_script_what_it_did_before(
    rule: Rule, libraries: Mapping[str, Any], golden: Callable[[Path, str], None]
) -> None:
    analysis = analysed(rule, libraries)
    # What a command can do where it stands is not asked here.
    wrong = [one for one in analysis.diagnostics if "MS020" <= one.code < "MS040"]
    drawn = render_full(wrong, analysis.source)
    lines = "".join(f"{line}\n" for line in told(analysis))
    golden(FOLDER / f"{rule.name}.txt", "\n".join(part for part in (lines, drawn) if part))


def test_every_rule_stands_in_the_file_of_its_name() -> None:
    files = {path.stem for path in Path(finding.__file__).parent.glob("*.py")} - NO_RULES
    assert {rule.name for rule in RULES} == files
    assert all(rule.find.__module__ == f"{finding.__name__}.{rule.name}" for rule in RULES)


def test_no_golden_file_is_left_without_its_rule() -> None:
    assert {path.stem for path in FOLDER.iterdir()} == {rule.name for rule in RULES}
