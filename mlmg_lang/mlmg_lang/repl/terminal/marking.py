"""A line that is being typed -> its pieces with their styles: what each token is, and what is wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from types import MappingProxyType
from typing import Final

from prompt_toolkit.document import Document
from prompt_toolkit.formatted_text import StyleAndTextTuples
from prompt_toolkit.lexers import Lexer

from mlmg_grammar import scan
from mlmg_grammar.roles import Role, roles
from mlmg_lang.diagnostics import Diagnostic, Severity
from mlmg_lang.ide.cursor import is_open
from mlmg_lang.parsing.build_syntax import motion_script
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.repl.conversation import is_dotted
from mlmg_lang.repl.desk import Desk
from mlmg_lang.source import Source, Span

_CLASSES: Final[Mapping[Role, str]] = MappingProxyType(
    {
        Role.COMMENT: "class:comment",
        Role.DECLARATION: "class:word",
        Role.IMPORT: "class:word",
        Role.STATEMENT: "class:word",
        Role.JOINER: "class:word",
        Role.CLAUSE: "class:word",
        Role.RESERVED: "class:word",
        Role.NUMBER: "class:number",
        Role.UNIT: "class:unit",
        Role.QUOTED: "class:name",
        Role.NAME: "class:name",
        Role.GRAPH: "class:graph",
        Role.CALL: "class:definition",
        Role.DEFINED: "class:definition",
        Role.PARAMETER: "class:parameter",
        Role.WRONG: "class:wrong",
    }
)
MOST_CHECKED: Final = 2_000
"""Longer texts, in code points, are coloured but not checked while they are typed."""
MOST_COLOURED: Final = 20_000
"""Still longer ones are shown as they are: all of this is done at each key."""
_UNCLOSED: Final = frozenset({"MS012", "MS013"})
_UNFINISHED: Final = _UNCLOSED | {"MS010", "MS014", "MS016", "MS017", "MS024"}
"""What is said of a statement that ends too early."""
_UNDERLINES: Final = {Severity.ERROR: " class:error", Severity.WARNING: " class:warning", Severity.HINT: " class:hint"}


@dataclass(frozen=True)
class ScriptLexer(Lexer):
    """Colours what is typed by the language's own tokens, and underlines what is wrong with it."""

    desk: Desk
    _known: dict[tuple[object, ...], list[StyleAndTextTuples]] = field(default_factory=dict)

    def lex_document(self, document: Document) -> Callable[[int], StyleAndTextTuples]:
        """Return what gives the pieces of a line."""
        key = (document.text, document.cursor_position, self.desk.session, self.desk.session.turns)
        if key not in self._known:
            self._known.clear()
            self._known[key] = self._lines(document)
        lines = self._known[key]
        return lambda number: lines[number] if number < len(lines) else []

    def _lines(self, document: Document) -> list[StyleAndTextTuples]:
        if is_dotted(document.text):
            return [[("class:dot", line)] for line in document.lines]
        if len(document.text) > MOST_COLOURED:
            return [[("", line)] for line in document.lines]
        lines: list[StyleAndTextTuples] = [[]]
        for style, text in self._pieces(document):
            first, *others = text.split("\n")
            lines[-1].append((style, first))
            lines += [[(style, other)] for other in others]
        return lines

    def _pieces(self, document: Document) -> Iterator[tuple[str, str]]:
        """Yield stretches of text with the same style."""
        text, marks = document.text, self._marks(document)
        start = 0
        for token, role in roles(scan(motion_script(), text)):
            style = _CLASSES.get(role, "")
            bounds = sorted({start, start + len(token), *(at for at in marks if start < at < start + len(token))})
            for begin, end in pairwise(bounds):
                yield style + marks.get(_last_before(marks, begin), ""), text[begin:end]
            start += len(token)

    def _marks(self, document: Document) -> dict[int, str]:
        """Return where underlining changes, and to what."""
        if len(document.text) > MOST_CHECKED:
            return {0: ""}
        told = self.desk.session.analyse(document.text).diagnostics
        wrong = [
            (one.span, one.severity) for one in told if one.span is not None and _is_certain(one, one.span, document)
        ]
        marks = {0: ""}
        for span, severity in sorted(wrong, reverse=True):
            marks[span.end] = marks.get(span.end, "")
            marks[span.start] = _UNDERLINES[severity]
        return marks


def _is_certain(one: Diagnostic, span: Span, document: Document) -> bool:
    """Return whether a mistake in a stretch is not that a word, or a statement at the end, is still being typed."""
    text, cursor = document.text, document.cursor_position
    if span.start <= cursor <= span.end:
        return False
    if text[cursor:].strip():
        return True
    goes_on = not text[span.end : cursor].strip() or (one.code in _UNCLOSED and is_open(tokenize(Source(text))))
    return not (goes_on and one.code in _UNFINISHED)


def _last_before(marks: Mapping[int, str], at: int) -> int:
    return max(mark for mark in marks if mark <= at)
