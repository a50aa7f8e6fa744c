"""Tokens -> lines and blocks: where each statement begins and ends, and which braces hold it.

A line goes on inside matched parentheses, and where the next begins with `with and or for once`. A
parenthesis without a partner holds nothing together, so that forgetting one spoils its own line alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import accumulate

from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing.foreign import means_choose
from mlmg_lang.parsing.tokens import CONTINUES, ENDS_PARENTHESES, OPENS_STATEMENT, Token
from mlmg_lang.source import Span

MAX_DEPTH = 64
"""How deep parentheses, `not` and braces may be nested, all together in a line, or braces alone."""


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


def lay_out(tokens: Sequence[Token]) -> Layout:
    """Return the lines and blocks of a script, and what is wrong with its braces."""
    cutter = _Cutter()
    for token, inside in zip(tokens, inside_parentheses(tokens), strict=True):
        if token.type == "NEWLINE":
            cutter.line_ended = cutter.line_ended or not inside
        elif token.type != "COMMENT":
            cutter.take(token)
    return cutter.finish()


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

    head: tuple[Token, ...]
    brace: Span
    branches: list[list[Line | Block]] = field(default_factory=lambda: [[]])

    @property
    def chooses(self) -> bool:
        return bool(self.head) and means_choose(self.head[0].text)


class _Cutter:
    """Takes one token after the other; knows the line and the blocks that are open."""

    def __init__(self) -> None:
        self.line_ended = False
        self._line: list[Token] = []
        self._frames = [_Frame((), Span(0, 0))]
        self._too_deep = 0
        self._end = 0
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
        self._end = token.span.end

    def _take_inside(self, token: Token) -> None:
        if self.line_ended and token.type not in CONTINUES:
            self._end_line()
        if token.type == "SEMICOLON":
            self._end_line()
        elif token.type == "BAR" and self._frames[-1].chooses:
            self._end_line()
            self._frames[-1].branches.append([])
        else:
            self._line.append(token)
            if token.type == "COLON" and [part.type for part in self._line] == ["INTEGER", "COLON"]:
                self._end_line()

    def finish(self) -> Layout:
        """End what is still open, and return all."""
        self._end_line()
        while len(self._frames) > 1:
            frame = self._frames[-1]
            if frame.head:  # else it is reported that the brace should not be there at all
                self._say("this `{` is never closed", frame.brace, "write `}` where its statements end")
            self._end_block(self._end)
        return Layout(tuple(self._frames[0].branches[0]), tuple(self._diagnostics))

    def _open(self, token: Token) -> None:
        if len(self._frames) > MAX_DEPTH:
            if self._too_deep == 0:
                message = f"braces are nested more than {MAX_DEPTH} deep here"
                self._diagnostics.append(Diagnostic("MS005", message, token.span))
            self._too_deep += 1
            return
        if self.line_ended and self._line:
            self._join_or_end(token)
        self._frames.append(_Frame(tuple(self._line), token.span))
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
        if len(self._frames) == 1:
            self._say("this `}` closes nothing", token.span, "take it out", Fix(token.span, "", safe=False))
        else:
            self._end_block(token.span.end)

    def _end_line(self) -> None:
        if self._line:
            self._frames[-1].branches[-1].append(Line(tuple(self._line)))
            self._line = []

    def _end_block(self, end: int) -> None:
        frame = self._frames.pop()
        start = frame.head[0].span.start if frame.head else frame.brace.start
        branches = tuple(tuple(branch) for branch in frame.branches)
        self._frames[-1].branches[-1].append(Block(frame.head, branches, frame.brace, Span(start, end)))

    def _say(self, message: str, span: Span, help: str, *fixes: Fix) -> None:
        self._diagnostics.append(Diagnostic("MS013", message, span, help=help, fixes=fixes))
