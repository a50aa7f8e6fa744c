"""Every script in examples/ plays on the demo library, and nothing is to be said against it."""

from pathlib import Path

import pytest

import mlmg_lang
from mlmg_lang.formatting.format_script import format_source
from mlmg_lang.source import Source

EXAMPLES = sorted((Path(__file__).parents[1] / "examples").glob("*.ms"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_plays_without_a_complaint(path, demo_library):
    plan, diagnostics = mlmg_lang.compile(path.read_text(encoding="utf-8"), demo_library)
    assert diagnostics == ()
    report = mlmg_lang.play(plan, demo_library).report
    assert report["n_frames"] > 300
    assert all(command["begin"] <= command["arrive"] <= command["end"] for command in report["commands"])


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_is_formatted(path):
    text = path.read_text(encoding="utf-8")
    assert format_source(Source(text)) == text


def test_there_are_examples():
    assert len(EXAMPLES) >= 3
