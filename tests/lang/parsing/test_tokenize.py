from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source


@given(st.text())
def test_every_token_is_the_text_of_its_span(text: str) -> None:
    source = Source(text)
    tokens = tokenize(source)
    assert all(token.text == source.slice(token.span) for token in tokens)
    assert all(one.span.end <= after.span.start for one, after in pairwise(tokens))


def test_comments_and_line_ends_are_tokens_and_spaces_are_not() -> None:
    assert [token.type for token in tokenize(Source("A # b\n\tC"))] == ["NAME", "COMMENT", "NEWLINE", "NAME"]
