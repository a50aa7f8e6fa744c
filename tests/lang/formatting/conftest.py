"""What tests of the formatter share: scripts to format, and what formatting must leave as it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from pathlib import Path
from runpy import run_path
from typing import Any

import pytest
from hypothesis.strategies import SearchStrategy

from mlmg_lang.formatting.format_script import format_source
from mlmg_lang.front_end import analyse
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.amounts import UNITS
from mlmg_lang.parsing.case import is_shouted
from mlmg_lang.parsing.structure import is_sub
from mlmg_lang.source import Source, Span


def meaning(value: Any, source: Source) -> Any:
    """Return a syntax tree without what may differ: spans, how numbers, units and quotes are written."""
    match value:
        case tuple():
            return tuple(meaning(part, source) for part in value)
        case syntax.Name(text, quoted):
            return text, is_sub(value), is_shouted(value), quoted and text in UNITS
        case syntax.Quantity(number, unit):
            return float(number), UNITS[unit]
        case syntax.Weight(number) | syntax.RepeatHead(number):
            return type(value).__name__, int(number)
        case syntax.Broken(span):
            # A quote that opens nothing may have joined lines, each of which is kept without the space around it.
            return " ".join(line.replace("\ufeff", " ").strip() for line in source.slice(span).splitlines())
        case Span():
            return "somewhere"
    if not is_dataclass(value):
        return value
    told = (meaning(getattr(value, field.name), source) for field in fields(value) if field.name != "span")
    return type(value).__name__, *told


def facts(text: str) -> dict[str, Any]:
    """Return all that formatting must not change."""
    source = Source(text)
    analysis = analyse(source)
    return {
        "meaning": meaning(analysis.script.items, source),
        "comments": [token.text.rstrip() for token in analysis.tokens if token.type == "COMMENT"],
        "codes": [one.code for one in analysis.diagnostics],
    }


@pytest.fixture(scope="session", name="facts")
def facts_of() -> Callable[[str], dict[str, Any]]:
    """Return a function: a script -> all that formatting must not change."""
    return facts


@pytest.fixture(scope="session")
def formatted() -> Callable[[str], str]:
    """Return a function that formats a script, and holds the result to all that is promised of it."""

    def ask(text: str) -> str:
        result = format_source(Source(text))
        assert facts(result) == facts(text)
        assert format_source(Source(result)) == result
        if result == text:
            return result
        assert "\r" not in result
        assert result == "" or (result.endswith("\n") and not result.startswith("\n") and not result.endswith("\n\n"))
        return result

    return ask


@pytest.fixture(scope="session")
def scripts() -> SearchStrategy[str]:
    """Return a strategy of valid scripts of the whole grammar."""
    return run_path(str(Path(__file__).parents[1] / "scripts_strategy.py"))["scripts"]()
