from __future__ import annotations

import pytest

from mlmg_lang.formatting.soundness import Soundness
from mlmg_lang.parsing.layout import MAX_DEPTH, Block, Layout, Line, lay_out
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source


def laid_out(text: str) -> tuple[Soundness, Layout]:
    source = Source(text)
    tokens = tokenize(source)
    layout = lay_out(tokens)
    return Soundness(source, tokens, layout), layout


@pytest.mark.parametrize(
    ("text", "sound"),
    [
        ("WALK for 10 sec", True),
        ("sec for sec", True),
        ("WALK FOR 10 sec", False),
        ("WALK for", False),
        ("3 :", False),
        ("repeat 3", False),
        ("choose", False),
        ("hand😀", False),
        ('"a\\n"', False),
        ('"a', False),
        ("(" * MAX_DEPTH + "A" + ")" * MAX_DEPTH, True),
        ("(" * (MAX_DEPTH + 1) + "A" + ")" * (MAX_DEPTH + 1), False),
    ],
)
def test_a_line_is_sound_if_it_is_a_statement_without_a_mistake(text: str, sound: bool) -> None:
    known, layout = laid_out(text)
    (line,) = layout.items
    assert isinstance(line, Line)
    assert known.line(line.tokens) is sound


def test_a_line_is_not_sound_because_another_of_its_kind_is() -> None:
    known, layout = laid_out('A with B\nA with hand😀\n"a" with B\n"\\n" with B')
    lines = [piece.tokens for piece in layout.items if isinstance(piece, Line)]
    assert [known.line(tokens) for tokens in lines] == [True, False, True, False]


@pytest.mark.parametrize(
    ("text", "sound"),
    [
        ("repeat 3 { WALK }", True),
        ("choose { WALK for }", True),
        ("repeat { WALK }", False),
        ("CHOOSE { WALK }", False),
        ("WALK { TALK }", False),
        ("{ TALK }", False),
        ("repeat 3\n{ TALK }", False),
        ("repeat 3 { TALK", False),
        ("repeat 1 {" * (MAX_DEPTH + 1) + "}" * (MAX_DEPTH + 1), False),
    ],
)
def test_a_block_is_sound_if_its_head_is_and_its_brace_stands_where_it_belongs(text: str, sound: bool) -> None:
    known, layout = laid_out(text)
    block = layout.items[-1]
    assert isinstance(block, Block)
    assert known.block(block) is sound
