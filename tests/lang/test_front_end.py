from __future__ import annotations

import random
import subprocess
import sys
import tracemalloc
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mlmg_lang.diagnostics import Diagnostic, has_errors
from mlmg_lang.front_end import Analysis, analyse
from mlmg_lang.rendering import render_full
from mlmg_lang.source import Source, Span

NAMES = [
    "WALK",
    "TALK",
    "IDLE",
    "SWING_HAND",
    "Idle_02",
    "walk01",
    "WLAK",
    "Upper-Body",
    "Full-Body",
    "Left-Hand",
    "Sub",
]
WORDS = [
    "with",
    "and",
    "or",
    "not",
    "(",
    ")",
    "\n",
    ";",
    "for 2 sec",
    "for 0 ms",
    "once",
    "wait 1 sec",
    "end",
    "repeat 2 {",
    "}",
    "let A =",
    "A",
]
SCRIPTS = st.lists(st.sampled_from(NAMES + WORDS), max_size=20).map(" ".join)


@given(st.text())
def test_any_text_is_analysed(text: str) -> None:
    analyse(Source(text))


@given(st.text(alphabet=st.characters(categories=["Cs", "Cc", "Mn", "So", "Lo", "Po"]), max_size=60))
def test_even_halves_of_characters_are_analysed_and_drawn(text: str) -> None:
    source = Source(text)
    render_full(analyse(source).diagnostics, source).encode("utf-8")


@given(text=SCRIPTS)
def test_any_script_is_analysed_against_a_library(left_hand_always: Any, text: str) -> None:
    analysis = analyse(Source(text), left_hand_always)
    assert (analysis.resolved is None) == has_errors(analysis.diagnostics)
    for one in analysis.diagnostics:
        assert one.span is not None
        assert 0 <= one.span.start <= one.span.end <= len(text)
    for statement in analysis.resolved.statements if analysis.resolved else ():
        for layer in getattr(statement, "layers", ()):
            assert layer.candidates
            assert set(layer.candidates) <= set(left_hand_always.motions(layer.graph))


@given(SCRIPTS)
def test_diagnostics_stand_in_the_order_of_the_text(text: str) -> None:
    spans = [one.span for one in analyse(Source(text)).diagnostics if one.span is not None]
    assert spans == sorted(spans)


# --- scripts that use files, and scripts that someone is in the midst of writing ---


MORE = [
    *('use "a.ms"', 'use "b.ms"', 'use "main.ms"', 'use "c.ms"', "let A(x, t = 1 sec) =", "let B ="),
    *(
        "A(",
        ",",
        "x",
        "t",
        "=",
        "B",
        "for t",
        "for 0.5 cycles",
        "choose {",
        "|",
        "2:",
        "0:",
        "repeat 0 {",
        '"WALK"',
        '"',
    ),
]
BODIES = st.lists(st.sampled_from(NAMES + WORDS + MORE), max_size=25).map(" ".join)
CORPUS = [
    path.read_bytes().decode("utf-8")
    for folder in ("golden/scripts", "invalid")
    for path in sorted((Path(__file__).parents[1] / folder).glob("*.ms"))
]


@dataclass
class Folder:
    """Files that are nowhere but here."""

    texts: Mapping[str, str]

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        return (Source(self.texts[path], path), ()) if path in self.texts else "there is no such file"


@st.composite
def mutated(draw: st.DrawFn) -> str:
    """Draw a script of the collections with a few words put in, taken out, doubled or exchanged."""
    text = draw(st.sampled_from(CORPUS))
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.integers(0, 12)))
        piece = draw(
            st.sampled_from(["", text[start:end] * 2, *NAMES, *WORDS, *MORE, "\r", "\t", "é", "走", "😀", "\0"])
        )
        text = text[:start] + piece + text[end:]
    return text


def places_of(one: Diagnostic) -> Iterator[Span]:
    """Yield all places that a diagnostic is about."""
    yield from (span for span in (one.span, *(note.span for note in one.notes)) if span is not None)
    yield from (label.span for label in one.labels)
    yield from (fix.span for fix in one.fixes)


def assert_sound(analysis: Analysis) -> None:
    """Raise if a place is not in one file, or a fix is that of another file or does not replace text of it."""
    source = analysis.source
    for one in analysis.diagnostics:
        for span in places_of(one):
            assert 0 <= span.start <= span.end < source.end, one
            file, base = source.file(span.start)
            assert span.end <= base + len(file.text), one
            assert file.text[span.start - base : span.end - base] == source.slice(span)
        for fix in one.fixes:
            assert one.span is not None
            assert source.file(fix.span.start) == source.file(one.span.start), one


@settings(max_examples=4 * settings().max_examples)
@given(texts=st.tuples(BODIES | mutated(), BODIES, BODIES))
def test_every_place_lies_in_a_file_and_every_fix_in_that_of_its_mistake(
    left_hand_always: Any, texts: tuple[str, str, str]
) -> None:
    files = Folder(dict(zip(("main.ms", "a.ms", "b.ms"), texts, strict=True)))
    for library in (None, left_hand_always):
        analysis = analyse(Source(texts[0], "main.ms"), library, files=files)
        assert_sound(analysis)
        render_full(analysis.diagnostics, analysis.source).encode("utf-8")
        if library is not None:
            assert (analysis.resolved is None) == has_errors(analysis.diagnostics)


@given(text=BODIES | mutated())
def test_every_fix_leaves_a_script_that_can_be_analysed(left_hand_always: Any, text: str) -> None:
    for one in analyse(Source(text), left_hand_always).diagnostics:
        for fix in one.fixes:
            assert_sound(
                analyse(Source(text[: fix.span.start] + fix.replacement + text[fix.span.end :]), left_hand_always)
            )


