"""What is told of the beginning of a text is told of the whole; and from beginning to beginning all becomes known."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from pathlib import Path
from runpy import run_path
from typing import Any

import pytest

from mlmg_lang.beginnings import beginnings, sure
from mlmg_lang.diagnostics import Diagnostic, Severity
from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.source import Source

EDITS = run_path(str(Path(__file__).parents[1] / "lsp" / "random_edits.py"))
SOUND = (
    *("WALK for 3 sec\n", "IDLE\n", "Upper-Body TALK\n", "WALK\n    with Upper-Body TALK\n    for 2 sec\n", "# ( c\n"),
    *(
        "repeat 2 {\n    WALK for 1 sec\n    IDLE\n}\n",
        "(WALK or\n    IDLE) for 2 sec\n",
        "choose {\n  WALK\n|\n  IDLE\n}\n",
    ),
    *("\n", "WALK for 1 sec; IDLE\n", "# mlmg: ignore[MS047]\n", "end Upper-Body\n", "WALK once\n"),
)
WRONG = (
    "WLAK for 3 sec\n",
    "WALK for 3 sce\n",
    "Upper-Bdy TALK\n",
    "WALK for\n",
    "WALK with\n",
    "end Uper-Body\n",
    "for\n",
)


def lines_of(text: str) -> list[str]:
    return text.splitlines(keepends=True)


def parts(lines: Sequence[str], n_further: int) -> Iterator[int]:
    """Yield how many lines there are in beginnings that are short, but sure, the last of all."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mlmg_lang.beginnings._FEWEST", n_further)
        found = list(beginnings(lines))
    return (end for end, is_sure in found if is_sure)


def errors(analysis: Any) -> set[tuple[str, Any, str]]:
    return {(one.code, one.span, one.message) for one in analysis.diagnostics if one.severity is Severity.ERROR}


def random_text(draw: random.Random, written: Sequence[str]) -> str:
    return "".join(draw.choice(written) for _ in range(draw.randrange(5, 60)))


# --- where a beginning ends ---


@pytest.mark.parametrize(
    ("text", "ends"),
    [
        ("A\nB\nC\n", [1, 2, 3]),
        ("repeat 2 {\nA\n}\nB\n", [3, 4]),
        ("(A or\nB)\nC\n", [2, 3]),
        ("（A or\nB）\nC\n", [2, 3]),
        ("/* A\nB */\nC\n", [2, 3]),
        ("# :(\nA\n", [1, 2]),
        ("A)\nB\n", [1, 2]),
        ('(A or ")"\nor B)\nC\n', [2, 3]),
        ('"(" for 1 sec\nB\n', [1, 2]),
        ("repeat 2 {\nA\nB\n", [3]),
        ("", [0]),
    ],
)
def test_at_the_end_of_a_beginning_nothing_is_open(text, ends):
    assert list(parts(lines_of(text), 1)) == ends


def test_a_beginning_has_a_good_deal_more_than_the_one_before():
    ends = [end for end, _ in beginnings(["A\n"] * 100_000)]
    assert ends[:3] == [100, 200, 300]
    assert len(ends) < 30
    assert ends[-1] == 100_000


def test_after_an_edit_the_first_beginning_has_what_has_been_read_where_nothing_is_open():
    lines = ["A\n", "(B\n", "or C)\n"] * 1000
    assert next(beginnings(lines, 301)) == (301, True)
    assert next(beginnings(lines, 302)) == (303, True)
    assert next(beginnings(lines, 4000)) == (3000, True)


