"""Every example in docs/language.md does what is written below it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from mlmg_lang.diagnostics import CODES
from mlmg_lang.front_end import Analysis, analyse
from mlmg_lang.planning.resolved import Command, Statement, Wait
from mlmg_lang.source import Source

TEXT = (Path(__file__).parents[2] / "docs" / "language.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```motion-script ?([\w-]*)\n(.*?)```\n```result\n(.*?)```", TEXT, re.DOTALL)


def result(analysis: Analysis) -> Iterator[str]:
    """Yield what the page shows of a script: what is played, then what is said of it."""
    plan = analysis.resolved
    if plan is not None:
        yield f"starts in {plan.start}"
        for statement in plan.statements:
            yield f"{analysis.source.position(statement.span.start)[0]}: {shown(statement)}"
    for one in analysis.diagnostics:
        assert one.span is not None
        line, column = analysis.source.position(one.span.start)
        yield f"{line}:{column} {one.severity}[{one.code}]: {one.message}"


def shown(statement: Statement) -> str:
    if isinstance(statement, Command):
        layers = "; ".join(f"{layer.graph} {' '.join(layer.candidates)}" for layer in statement.layers)
        return layers if statement.duration_s is None else f"{layers}, for {statement.duration_s:g} s"
    return f"wait {statement.duration_s:g} s" if isinstance(statement, Wait) else f"end {statement.graph}"


@pytest.mark.parametrize(
    ("library", "script", "expected"), EXAMPLES, ids=[text.split("\n")[0] for _, text, _ in EXAMPLES]
)
def test_an_example_does_what_the_page_says(
    library: str, script: str, expected: str, libraries: Mapping[str, Any]
) -> None:
    analysis = analyse(Source(script), libraries[library or "reference"])
    assert "\n".join(result(analysis)) == expected.rstrip("\n")


def test_every_example_of_the_page_is_run() -> None:
    assert len(EXAMPLES) == TEXT.count("```motion-script") == TEXT.count("```result")
    assert len(EXAMPLES) > 15


def test_the_page_lists_every_code_with_its_severity_and_title() -> None:
    rows = re.findall(r"^\| (MS\d+) \| (\w+) \| (.*) \|$", TEXT, re.MULTILINE)
    assert rows == [(code, rule.severity.value, rule.title) for code, rule in CODES.items()]
