"""Answers that are written out as JSON."""

import json

from mlmg_lsp.written import written


def test_what_is_sent_is_ascii_and_says_the_same() -> None:
    answer = {"name": '走路 "😀"', "at": [1, 2.5, None, True], "more": {}}
    text = written(answer).text
    assert text.isascii()
    assert json.loads(text) == answer
