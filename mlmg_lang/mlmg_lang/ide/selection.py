"""An analysis and a place -> ever larger stretches of text around it, as one wants to select them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import Final

from mlmg_grammar.roles import ROLES, Role
from mlmg_lang.analysis import Analysis
from mlmg_lang.blocks import WholeBlock
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.layout import Block, Line, lay_out
from mlmg_lang.pieces import Piece
from mlmg_lang.source import Span

_NO_WORDS: Final = frozenset({Role.SPACE, Role.SIGN})


def selection(analysis: Analysis, offset: int) -> tuple[Span, ...]:
    """Return the stretches around an offset: word, expression, operand, command, block, and so on up to the file.

    Each holds the one before it and is larger. There is always one, the whole file, which an offset outside is moved
    into. What cannot be read is gone through by its words, lines and braces alone.
    """
    made = analysis.made
    whole = Span(0, len(made.source.text))
    offset = min(max(offset, 0), whole.end)
    spans = {whole}
    if made.pieces:
        at = made.places.piece_at(offset)
        piece, further = made.pieces[at], made.places.starts[at] - made.pieces[at].address
        spans |= {one.shifted(further) for one in _around(piece, offset - further)}
    ordered = sorted(spans, key=lambda span: (span.end - span.start, span))
    return tuple(_nested(ordered))


def _nested(spans: Iterable[Span]) -> Iterator[Span]:
    """Yield spans, from the smallest, without those that do not hold all before them."""
    held: Span | None = None
    for span in spans:
        if held is None or (span.start <= held.start and held.end <= span.end):
            held = span
            yield span


def _around(piece: Piece | WholeBlock, address: int) -> Iterator[Span]:
    """Yield what of a piece is around an address, in no order."""
    words = (token.span for token in piece.tokens if ROLES[token.type] not in _NO_WORDS)
    yield from (span for span in words if _holds(span, address))
    closing = frozenset(token.span.end for token in piece.tokens if token.type == "CLOSE")
    yield from _laid_out(lay_out(piece.tokens).items, address, closing)
    for item in piece.items:
        yield from _in_node(item, address)


def _in_node(node: syntax.Node, address: int) -> Iterator[Span]:
    """Yield the places of the nodes around an address, and of what stands in their parentheses."""
    if not _holds(node.span, address):
        return
    yield node.span
    if isinstance(node, syntax.Call) and node.arguments and node.name.span.end < address:
        inside = Span(node.arguments[0].span.start, node.arguments[-1].span.end)
        yield from (inside,) if _holds(inside, address) else ()
    if isinstance(node, syntax.With | syntax.Or | syntax.And):
        yield from _heads(node, address)
    for child in syntax.children(node):
        yield from _in_node(child, address)


def _heads(node: syntax.With | syntax.Or | syntax.And, address: int) -> Iterator[Span]:
    """Yield the operands up to the one at an address: what an operator to the right of it is applied to."""
    for operand in node.operands[1:-1]:
        if _holds(operand.span, address):
            yield Span(node.operands[0].span.start, operand.span.end)


def _laid_out(items: Iterable[Line | Block], address: int, closing: Collection[int]) -> Iterator[Span]:
    """Yield the lines and blocks around an address, and what is between the braces of blocks.

    Parameters
    ----------
    closing : where closing braces end; a block without its own ends elsewhere.
    """
    for item in items:
        if isinstance(item, Line):
            span = Span(item.tokens[0].span.start, item.tokens[-1].span.end)
            yield from (span,) if _holds(span, address) else ()
        elif _holds(item.span, address):
            yield item.span
            inside = Span(item.brace.end, item.span.end - (item.span.end in closing))
            yield from (inside,) if _holds(inside, address) else ()
            for branch in item.branches:
                yield from _laid_out(branch, address, closing)


def _holds(span: Span, address: int) -> bool:
    return span.start <= address <= span.end