@pytest.mark.parametrize(
    ("line", "defines"),
    [
        *(("let x = WALK\n", True), ("LET x(a) = WALK\n", True), ('use "a.ms"\n', True), ("lte x = WALK\n", True)),
        *(("let\n", True), ('ues "a.ms"\n', True), ("lett f(a, b = 1 sec) = a for b\n", True), ("x = WALK\n", True)),
        *(("define x as WALK\n", True), ("def x: WALK\n", True), ("lte x ＝ WALK\n", True), ("A; lte x = B\n", True)),
        *(('"wave #1" for 1 sec; let x = B\n', True), ('lte "a b" = WALK\n', True), ("import gestures\n", True)),
        *(("WALK # let it be\n", False), ("f(part = WALK)\n", False), ("WALK with Upper-Body f(x = TALK)\n", False)),
        *(('"let it be"\n', False), ("f(a = (WALK or (TALK)), b = 1 sec)\n", False), ("WALK for 3 sec; IDLE\n", False)),
    ],
)
def test_what_may_define_a_name_is_known_by_its_looks(line, defines):
    assert next(beginnings(["A\n"] * 100 + [line])) == (100, not defines)


# --- what is told of it ---


@pytest.mark.parametrize("seed", range(30))
def test_mistakes_told_of_a_beginning_are_told_of_the_whole(reference, seed):
    draw = random.Random(seed)
    lines = lines_of(random_text(draw, (*SOUND, *SOUND, *WRONG)))
    whole = errors(analyse(Source("".join(lines)), reference))
    for end in parts(lines, draw.randint(1, 6)):
        assert errors(sure(analyse(Source("".join(lines[:end])), reference))) <= whole


def test_of_garbled_texts_hardly_anything_is_told_that_is_not_told_of_the_whole(reference):
    n_told = n_false = 0
    for seed in range(60):
        author = EDITS["Author"](seed, None, n_lines=(10, 60))
        for _ in range(40):
            author.edit()
        lines = lines_of(author.text)
        whole = errors(analyse(Source("".join(lines)), reference))
        for end in parts(lines, 5):
            told = errors(sure(analyse(Source("".join(lines[:end])), reference)))
            n_told += len(told)
            n_false += len(told - whole)
    assert n_told > 200
    assert n_false <= n_told / 200


def test_most_mistakes_of_a_beginning_are_told(reference):
    text = "WLAK for 3 sec\n" * 20
    assert len(sure(analyse(Source(text), reference)).diagnostics) == 19


@pytest.mark.parametrize("unsure", ["Walk_01\nWalk_01 for 0 sec\n", "WALK for 3\n"])
def test_of_the_last_statement_nothing_is_told_as_it_may_go_on(reference, unsure):
    analysis = analyse(Source(unsure + "WALK wiht\n\n# c\n"), reference)
    assert any(one.span.start >= len(unsure) for one in analysis.diagnostics)
    assert all(one.span.end <= len(unsure) for one in sure(analysis).diagnostics)


def test_hints_wait_for_the_whole(reference):
    def told(analysis: Any) -> list[Diagnostic]:
        return [one for one in analysis.diagnostics if one.severity is not Severity.ERROR]

    analysis = analyse(Source("let x = WALK\nIDLE\nIDLE\n"), reference)
    assert told(analysis)
    assert not told(sure(analysis))


# --- from one to the next ---


@pytest.mark.parametrize("seed", range(20))
def test_from_beginning_to_beginning_with_edits_between_all_becomes_known_as_afresh(reference, seed):
    draw = random.Random(seed)
    author = EDITS["Author"](seed, None, n_lines=(10, 60))
    analysis, end, lines = None, 0, lines_of(author.text)
    while end < len(lines) or analysis is None:
        end, _ = next(beginnings(lines, end + draw.choice((1, 3, 10))))
        source = Source("".join(lines[:end]))
        analysis = analyse(source, reference) if analysis is None else analyse_again(analysis, source)
        assert analysis.diagnostics == analyse(source, reference).diagnostics
        if draw.random() < 0.4 and end < len(lines):
            author.edit()
            lines = lines_of(author.text)
    fresh = analyse(Source("".join(lines)), reference)
    for stage in ("tokens", "script", "plan", "resolved", "diagnostics"):
        assert getattr(analysis, stage) == getattr(fresh, stage)
