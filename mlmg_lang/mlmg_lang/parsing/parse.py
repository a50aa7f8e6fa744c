"""Tokens -> the syntax tree, and what is wrong with the syntax. Whatever the tokens, this does not fail."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.layout import MAX_DEPTH, Block, Line, lay_out
from mlmg_lang.parsing.lexical import check_tokens, join_quoted
from mlmg_lang.parsing.line_parser import Stuck, read
from mlmg_lang.parsing.lookalikes import as_meant, lookalikes
from mlmg_lang.parsing.tokenize import MAX_TOKENS
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source, Span

if TYPE_CHECKING:
    from mlmg_lang.parsing.mistakes import Mistake

MAX_MISTAKES = 200
"""After so many a text is no script; reading what is left would take long and help nobody."""
_MAX_MENDED = 2_000
"""The longest line, in tokens, whose mistakes are looked into."""
MAX_STATEMENT = 10_000
"""The longest line, in tokens, that is read."""


@dataclass(frozen=True, slots=True)
class Parsed:
    """A syntax tree with what is wrong with it."""

    script: syntax.Script
    diagnostics: tuple[Diagnostic, ...]


def parse(source: Source, tokens: Sequence[Token], base: int = 0) -> Parsed:
    """Return the syntax tree of a whole file; a statement that cannot be read is `Broken` in it.

    Parameters
    ----------
    base : where the file begins whose tokens these are: the script itself, or one that it uses.
    """
    reader = _Reader(source)
    reader.diagnostics += islice(lookalikes(tokens, source), MAX_MISTAKES)
    last = tokens[-1] if len(tokens) == MAX_TOKENS else None
    tokens = join_quoted(as_meant(tokens), source)
    layout = lay_out(tokens)
    reader.diagnostics += [*check_tokens(tokens), *layout.diagnostics]
    del reader.diagnostics[MAX_MISTAKES:]
    if last is not None:
        reader.cut_off(last)
    items = reader.items(layout.items)
    span = Span(base, base + len(source.file(base)[0].text))
    return Parsed(syntax.Script(items, span), tuple(reader.diagnostics))


class _Reader:
    """Makes nodes of lines and blocks, and collects what is wrong."""

    def __init__(self, source: Source) -> None:
        self.diagnostics: list[Diagnostic] = []
        self._source = source
        self._in_choose = False

    def cut_off(self, last: Token) -> None:
        """Say that there is more text than is read."""
        message = f"a script may have at most {MAX_TOKENS:,} words and signs; what comes after this is not read"
        self._say("MS007", message, last.span, "leave some of it to another script")

    def items(self, pieces: Iterable[Line | Block]) -> tuple[syntax.Item, ...]:
        """Return the items of a body."""
        found: list[syntax.Item] = []
        for piece in pieces:
            if isinstance(piece, Block):
                found += self._block(piece)
            else:
                found.append(self._statement(piece.tokens))
        return tuple(found)

    def _statement(self, tokens: tuple[Token, ...]) -> syntax.Item:
        """Return the statement of a line that has no braces after it."""
        node = self._read(tokens)
        if isinstance(node, syntax.RepeatHead | syntax.ChooseHead):
            braces = "{ ... }" if isinstance(node, syntax.RepeatHead) else "{ ... | ... }"
            word = tokens[0].text
            self._say("MS013", f"`{word}` needs its statements in `{{ }}`", node.span, f"write `{braces}` after it")
            return syntax.Broken(node.span)
        if isinstance(node, syntax.Weight):
            message = "a weight stands at the beginning of a branch of `choose { }`"
            self._say("MS010", message, node.span, "take it out")
            return syntax.Broken(node.span)
        return node

    def _block(self, block: Block) -> list[syntax.Item]:
        """Return the item of a block; or, if nothing takes it, what stands in and before it."""
        if not block.head:
            self._say("MS013", "this `{` has no `repeat` or `choose` before it", block.brace, "take the braces out")
            return self._flattened(block)
        head = self._head(block)
        if isinstance(head, syntax.ChooseHead):
            branches = tuple(self._branch(branch, block.span) for branch in block.branches)
            return [syntax.Choose(head, branches, block.span)]
        if isinstance(head, syntax.RepeatHead):
            return [syntax.Repeat(head, self._body(block.branches[0], False), block.span)]
        if isinstance(head, syntax.Broken):
            return [head, *self._flattened(block)]
        self._say("MS013", "only `repeat` and `choose` are followed by `{`", block.brace, "take the braces out")
        return [
            syntax.Broken(head.span) if isinstance(head, syntax.Weight) else head,
            *self._flattened(block),
        ]

    def _head(self, block: Block) -> syntax.Line | syntax.Broken:
        """Return what stands before a brace, also if that is said as in other languages."""
        if block.head[0].type in ("REPEAT", "CHOOSE"):
            return self._read(block.head)
        from mlmg_lang.parsing.mistakes.blocks import other_head

        mistake = other_head(block.head, block.brace)
        if mistake is None:
            return self._read(block.head)
        self.diagnostics.append(mistake.diagnostic)
        span = Span(block.head[0].span.start, block.head[-1].span.end)
        return syntax.Broken(span) if mistake.meant is None else self._read(mistake.meant)

    def _body(self, pieces: Iterable[Line | Block], in_choose: bool) -> tuple[syntax.Item, ...]:
        """Return the items in the braces of a `repeat` or `choose`."""
        outside, self._in_choose = self._in_choose, in_choose
        items = self.items(pieces)
        self._in_choose = outside
        return items

    def _flattened(self, block: Block) -> list[syntax.Item]:
        return [item for branch in block.branches for item in self.items(branch)]

    def _branch(self, pieces: Sequence[Line | Block], block: Span) -> syntax.Branch:
        """Return a branch of `choose`, with its weight if its first line is one."""
        weight, first = None, pieces[0] if pieces else None
        if isinstance(first, Line) and [token.type for token in first.tokens] == ["INTEGER", "COLON"]:
            weight = syntax.Weight(first.tokens[0].text, Span(first.tokens[0].span.start, first.tokens[1].span.end))
            pieces = pieces[1:]
        body = self._body(pieces, True)
        parts = [*([weight] if weight else []), *body]
        span = Span(parts[0].span.start, parts[-1].span.end) if parts else Span(block.end, block.end)
        return syntax.Branch(weight, body, span)

    def _read(self, tokens: tuple[Token, ...]) -> syntax.Line | syntax.Broken:
        """Return the node of a line, mended as far as one can tell what was meant."""
        span = Span(tokens[0].span.start, tokens[-1].span.end)
        if len(self.diagnostics) >= MAX_MISTAKES:
            self._give_up(span)
            return syntax.Broken(span)
        deep = _too_deep(tokens)
        if deep is not None:
            message = f"parentheses and `not` are nested more than {MAX_DEPTH} deep here"
            self._say("MS005", message, deep.span, "take out those that say nothing")
            return syntax.Broken(span)
        if len(tokens) > MAX_STATEMENT:
            message = f"a statement may have at most {MAX_STATEMENT:,} words and signs"
            self._say("MS007", message, tokens[MAX_STATEMENT].span, "say it in several statements")
            return syntax.Broken(span)
        return self._mended(tuple(_as_names(tokens))) or syntax.Broken(span)

    def _mended(self, tokens: tuple[Token, ...]) -> syntax.Line | None:
        """Parse; while the parser is stuck, say why and go on with what was meant, if that leads further."""
        left = len(tokens) + 1
        outcome = read(self._source, tokens, self._in_choose)
        while isinstance(outcome, Stuck):
            if outcome.left >= left:
                return None
            left = outcome.left
            mistake = self._explained(outcome)
            self.diagnostics.append(mistake.diagnostic)
            if mistake.meant is None:
                return None
            outcome = read(self._source, mistake.meant, self._in_choose)
        return outcome

    def _explained(self, stuck: Stuck) -> Mistake:
        # Most scripts have no such mistake, and these modules take as long to import as a small script to parse.
        from mlmg_lang.parsing.mistakes import Mistake, explain

        if len(stuck.tokens) > _MAX_MENDED:
            message = "something does not fit here, in a statement too long to look into"
            return Mistake(Diagnostic("MS010", message, stuck.span))
        return explain(stuck)

    def _give_up(self, span: Span) -> None:
        if self.diagnostics[-1].code != "MS006":
            message = f"more than {MAX_MISTAKES} mistakes; what comes after this is not read"
            self._say("MS006", message, span, "is this file a script?")

    def _say(self, code: str, message: str, span: Span, help_: str) -> None:
        self.diagnostics.append(Diagnostic(code, message, span, help=help_))


def _as_names(tokens: Iterable[Token]) -> Iterable[Token]:
    """Yield tokens with unclosed names, which have been reported, as if they were closed."""
    return (replace(token, type="STRING") if token.type == "UNCLOSED" else token for token in tokens)


def _too_deep(tokens: Iterable[Token]) -> Token | None:
    """Return the first parenthesis or `not` that is nested too deeply in others, if there is one."""
    depth = nots = 0
    outside: list[int] = []
    for token in tokens:
        if token.type in ("NOT", "LEFT"):
            depth += 1
            if depth > MAX_DEPTH:
                return token
        if token.type == "NOT":
            nots += 1
        elif token.type == "LEFT":
            outside.append(nots)
            nots = 0
        else:
            depth -= nots
            nots = 0
            if token.type == "RIGHT" and outside:
                depth -= 1 + outside.pop()
    return None
