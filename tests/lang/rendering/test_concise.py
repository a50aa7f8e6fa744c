from __future__ import annotations

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.rendering import render_concise
from mlmg_lang.source import Source, Span


def test_the_concise_form_is_one_line_each() -> None:
    source = Source("A\nB", "a.ms", (Source("x", "b.ms"),))
    diagnostics = [
        Diagnostic("MS021", "no", Span(2, 3)),
        Diagnostic("MS044", "start", None),
        Diagnostic("MS047", "so", Span(4, 5)),
    ]
    assert render_concise(diagnostics, source) == (
        "a.ms:2:1: error[MS021]: no\na.ms: error[MS044]: start\nb.ms:1:1: hint[MS047]: so\n"
    )


def test_a_message_cannot_make_a_terminal_do_things_or_fill_it() -> None:
    source = Source("A", "a\x07.ms")
    told = render_concise([Diagnostic("MS021", f"no `\x1b[2J{'x' * 10_000}`\n", Span(0, 1))], source)
    assert "\x1b" not in told
    assert "\x07" not in told
    assert told.count("\n") == 1
    assert len(told) < 1000
