"""Answers that are written out as JSON."""

import json

from mlmg_lsp.written import joined, lined, written


def test_what_is_sent_is_ascii_and_says_the_same() -> None:
    answer = {"name": '走路 "😀"', "at": [1, 2.5, None, True], "more": {}}
    text = written(answer).text
    assert text.isascii()
    assert json.loads(text) == answer


def test_answers_come_to_stand_at_the_lines_that_they_are_put_at() -> None:
    one = [{"at": {"line": 0, "character": 3}, "says": '"line":7, {"line":8}, \\"line":9'}, {"line": 0}]
    other = [{"line": 2, "inner": [{"line": 0, "character": 12}]}]
    text = joined([(lined(one), 5), (lined([]), 6), (lined(other), 10)]).text
    assert json.loads(text) == [
        {**one[0], "at": {"line": 5, "character": 3}},
        {"line": 5},
        {"line": 12, "inner": [{"line": 10, "character": 12}]},
    ]
    assert joined([]).text == joined([(lined([]), 1)]).text == "[]"
