"""docs/mistakes.md shows what is really said of ten mistakes; rewritten with --update-golden, and then read."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.fixing import fix_all
from mlmg_lang.front_end import analyse
from mlmg_lang.rendering import render_full
from mlmg_lang.source import Source
from mlmg_runtime.library import Library

PAGE = Path(__file__).parents[2] / "docs" / "mistakes.md"
MISTAKE = re.compile(
    r"```motion-script\n(?P<wrong>.*?)\n```\n\n```text\n(?P<drawn>.*?)```\n\n(?P<why>.*?)\n\n"
    r"With `(?P<option>--[a-z-]+)`:\n\n```motion-script\n(?P<right>.*?)\n```",
    re.DOTALL,
)


@pytest.fixture
def shown(demo_library: Library) -> Callable[[re.Match[str]], str]:
    """Return a function: a mistake as the page has it -> the same as it should be."""

    def diagnose(source: Source) -> tuple[Source, Sequence[Diagnostic]]:
        return source, analyse(source, demo_library).diagnostics

    def show(mistake: re.Match[str]) -> str:
        source = Source(mistake["wrong"], "stroll.ms")
        diagnostics = analyse(source, demo_library).diagnostics
        fixed = fix_all(source, diagnostics, diagnose, unsafe=mistake["option"] == "--unsafe-fixes")
        return (
            f"```motion-script\n{mistake['wrong']}\n```\n\n```text\n{render_full(diagnostics, source)}```\n\n"
            f"{mistake['why']}\n\nWith `{mistake['option']}`:\n\n```motion-script\n{fixed.source.text}\n```"
        )

    return show


def test_the_page_shows_what_is_printed(
    shown: Callable[[re.Match[str]], str], golden: Callable[[Path, str], None]
) -> None:
    golden(PAGE, MISTAKE.sub(shown, PAGE.read_text(encoding="utf-8")))


def test_each_of_the_ten_is_one_message_with_help_and_is_mended(demo_library: Library) -> None:
    mistakes = list(MISTAKE.finditer(PAGE.read_text(encoding="utf-8")))
    assert len(mistakes) == 10
    for mistake in mistakes:
        (one,) = analyse(Source(mistake["wrong"]), demo_library).diagnostics
        assert one.help
        assert one.fixes[0].safe == (mistake["option"] == "--fix")
        assert analyse(Source(mistake["right"]), demo_library).diagnostics == ()
