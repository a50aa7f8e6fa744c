"""Tokens -> lines and blocks: where each statement begins and ends, and which braces hold it.

A line goes on inside matched parentheses, and where the next begins with `with and or for once`. A
parenthesis without a partner holds nothing together, so that forgetting one spoils its own line alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import accumulate
from typing import Final, TypeAlias

from mlmg_lang.diagnostics import Brace, Diagnostic, Fix
from mlmg_lang.parsing.foreign import means_choose, opens_block
from mlmg_lang.parsing.tokens import CONTINUES, ENDS_PARENTHESES, NUMBERS, OPENS_STATEMENT, Token
from mlmg_lang.source import Span

MAX_DEPTH = 64
"""How deep parentheses, `not` and braces may be nested, all together in a line, or braces alone."""
_BETWEEN: Final = frozenset({"NEWLINE", "COMMENT"})


@dataclass(frozen=True, slots=True)
class Line:
    """The tokens of one statement, or the weight of a branch; never empty."""

    tokens: tuple[Token, ...]


@dataclass(frozen=True, slots=True)
class Block:
    """What stands before `{`, and the branches in the braces: one, but for `choose`.

    Attributes
    ----------
    head : the tokens before the brace; empty where a brace has nothing before it.
    span : from the head to the closing brace.
    """

    head: tuple[Token, ...]
    branches: tuple[tuple[Line | Block, ...], ...]
    brace: Span
    span: Span


@dataclass(frozen=True, slots=True)
class Layout:
    """A script cut into lines."""

    items: tuple[Line | Block, ...]
    diagnostics: tuple[Diagnostic, ...]


@dataclass(frozen=True, slots=True)
class Open:
    """A brace that opens a block, and what stands before it."""

    head: tuple[Token, ...]
    brace: Span

    @property
    def chooses(self) -> bool:
        """Return whether `|` may part branches in these braces: where nothing takes them, nobody knows."""
        is_choice = any(token.type == "CHOOSE" or means_choose(token.text) for token in self.head)
        return is_choice or not opens_block(self.head)

    @property
    def start(self) -> int:
        """Return where the block begins."""
        return self.head[0].span.start if self.head else self.brace.start


@dataclass(frozen=True, slots=True)
class Bar:
    """What parts two branches."""

    span: Span


@dataclass(frozen=True, slots=True)
class Close:
    """A brace that closes a block."""

    span: Span


Mark: TypeAlias = Line | Open | Bar | Close


@dataclass(frozen=True, slots=True)
class Marked:
    """A text cut into lines and what holds them.

    Attributes
    ----------
    deep : whether braces are nested too deep: what stands in them is left out.
    """

    marks: tuple[Mark, ...]
    diagnostics: tuple[Diagnostic, ...]
    deep: bool


def lay_out(tokens: Sequence[Token]) -> Layout:
    """Return the lines and blocks of a script, and what is wrong with its braces."""
    marked = mark(tokens)
    end = next((token.span.end for token in reversed(tokens) if token.type not in _BETWEEN), 0)
    items, unclosed = _nested(marked.marks, end)
    return Layout(items, (*marked.diagnostics, *unclosed))


def mark(tokens: Sequence[Token], around: Sequence[bool] = ()) -> Marked:
    """Return the lines of some text, with the braces that hold them, as they stand one after the other.

    Parameters
    ----------
    around : of the blocks that the text stands in, from the outermost, whether `|` parts branches there.
    """
    cutter = _Cutter(around)
    for token, inside in zip(tokens, inside_parentheses(tokens), strict=True):
        if token.type == "NEWLINE":
            cutter.line_ended = cutter.line_ended or not inside
        elif token.type != "COMMENT":
            cutter.take(token)
    return cutter.finish()


def unclosed(brace: Span) -> Diagnostic:
    """Return what to say of a brace that opens a block to which there is no end."""
    advice = "write `}` where its statements end"
    return Diagnostic("MS013", "this `{` is never closed", brace, help=advice, brace=Brace.UNCLOSED)


def _nested(marks: Iterable[Mark], end: int) -> tuple[tuple[Line | Block, ...], list[Diagnostic]]:
    """Return lines and blocks, each in the block that it stands in, and what is wrong with those that do not end."""
    frames = [_Frame(Open((), Span(0, 0)))]
    for one in marks:
        match one:
            case Open():
                frames.append(_Frame(one))
            case Bar():
                frames[-1].branches.append([])
            case Close(span):
                block = frames.pop().block(span.end)
                frames[-1].branches[-1].append(block)
            case _:
                frames[-1].branches[-1].append(one)
    wrong = []
    while len(frames) > 1:
        frame = frames.pop()
        if frame.opened.head:  # else it is reported that the brace should not be there at all
            wrong.append(unclosed(frame.opened.brace))
        frames[-1].branches[-1].append(frame.block(end))
    return tuple(frames[0].branches[0]), wrong


def inside_parentheses(tokens: Sequence[Token]) -> Iterator[bool]:
    """Yield for each token whether a matched pair of parentheses is open before it."""
    steps = [0] * len(tokens)
    opened: list[int] = []
    first = True
    for at, token in enumerate(tokens):
        if token.type in ENDS_PARENTHESES or (first and token.type in OPENS_STATEMENT):
            opened.clear()
        elif token.type == "LEFT":
            opened.append(at)
        elif token.type == "RIGHT" and opened:
            steps[opened.pop()], steps[at] = 1, -1
        first = token.type == "NEWLINE" or (first and token.type == "COMMENT")
    return (depth > 0 for depth in accumulate(steps))


@dataclass(slots=True)
class _Frame:
    """A block that is being read, or the script itself."""

    opened: Open
    branches: list[list[Line | Block]] = field(default_factory=lambda: [[]])

    def block(self, end: int) -> Block:
        branches = tuple(tuple(branch) for branch in self.branches)
        return Block(self.opened.head, branches, self.opened.brace, Span(self.opened.start, end))


class _Cutter:
    """Takes one token after the other; knows the line, and of the blocks that are open whether `|` parts branches."""

    def __init__(self, around: Sequence[bool]) -> None:
        self.line_ended = False
        self._line: list[Token] = []
        self._marks: list[Mark] = []
        self._chooses = list(around)
        self._too_deep = 0
        self._was_too_deep = False
        self._diagnostics: list[Diagnostic] = []

    def take(self, token: Token) -> None:
        """Put a token where it belongs."""
        if token.type == "OPEN":
            self._open(token)
        elif token.type == "CLOSE":
            self._close(token)
        elif self._too_deep == 0:
            self._take_inside(token)
        self.line_ended = False

    def _take_inside(self, token: Token) -> None:
        if self.line_ended and token.type not in CONTINUES:
            self._end_line()
        if token.type == "SEMICOLON":
            self._end_line()
        elif token.type == "BAR" and self._chooses and self._chooses[-1]:
            self._end_line()
            self._marks.append(Bar(token.span))
        else:
            self._line.append(token)
            if token.type == "COLON" and self._is_weight():
                self._end_line()

    def _is_weight(self) -> bool:
        """Return whether the line is the weight of a branch, or meant for one with a word or sign too many."""
        *before, _ = self._line[:4]
        if len(self._line) <= 2 and self._line[0].type == "INTEGER":
            return True
        in_choice = bool(self._chooses) and self._chooses[-1]
        return in_choice and len(before) == 2 and any(token.type in NUMBERS for token in before)

    def finish(self) -> Marked:
        """End the last line, and return all."""
        self._end_line()
        return Marked(tuple(self._marks), tuple(self._diagnostics), self._was_too_deep)

    def _open(self, token: Token) -> None:
        if len(self._chooses) >= MAX_DEPTH:
            if self._too_deep == 0:
                message = f"braces are nested more than {MAX_DEPTH} deep here"
                self._diagnostics.append(Diagnostic("MS005", message, token.span))
            self._too_deep += 1
            self._was_too_deep = True
            return
        if self.line_ended and self._line:
            self._join_or_end(token)
        opened = Open(tuple(self._line), token.span)
        self._marks.append(opened)
        self._chooses.append(opened.chooses)
        self._line = []

    def _join_or_end(self, token: Token) -> None:
        """Take a brace on a line of its own to belong to the head above, if there is one, and say so."""
        if self._line[0].text.lower() not in ("repeat", "choose"):
            self._end_line()
            return
        gap = Span(self._line[-1].span.end, token.span.start)
        self._say(
            f"`{{` must stand on the same line as its `{self._line[0].text}`",
            token.span,
            "put it at the end of the line above",
            Fix(gap, " ", safe=False),
        )

    def _close(self, token: Token) -> None:
        if self._too_deep:
            self._too_deep -= 1
            return
        self._end_line()
        if not self._chooses:
            message, fix = "this `}` closes nothing", Fix(token.span, "", safe=False)
            told = Diagnostic("MS013", message, token.span, "take it out", fixes=(fix,), brace=Brace.UNOPENED)
            self._diagnostics.append(told)
        else:
            self._chooses.pop()
            self._marks.append(Close(token.span))

    def _end_line(self) -> None:
        if self._line:
            self._marks.append(Line(tuple(self._line)))
            self._line = []

    def _say(self, message: str, span: Span, help: str, *fixes: Fix) -> None:
        self._diagnostics.append(Diagnostic("MS013", message, span, help=help, fixes=fixes))
