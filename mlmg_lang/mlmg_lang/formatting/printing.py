"""Lines and blocks, and the comments between their tokens -> the rows of a page."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from mlmg_lang.formatting.page import Page
from mlmg_lang.formatting.pieces import Piece, beginning, is_weight, span, statements, would_go_on
from mlmg_lang.formatting.soundness import Soundness
from mlmg_lang.formatting.words import Words, shortest_number, words_of
from mlmg_lang.formatting.wrapping import INDENT, WIDTH, Row, columns, wrap
from mlmg_lang.parsing.layout import Block, Layout, Line
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source, Span

_BAR_INDENT: Final = INDENT - 2
_TO_COMPILER: Final = re.compile(r"#\s*mlmg\s*:")
_LINE_END: Final = re.compile(r"\r\n|\r|\n")


class Printer:
    """Goes through the tokens of a script from beginning to end, along its lines and blocks.

    Attributes
    ----------
    kept : whether something was kept as written, because it cannot be read.
    """

    def __init__(
        self,
        source: Source,
        tokens: Sequence[Token],
        layout: Layout,
        words: Words | None = None,
        known: dict[tuple[str, ...], bool] | None = None,
        strays: Sequence[Span] = (),
    ) -> None:
        """Take a script, its tokens and how they fall into lines and blocks.

        Parameters
        ----------
        words : of the script that this is a piece of; else they are found in it.
        known : see `Soundness`.
        strays : the places of signs that are in no line.
        """
        self._source = source
        self._tokens = tokens
        self._layout = layout
        self._strays = frozenset(strays)
        self.kept = False
        self._at = 0  # the first token that has not been written yet
        self._page = Page()
        self._top = 0  # the row in which the last statement begins
        self._sound = Soundness(source, tokens, layout, {} if known is None else known, strays)
        self._words = words or words_of(statements(layout.items))

    def script(self) -> str:
        """Return the text of all."""
        begin = self._keep_beginning()
        self._body([piece for piece in self._layout.items if span(piece).start >= begin], 0)
        return self._page.text()

    # --- what blocks cannot be told of ---

    def _keep_beginning(self) -> int:
        """Keep all up to the last `}` that closes nothing, and return where it ends."""
        wrong = (one.span for one in self._layout.diagnostics if one.span is not None)
        end = max((brace.end for brace in wrong if self._source.slice(brace) == "}"), default=0)
        if end:
            first = next(token.span.start for token in self._tokens if token.type != "NEWLINE")
            line = max(self._source.text.rfind(sign, 0, first) for sign in "\r\n") + 1
            self._keep(Span(line, end), 0)
        return end

    def _keep_block(self, block: Block, indent: int) -> None:
        """Keep a block; one that is nowhere closed reaches to the end, comments included."""
        first, end = self._at, block.span.end
        self._skip(end)
        inside = [token.type for token in self._tokens[first : self._at] if token.span not in self._strays]
        if inside.count("OPEN") > inside.count("CLOSE"):
            end = next(token.span.end for token in reversed(self._tokens) if token.type != "NEWLINE")
        self._keep(Span(block.span.start, end), indent)

    def _keep(self, stretch: Span, indent: int) -> None:
        """Write a stretch as it stands."""
        self.kept = True
        first, *others = _LINE_END.split(self._source.slice(stretch))
        self._top = self._page.add([Row(indent, first), *(Row(0, other) for other in others)])
        self._skip(stretch.end)

    def _skip(self, end: int) -> None:
        while self._at < len(self._tokens) and self._tokens[self._at].span.start < end:
            self._at += 1

    # --- bodies ---

    def _body(self, pieces: Sequence[Piece], indent: int, is_branch: bool = False) -> None:
        """Write the statements of a body, with the comments before, between and behind them."""
        parted = self._parted(pieces)
        before: Piece | None = None
        for n, piece in enumerate(pieces):
            self._between(indent, before, n in parted or would_go_on(piece))
            before = piece
            if isinstance(piece, Block):
                self._block(piece, indent)
            elif is_branch and n == 0 and is_weight(piece):
                self._weight(piece, indent)
                before = None
            else:
                self._line(piece, indent)
        self._between(indent, before, False)

    def _between(self, indent: int, before: Piece | None, parted: bool) -> None:
        """Write what stands before the next statement or brace.

        Parameters
        ----------
        before : the last statement of the body, if there is one.
        parted : whether it would run into what follows it without the `;` behind it.
        """
        line_ends = run = 0
        while self._at < len(self._tokens):
            token = self._tokens[self._at]
            if token.type == "NEWLINE":
                line_ends, run = line_ends + 1, run + 1
                if run == 2:
                    self._page.blank()
            elif token.type == "COMMENT":
                self._comment(token.text.rstrip(), indent, line_ends == 0, before)
                run = 0
            elif token.type == "SEMICOLON":
                if parted and isinstance(before, Line):
                    self._semicolon(before, indent)
                parted, run = False, 0
            else:
                return
            self._at += 1

    def _comment(self, text: str, indent: int, trails: bool, before: Piece | None) -> None:
        """Write a comment; one to the compiler about the line of a statement that gets more lines is put above it."""
        if trails and before is not None and _TO_COMPILER.match(text) and self._gets_lines(before):
            self._page.comment_above(self._top, indent, text)
        else:
            self._page.comment(indent, text, trails)

    def _gets_lines(self, piece: Piece) -> bool:
        """Return whether the last piece stood in one line, and stands in several now."""
        return self._top < self._page.last_code and not _LINE_END.search(self._source.slice(span(piece)))

    def _semicolon(self, line: Line, indent: int) -> None:
        if line.tokens[-1].type == "UNCLOSED":  # it would swallow the sign
            self._page.add([Row(indent, ";")])
        else:
            self._page.separate()

    def _parted(self, pieces: Sequence[Piece]) -> range:
        """Return the pieces before which a `;` has to stay, for it keeps parentheses from finding each other."""
        odd = [() if isinstance(piece, Line) and self._is_sound(piece) else beginning(piece) for piece in pieces]
        left = [n for n, tokens in enumerate(odd) if any(token.type == "LEFT" for token in tokens)]
        right = [n for n, tokens in enumerate(odd) if any(token.type == "RIGHT" for token in tokens)]
        return range(left[0] + 1, right[-1] + 1) if left and right else range(0)

    def _is_sound(self, line: Line) -> bool:
        return self._sound.line(line.tokens)

    # --- statements ---

    def _line(self, line: Line, indent: int) -> None:
        begin, whole = self._at, span(line)
        if self._is_sound(line):
            self._skip(whole.end)
            texts = self._words.written(line.tokens)
            self._top = self._page.add(wrap(self._tokens[begin : self._at], texts, indent, self._taken(indent)))
        elif is_weight(line) and self._goes_on(begin + 2):
            self.kept = True
            self._skip(whole.end)
            self._page.lead_with(indent, self._source.slice(whole))
        else:
            self._keep(whole, indent)

    def _weight(self, line: Line, indent: int) -> None:
        self._skip(line.tokens[-1].span.end)
        self._page.lead_with(indent, f"{shortest_number(line.tokens[0].text)}:")

    def _goes_on(self, at: int) -> bool:
        """Return whether the statement that begins at a token stands in the line of the last one."""
        return at < len(self._tokens) and self._tokens[at].type not in ("NEWLINE", "COMMENT", "SEMICOLON", "CLOSE")

    def _taken(self, indent: int) -> int:
        """Return how many columns what leads a statement takes of its first line, beyond the indentation."""
        lead = self._page.lead
        return lead.indent + columns(lead.code) + 1 - indent if lead.code else 0

    # --- blocks ---

    def _block(self, block: Block, indent: int) -> None:
        if not self._sound.block(block):
            self._keep_block(block, indent)
            return
        head = "".join(self._words.written(block.head))
        short = self._short(block, head)
        if short is not None and indent + self._taken(indent) + columns(short) <= WIDTH:
            self._skip(block.span.end)
            self._top = self._page.add([Row(indent, short)])
            return
        self._skip(block.brace.end)
        top = self._page.open(Row(indent, f"{head} {{"))
        chooses = block.head[0].type == "CHOOSE"
        for n, branch in enumerate(block.branches):
            if n:
                self._page.lead_with(indent + _BAR_INDENT, "|")
                self._at += 1
            self._body(branch, indent + INDENT, chooses)
        self._page.close(indent)
        self._at += 1
        self._top = top

    def _short(self, block: Block, head: str) -> str | None:
        """Return a block in one line, if it is a choice of single statements, or nothing stands in it."""
        if block.head[0].type == "REPEAT" and block.branches[0]:
            return None
        words = [head, "{"]
        for n, branch in enumerate(block.branches):
            written = self._short_branch(branch)
            if written is None:
                return None
            words += ["|"] * (n > 0) + written
        return None if self._has_comment(block.span.end) else " ".join([*words, "}"])

    def _short_branch(self, branch: Sequence[Piece]) -> list[str] | None:
        """Return the weight and the one statement of a branch, as far as they are there."""
        first = branch[0] if branch else None
        weight = []
        if isinstance(first, Line) and is_weight(first):
            weight = [f"{shortest_number(first.tokens[0].text)}:"]
            branch = branch[1:]
        if not branch:
            return weight
        (line, *others) = branch
        if others or isinstance(line, Block) or not self._is_sound(line):
            return None
        return [*weight, "".join(self._words.written(line.tokens))]

    def _has_comment(self, end: int) -> bool:
        """Return whether a comment stands between here and an offset."""
        at = self._at
        while self._tokens[at].span.start < end - 1 and self._tokens[at].type != "COMMENT":
            at += 1
        return self._tokens[at].type == "COMMENT"
