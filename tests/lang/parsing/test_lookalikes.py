"""What only looks like signs of the language is read as those; names of other scripts stay what they are."""

import pytest

from mlmg_lang.parsing.lookalikes import narrowed
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("\uff12", ["INTEGER 2"]),
        ("\uff11\uff0e\uff15", ["DECIMAL 1.5"]),
        ("\u0663", ["INTEGER 3"]),
        ("\uff53\uff45\uff43", ["UNIT sec"]),
        ("\uff46\uff4f\uff52", ["FOR for"]),
        ("\u4e2d\uff08\u6587\uff09", ["NAME \u4e2d", "LEFT (", "NAME \u6587", "RIGHT )"]),
        ("a\uff08\uff11\uff0c\uff42", ["NAME a", "LEFT (", "INTEGER 1", "COMMA ,", "NAME \uff42"]),
        (
            "a\uff08b \u4e2d\uff03c d\ne",
            ["NAME a", "LEFT (", "NAME b", "NAME \u4e2d", "COMMENT #c", "NEWLINE \n", "NAME e"],
        ),
        ("a\uff3b\uff11", ["NAME a", "UNKNOWN [", "INTEGER 1"]),
        ("\u2192", ["UNKNOWN \u2192"]),
    ],
)
def test_signs_of_other_keyboards_are_read_as_those_of_the_language(text, meant):
    assert [f"{token.type} {token.text}" for token in narrowed(tokenize(Source(text)))] == meant


@pytest.mark.parametrize(
    "name",
    [
        "\u4e2d\u6587",
        "WALK-\uff12",
        "walk\uff12",
        "\uff37\uff21\uff2c\uff2b",
        "\uff37_\uff53\uff45\uff43",
        "\u00e9\u0663",
    ],
)
def test_a_name_that_is_one_stays_the_same(name):
    tokens = tokenize(Source(f"WALK and {name} for 2 sec"))
    assert narrowed(tokens) is tokens


def test_each_token_stands_where_it_was():
    tokens = narrowed(tokenize(Source("WALK and\uff08IDLE\uff09for \uff12sec")))
    assert [(token.text, token.span.start, token.span.end) for token in tokens] == [
        ("WALK", 0, 4),
        ("and", 5, 8),
        ("(", 8, 9),
        ("IDLE", 9, 13),
        (")", 13, 14),
        ("for", 14, 17),
        ("2", 18, 19),
        ("sec", 19, 22),
    ]
