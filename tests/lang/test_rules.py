"""What `mlmg rule` tells of each code is true: the wrong script is told so, and the right one is not."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

import mlmg_lang.rules
from mlmg_lang.diagnostics import CODES, Diagnostic, has_errors
from mlmg_lang.front_end import analyse
from mlmg_lang.rendering import render_full
from mlmg_lang.rules import Example, read_rule
from mlmg_lang.script_files import source_from_bytes
from mlmg_lang.source import Source
from mlmg_runtime.library import Library

FOLDER = Path(mlmg_lang.rules.__file__).parent
USED = {"gestures.ms": "let GREET = WALK with Upper-Body WAVE_HAND", "circle.ms": 'use "example.ms"'}
"""The files that examples use."""


class Files:
    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        if path not in (*USED, "example.ms"):
            return f"there is no file `{path}`"
        return Source(USED.get(path, ""), path), ()


@pytest.fixture
def told(demo_library: Library, libraries: Mapping[str, Any]) -> Callable[[Example], tuple[Source, list[Diagnostic]]]:
    """Return a function: an example -> its source, and what is said of it."""

    def ask(example: Example) -> tuple[Source, list[Diagnostic]]:
        options = example.options
        data = example.text.rstrip("\n").encode("utf-8")
        if "bytes" in options:
            data = data.decode("unicode_escape").encode("latin-1")
        if "times" in options:
            data = b"\n".join([data] * int(options["times"]))
        source, unreadable = source_from_bytes(data, "example.ms")
        if unreadable:
            return source, list(unreadable)
        library = libraries[options["library"]] if "library" in options else demo_library
        analysis = analyse(source, library, options.get("start"), Files())
        return analysis.source, list(analysis.diagnostics)

    return ask


@pytest.mark.parametrize("code", CODES)
def test_the_wrong_example_of_a_code_is_told_what_its_text_shows(
    code: str, told: Callable[..., Any], golden: Callable[[Path, str], None]
) -> None:
    rule = read_rule(code)
    source, diagnostics = told(rule.wrong)
    about = [one for one in diagnostics if one.code == code]
    assert about, [one.code for one in diagnostics]
    assert {one.code for one in diagnostics} == {code} or code == "MS006"
    path = FOLDER / f"{code}.md"
    text = path.read_text(encoding="utf-8")
    golden(path, text.replace(f"```text\n{rule.told}```", f"```text\n{render_full(about, source)}```"))


@pytest.mark.parametrize("code", CODES)
def test_the_right_example_of_a_code_has_no_errors_and_is_not_told_it(code: str, told: Callable[..., Any]) -> None:
    _, diagnostics = told(read_rule(code).right)
    assert not has_errors(tuple(diagnostics)), diagnostics
    assert code not in {one.code for one in diagnostics}


@pytest.mark.parametrize("code", CODES)
def test_a_text_says_what_and_why_in_whole_sentences(code: str) -> None:
    rule = read_rule(code)
    for text in (rule.meaning, rule.why):
        assert text[0].isupper() or text[0] in '`"'
        assert text.endswith((".", "`."))
        assert all(len(line) <= 120 for line in text.splitlines())


def test_no_text_is_left_without_its_code() -> None:
    assert {path.stem for path in FOLDER.glob("*.md")} == set(CODES)
