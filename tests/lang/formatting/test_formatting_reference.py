"""Every example in docs/formatting.md becomes what is written below it."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

TEXT = (Path(__file__).parents[3] / "docs" / "formatting.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```motion-script\n(.*?)```\n```formatted\n(.*?)```", TEXT, re.DOTALL)


@pytest.mark.parametrize(("written", "expected"), EXAMPLES, ids=[written.split("\n")[0] for written, _ in EXAMPLES])
def test_an_example_becomes_what_the_page_says(written: str, expected: str, formatted: Callable[[str], str]) -> None:
    assert formatted(written) == expected


def test_every_example_of_the_page_is_run() -> None:
    assert len(EXAMPLES) == TEXT.count("```motion-script") == TEXT.count("```formatted")
    assert len(EXAMPLES) > 8
