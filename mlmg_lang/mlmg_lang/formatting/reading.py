"""Tokens -> how they fall into lines and blocks, where signs that would cut a statement in two are left out."""

from __future__ import annotations

from collections.abc import Sequence

from mlmg_lang.parsing.layout import Layout, lay_out
from mlmg_lang.parsing.quotes import requoted, without_lone
from mlmg_lang.parsing.strays import stray_signs, without_strays
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Span


def read_lines(tokens: Sequence[Token]) -> tuple[Layout, list[Span]]:
    """Return the layout of tokens, and the places of signs that are left out of it.

    Signs are judged as the parser judges them, to which a quote without a partner ends where its name does.
    """
    judged = without_lone(requoted(tokens))
    read = without_strays(judged)
    if read is judged:
        return lay_out(tokens), []
    strays = [one.span for one in stray_signs(judged) if one.span is not None]
    kept = {token.span: token for token in read}
    lost = {token.span for token in judged} - kept.keys()
    return lay_out([kept.get(token.span, token) for token in tokens if token.span not in lost]), strays
