"""The definition of Motion Script's syntax: `motion_script.lark`, and the one door to it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from copy import copy
from functools import lru_cache
from pkgutil import get_data
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lark import Lark, Token, Transformer
    from lark.lexer import BasicLexer

LINE = "line"
SCRIPT = "script"
_STARTS = (LINE, "unparsed")


def grammar_text() -> str:
    """Return the grammar, in the notation of lark."""
    return _kept("motion_script.lark")


def _kept(name: str) -> str:
    data = get_data(__name__, name)
    assert data is not None, f"{name} is part of this package"
    return data.decode("utf-8")


def load(transformer: Transformer[Token, Any] | None = None) -> Lark:
    """Return an LALR(1) parser of the grammar for `LINE`, and its lexer.

    Its tables are those that are kept beside the grammar, as long as they are of this grammar and this lark.

    Parameters
    ----------
    transformer : what makes a node of each rule when it is reduced; without one, lark's own trees are made.
    """
    from mlmg_grammar.tables import FILE, language_from_tables

    language = language_from_tables(_kept(FILE), grammar_text(), transformer)
    return language or make(transformer)


def make(transformer: Transformer[Token, Any] | None = None, starts: Sequence[str] = _STARTS) -> Lark:
    """Return the same, made afresh.

    Parameters
    ----------
    starts : the rules from which a text may be parsed; `unparsed` keeps the terminals no other rule uses.
    """
    from lark import Lark

    return Lark(grammar_text(), parser="lalr", lexer="basic", start=list(starts), transformer=transformer)


def scan(language: Lark, text: str) -> Iterator[Token]:
    """Yield every token of a text, comments and white space too. Whatever the text, this does not fail."""
    from lark.lexer import LexerThread

    lexing = LexerThread.from_text(_lexer(language), text)
    return lexing.lex(None)  # type: ignore[no-untyped-call, no-any-return]


@lru_cache(maxsize=2)
def _lexer(language: Lark) -> BasicLexer:
    """Return the lexer that `Lark.lex` would make anew for each text, which takes longer than to scan a line."""
    from lark.lexer import BasicLexer

    conf = copy(language.lexer_conf)
    conf.ignore = ()
    return BasicLexer(conf)


@lru_cache(maxsize=2)
def reserved_words(language: Lark) -> Mapping[str, str]:
    """Return the words that cannot be names, each with the terminal that it is."""
    terminals = ((terminal.pattern.value, terminal.name) for terminal in language.terminals)
    return MappingProxyType({text: name for text, name in terminals if text.isalpha()})


def is_name(text: str) -> bool:
    """Return whether a text can be a name without quotes: Unicode's identifiers, with single `-` inside."""
    head, *tail = text.split("-")
    return head.isidentifier() and all(f"_{part}".isidentifier() and part for part in tail)
