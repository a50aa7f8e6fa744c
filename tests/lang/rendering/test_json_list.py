from __future__ import annotations

import json

from mlmg_lang.diagnostics import Diagnostic, Fix, Label, Note
from mlmg_lang.rendering import render_json
from mlmg_lang.source import Source, Span


def test_json_has_spans_in_lines_and_columns_of_code_points() -> None:
    source = Source("A\n走 B", "a.ms", (Source("let X = C", "b.ms"),))
    fixes = (Fix(Span(4, 5), "C", safe=True),)
    labels = (Label(Span(10, 11), "there"),)
    one = Diagnostic("MS020", "so", Span(4, 5), "write `C`", (Note("n"),), fixes, labels)
    assert json.loads(render_json([(source, [one])])) == [
        {
            "file": "a.ms",
            "code": "MS020",
            "severity": "hint",
            "span": [2, 3, 2, 4],
            "message": "so",
            "help": "write `C`",
            "labels": [{"file": "b.ms", "span": [1, 5, 1, 6], "message": "there"}],
            "notes": [{"file": None, "span": None, "message": "n"}],
            "fixes": [{"title": "write `C`", "span": [2, 3, 2, 4], "replacement": "C", "applicability": "safe"}],
        }
    ]


def test_a_diagnostic_of_a_used_file_names_that_file() -> None:
    source = Source("A", "a.ms", (Source("B", "b.ms"),))
    (entry,) = json.loads(render_json([(source, [Diagnostic("MS021", "no", Span(2, 3))])]))
    assert (entry["file"], entry["span"]) == ("b.ms", [1, 1, 1, 2])


def test_no_diagnostics_are_an_empty_list() -> None:
    assert json.loads(render_json([(Source("A"), [])])) == []
