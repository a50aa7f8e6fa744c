"""The page on `mlmg explain` shows what it really says of the script there; rewritten with --update-golden."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from mlmg_lang.explaining.explain import explanation_from_analysis
from mlmg_lang.explaining.explanation import Explanation
from mlmg_lang.explaining.mermaid import render_mermaid
from mlmg_lang.explaining.text import render_text
from mlmg_lang.front_end import analyse
from mlmg_lang.source import Source
from mlmg_runtime.library import Library

PAGE = Path(__file__).parents[3] / "docs" / "explain.md"


def block(page: str, info: str) -> re.Match[str]:
    """Return a fenced block of a page: the text before it, and it."""
    found = re.search(rf"(?P<head>^```{info}\n)(?P<text>(?:.*\n)*?)(?=^```$)", page, re.M)
    assert found is not None
    return found


@pytest.fixture
def explanation(demo_library: Library) -> Explanation:
    script = block(PAGE.read_text(encoding="utf-8"), "motion-script")["text"]
    analysis = analyse(Source(script, "stroll.ms"), demo_library)
    assert not analysis.diagnostics
    told = explanation_from_analysis(analysis, demo_library, seed=0)
    return replace(told, library="demo-….mlmg")


@pytest.mark.parametrize(("info", "render"), [("explain", render_text), ("mermaid", render_mermaid)])
def test_the_page_shows_what_is_told_of_its_script(
    info: str,
    render: Callable[[Explanation], str],
    explanation: Explanation,
    golden: Callable[[Path, str], None],
) -> None:
    page = PAGE.read_text(encoding="utf-8")
    shown = block(page, info)
    golden(PAGE, page[: shown.start("text")] + render(explanation) + page[shown.end("text") :])
