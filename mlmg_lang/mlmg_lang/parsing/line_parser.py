"""The tokens of one line -> its node, or where and why the parser is stuck."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import lark

from mlmg_grammar import LINE
from mlmg_lang.parsing.build_syntax import motion_script
from mlmg_lang.parsing.syntax import Line
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source, Span

if TYPE_CHECKING:
    from lark.parsers.lalr_interactive_parser import InteractiveParser


@dataclass(frozen=True, slots=True)
class Stuck:
    """A line that cannot be parsed.

    Attributes
    ----------
    at : the index of the first token that does not fit; the number of tokens if the end comes too early.
    accepts : the types of token that could stand there; `$END` is the end of the line.
    in_choose : whether the line stands in the braces of a `choose`.
    """

    source: Source
    tokens: tuple[Token, ...]
    at: int
    accepts: frozenset[str]
    in_choose: bool = False

    @property
    def left(self) -> int:
        """Return how many tokens are still unread: what a mended line must make fewer."""
        return len(self.tokens) - self.at

    def token(self, offset: int) -> Token | None:
        """Return the token at a distance from the one that does not fit, if there is one."""
        at = self.at + offset
        return self.tokens[at] if 0 <= at < len(self.tokens) else None

    def type(self, offset: int) -> str:
        """Return the type of the token at a distance, `$END` where there is none."""
        token = self.token(offset)
        return "$END" if token is None else token.type

    @property
    def span(self) -> Span:
        """Return the place of the token that does not fit, or of the end."""
        if self.left:
            return self.tokens[self.at].span
        end = self.tokens[-1].span.end
        return Span(end, end)


def read(source: Source, tokens: Sequence[Token], in_choose: bool = False) -> Line | Stuck:
    """Parse one line; the tokens need not be those of the source.

    Parameters
    ----------
    in_choose : whether it stands in the braces of a `choose`.
    """
    parser = motion_script().parse_interactive(start=LINE)
    at = _feed(parser, tokens)
    if at is None:
        return cast("Line", parser.result)
    return Stuck(source, tuple(tokens), at, _accepted_before(tokens[:at]), in_choose)


def accepted(tokens: Sequence[Token]) -> frozenset[str] | None:
    """Return the types of token that could follow those of a line that is not finished; None if they do not parse."""
    try:
        return _accepted_before(tokens)
    except lark.UnexpectedToken:
        return None


def _feed(parser: InteractiveParser, tokens: Sequence[Token]) -> int | None:
    """Give tokens to a parser, and the end; return the index of the first that it refuses."""
    fed = 0
    try:
        for token in tokens:
            parser.feed_token(cast(lark.Token, token))
            fed += 1
        parser.result = parser.feed_token(lark.Token("$END", ""))
    except lark.UnexpectedToken:
        return fed
    return None


def _accepted_before(tokens: Sequence[Token]) -> frozenset[str]:
    """Return what could follow tokens that parse. (A refused token may have moved its parser already.)"""
    parser = motion_script().parse_interactive(start=LINE)
    for token in tokens:
        parser.feed_token(cast(lark.Token, token))
    return frozenset(parser.accepts())  # type: ignore[no-untyped-call]