@given(text=BODIES | mutated())
def test_a_script_is_analysed_the_same_whenever_it_is(left_hand_always: Any, text: str) -> None:
    first, second = (analyse(Source(text), left_hand_always) for _ in range(2))
    assert (first.diagnostics, first.resolved) == (second.diagnostics, second.resolved)


# --- texts without end ---


MANY = 100_000


@pytest.mark.parametrize(
    "text",
    [
        "\0" * MANY,
        "\ud800" * MANY,
        "e" + "\u0301" * MANY,
        "a-" * (MANY // 2),
        '"' + "\\" * MANY,
        '"' + '\\"' * (MANY // 10),
        '"' + "(" * (MANY // 10),
        '"W' + " " * MANY + "x",
        "\uff08" * (MANY // 10),
        "W\uff03" * (MANY // 30) + " \uff08" * (MANY // 30),
        ":" * (MANY // 10),
        "/*\n" * (MANY // 30),
        "walk" * (MANY // 4),
        "WALK for " + "9" * MANY + " sec",
        "repeat " + "9" * MANY + " { WALK }",
        "not " * (MANY // 20) + "WALK",
        "(" * 10_000 + "WALK" + ")" * 10_000,
        "A(" * 10_000 + "WALK" + ")" * 10_000,
        "{" * 10_000,
        "}" * 10_000,
        '"' * 10_001,
        "repeat 2 { " * 10_000 + "WALK" + " }" * 10_000,
        "choose { WALK | " * 10_000,
        "choose { " + "|" * 20_000 + " }",
        "WALK " * 10_000,
        "WALK with " * 10_000,
        " or ".join(["WALK"] * 10_000),
        "# nothing\n" * 30_000,
        ";" * 30_000,
        "let " * 10_000,
        "\n".join(f"let A{n}(x, y = A{n}) = A{n + 1}(y, x)" for n in range(2_000)) + "\nA0",
        "\n".join(f"let A{n} = A{n + 1}" for n in range(2_000)) + "\nA0\nlet A2000 = WALK",
        "\n".join(f"let A{n} = A{n + 1} or A{n + 1}" for n in range(300)) + "\nA0\nlet A300 = WALK",
        "\n".join(f"let A{n} = A{(n + 1) % 2_000}" for n in range(2_000)) + "\nA0",
        "let A(" + ", ".join(f"x{n}" for n in range(2_000)) + ") = x0\nA(" + ", ".join(["WALK"] * 2_000) + ")",
        'use "a.ms"\n' * 2_000,
        "wait 1 cycles\n" * 2_000,
        "end Upper-Body\n" * 2_000,
    ],
    ids=lambda text: f"{text[:12]!a}-{len(text)}",
)
def test_a_text_of_any_length_is_analysed(text: str, reference: Any) -> None:
    """In a time in proportion; whoever makes one of these slow sees it here."""
    assert_sound(analyse(Source(text)))
    assert_sound(analyse(Source(text), reference))


@pytest.mark.parametrize("seed", range(4))
def test_a_hundred_thousand_characters_of_nonsense_are_analysed(seed: int, reference: Any) -> None:
    draws = random.Random(seed)
    pools = [
        [chr(number) for number in range(1, 127)],
        [chr(number) for number in range(0x300, 0x3000)],
        [
            "WALK ",
            "with ",
            "and ",
            "( ",
            ") ",
            "{ ",
            "} ",
            "repeat ",
            "choose ",
            "| ",
            "; ",
            "let ",
            "= ",
            "\n",
            "2 ",
            '"',
        ],
        ["WALK\n", "TALK WALK\n", "repeat 2 {\n", "}\n", "WALK for 1 sec\n", "choose {\n", "|\n", "let A = WALK\n"],
    ]
    text = "".join(draws.choices(pools[seed], k=MANY // len(pools[seed][0])))[:MANY]
    for library in (None, reference):
        analysis = analyse(Source(text), library)
        assert analysis.diagnostics
        assert len({one.code for one in analysis.diagnostics}) < 20


def test_very_many_lines_are_analysed() -> None:
    assert analyse(Source("IDLE\n" * 20_000)).diagnostics == ()


def test_what_a_long_script_takes_grows_with_it_and_not_faster(reference: Any) -> None:
    """Counted in the bytes that are allocated at most, which are the same whatever else the machine does."""
    script = "IDLE for 1 sec; Upper-Body TALK for 1 sec; repeat 2 { choose { WALK | TALK } }\n"
    most = []
    for n in (50, 200):
        source = Source(script * n)
        tracemalloc.start()
        analyse(source, reference)
        most.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert most[1] < 6 * most[0]


# --- the stages ---


def test_layers_in_what_a_graph_is_to_do_are_no_plan_where_not_all_definitions_are_known(reference: Any) -> None:
    analysis = analyse(Source("let\nUpper-Body (TALK with IDLE)\n"), reference)
    assert [one.span for one in analysis.diagnostics] == [Span(0, 3)]


def test_without_a_library_there_is_no_plan() -> None:
    analysis = analyse(Source("WALK"))
    assert (analysis.plan, analysis.resolved, analysis.diagnostics) == (None, None, ())


def test_the_front_end_needs_neither_the_runtime_nor_what_is_slow() -> None:
    names = "('numpy', 'mlmg_runtime', 'rapidfuzz', 'scipy', 'argparse')"
    program = f"import sys, mlmg_lang.front_end; print([name for name in {names} if name in sys.modules])"
    told = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert told.stdout.strip() == "[]"
