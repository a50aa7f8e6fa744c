from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.formatting.words import shortest_number, words_of
from mlmg_lang.parsing.layout import Line, lay_out
from mlmg_lang.parsing.parse import parse
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source


def written(text: str) -> str:
    """Return the last line of a script as it is written."""
    lines = [piece.tokens for piece in lay_out(tokenize(Source(text))).items if isinstance(piece, Line)]
    return "".join(words_of(lines).written(lines[-1]))


@pytest.mark.parametrize(
    ("digits", "shortest"),
    [("10.0", "10"), ("05", "5"), ("1.50", "1.5"), ("0.5", "0.5"), ("00.0", "0"), ("0", "0"), ("100", "100")],
)
def test_zeros_that_say_nothing_go(digits: str, shortest: str) -> None:
    assert shortest_number(digits) == shortest


@given(st.from_regex(r"[0-9]{1,30}(\.[0-9]{1,30})?", fullmatch=True))
def test_a_number_stays_the_same_number(digits: str) -> None:
    assert float(shortest_number(digits)) == float(digits)
    assert len(shortest_number(digits)) <= len(digits)


@given(st.text(alphabet='aA1_-. sS"\\uUbBeEcCwWiItThH走é', min_size=1, max_size=8))
def test_a_name_in_quotes_stays_the_same_name(name: str) -> None:
    escaped = name.replace("\\", "\\\\").replace('"', '\\"')
    text = written(f'"{escaped}" with A')
    for after in (text, f"{text} for 2 sec"):
        source = Source(after)
        parsed = parse(source, tokenize(source))
        if name.strip():
            assert parsed.diagnostics == ()
            (command,) = parsed.script.items
            assert command.motion.operands[0].name.text == name


def test_a_definition_is_known_wherever_it_stands() -> None:
    assert written('let "F" (x) = x\nF (A)') == "F(A)"
    assert written("let F(x) = x\nG(A)") == "G (A)"
    assert written("let E\u0301(x) = x\n\u00c9 (A)") == "\u00c9(A)"


def test_where_another_file_is_used_an_unknown_name_keeps_its_space() -> None:
    assert written('use "f.ms"\nF(A)') == "F(A)"
    assert written('use "f.ms"\nF (A)') == "F (A)"
    assert written('use "f.ms"\nF (A, B)') == "F(A, B)"
