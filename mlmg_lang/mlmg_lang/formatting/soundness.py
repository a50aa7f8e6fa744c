"""Which statements and blocks can be read as they stand; all others are kept as written."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence

from mlmg_lang.diagnostics import Severity
from mlmg_lang.parsing.layout import Block, Layout
from mlmg_lang.parsing.lexical import check_tokens
from mlmg_lang.parsing.parse import parse
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source, Span


class Soundness:
    """Asks the parser about lines, once for each kind of line: the types of its tokens alone say whether it parses."""

    def __init__(
        self,
        source: Source,
        tokens: Sequence[Token],
        layout: Layout,
        known: dict[tuple[str, ...], bool] | None = None,
        strays: Sequence[Span] = (),
    ) -> None:
        """Take a script, its tokens, and what is wrong with its braces.

        Parameters
        ----------
        strays : the places of signs that cut statements in two.
        known : which kinds of lines parse, as far as that has been asked; what is asked is added.
        """
        self._source = source
        self._odd = {one.span for one in check_tokens(tokens) if one.severity is Severity.ERROR}
        self._braces = {one.span for one in layout.diagnostics}
        self._too_deep = [one.span.start for one in layout.diagnostics if one.span and one.code == "MS005"]
        self._signs = sorted(span.start for span in strays)
        self._known = {} if known is None else known

    def line(self, tokens: Sequence[Token]) -> bool:
        """Return whether a line is a statement without a mistake."""
        if self._odd and any(token.span in self._odd for token in tokens):
            return False
        if self._signs and self._has_sign(Span(tokens[0].span.start, tokens[-1].span.end)):
            return False
        kinds = tuple([token.type for token in tokens])
        sound = self._known.get(kinds)
        if sound is None:
            sound = self._known[kinds] = self._parses(tokens)
        return sound

    def block(self, block: Block) -> bool:
        """Return whether the braces of a block stand where they belong, behind a sound head."""
        if block.brace in self._braces or not block.head or self._is_too_deep(block.span):
            return False
        end = Span(block.brace.end, block.brace.end)
        return self.line((*block.head, Token("OPEN", "{", block.brace), Token("CLOSE", "}", end)))

    def _has_sign(self, span: Span) -> bool:
        first = bisect_left(self._signs, span.start)
        return first < len(self._signs) and self._signs[first] < span.end

    def _is_too_deep(self, span: Span) -> bool:
        first = bisect_left(self._too_deep, span.start)
        return first < len(self._too_deep) and self._too_deep[first] < span.end

    def _parses(self, tokens: Sequence[Token]) -> bool:
        return not any(one.severity is Severity.ERROR for one in parse(self._source, tokens).diagnostics)
