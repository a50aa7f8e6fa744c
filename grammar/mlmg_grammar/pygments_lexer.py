"""Motion Script for Pygments, and so for whatever colours text by it: documentation, notebooks, terminals."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import ClassVar, Final

from pygments.lexer import Lexer
from pygments.token import (
    Comment,
    Error,
    Keyword,
    Name,
    Number,
    Punctuation,
    String,
    Whitespace,
    _TokenType,
)

from mlmg_grammar import load, scan
from mlmg_grammar.roles import Role, roles

TOKENS: Final[Mapping[Role, _TokenType]] = MappingProxyType(
    {
        Role.SPACE: Whitespace,
        Role.COMMENT: Comment.Single,
        Role.DECLARATION: Keyword.Declaration,
        Role.IMPORT: Keyword.Namespace,
        Role.STATEMENT: Keyword,
        Role.JOINER: Keyword,
        Role.CLAUSE: Keyword,
        Role.RESERVED: Keyword.Reserved,
        Role.NUMBER: Number,
        Role.UNIT: Keyword.Type,
        Role.NAME: Name,
        Role.QUOTED: String.Double,
        Role.GRAPH: Name.Class,
        Role.CALL: Name.Function,
        Role.DEFINED: Name.Function,
        Role.PARAMETER: Name.Variable,
        Role.SIGN: Punctuation,
        Role.WRONG: Error,
    }
)
"""What Pygments calls each role."""

_LASTS: Final = re.compile(
    r"^[^#\n]*\b(?:for|wait)[ \t]+\d+(?:\.\d+)?[ \t]*(?:sec|ms|min|frames|cycles)\b", re.MULTILINE
)


class MotionScriptLexer(Lexer):
    """Cuts scripts into tokens as the compiler does: by the grammar itself. Whatever the text, this does not fail."""

    name = "Motion Script"
    aliases: ClassVar = ["motion-script", "mlmg"]
    filenames: ClassVar = ["*.ms"]
    mimetypes: ClassVar = ["text/x-motion-script"]

    def __init__(self, **options: object) -> None:
        """Take the options of every lexer of Pygments."""
        super().__init__(**options)
        self._language = load()

    def get_tokens_unprocessed(self, text: str) -> Iterator[tuple[int, _TokenType, str]]:
        """Yield the place, the kind and the text of every token; the texts together are `text`."""
        at = 0
        for token, role in roles(scan(self._language, text)):
            yield at, TOKENS[role], str(token)
            at += len(token)

    @staticmethod
    def analyse_text(text: str) -> float:
        """Return how surely a text is a script of ours: other languages' files end in `.ms` too."""
        return 0.5 if _LASTS.search(text) else 0.0
