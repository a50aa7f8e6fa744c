from __future__ import annotations

import subprocess
import sys
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.diagnostics import has_errors
from mlmg_lang.front_end import analyse
from mlmg_lang.rendering import render_full
from mlmg_lang.source import Source

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


def test_without_a_library_there_is_no_plan() -> None:
    analysis = analyse(Source("WALK"))
    assert (analysis.plan, analysis.resolved, analysis.diagnostics) == (None, None, ())


def test_the_front_end_needs_neither_the_runtime_nor_what_is_slow() -> None:
    names = "('numpy', 'mlmg_runtime', 'rapidfuzz', 'scipy', 'argparse')"
    program = f"import sys, mlmg_lang.front_end; print([name for name in {names} if name in sys.modules])"
    told = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert told.stdout.strip() == "[]"
