"""The text of the grammar -> its rules, terminals and comments, as values. Lark's notation, as far as it is used."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from mlmg_grammar.expressions import Expression, Optional, Pattern, Repeat, Symbol, Text, choice, sequence

_DEFINITION: Final = re.compile(r"[?!]?(?P<name>_?[A-Za-z]\w*)(?:\.-?\d+)?\s*:(?P<body>.*)")
_PIECE: Final = re.compile(r"""\s*(?P<piece>->\s*\w+|"(?:[^"\\]|\\.)*"|/(?:[^/\\\n]|\\.)+/|\w+|[][()|*+?])""")


@dataclass(frozen=True, slots=True)
class Definition:
    """A rule or a terminal."""

    name: str
    expression: Expression


@dataclass(frozen=True, slots=True)
class Section:
    """A part of the grammar.

    Attributes
    ----------
    title : of the first part, nothing.
    remarks : the lines of the comment below the title, as Markdown.
    """

    title: str
    remarks: tuple[str, ...]
    definitions: tuple[Definition, ...]


def sections(grammar: str) -> tuple[Section, ...]:
    """Return the parts of a grammar, each begun by a comment `// # TITLE`.

    Raises
    ------
    ValueError
        If a definition is not in the notation; the message has it.
    """
    found: list[Section] = []
    for part in re.split(r"^// # ", f"// # \n{grammar}", flags=re.MULTILINE)[1:]:
        title, _, rest = part.partition("\n")
        remarks = _opening_comment(rest)
        found.append(Section(title, remarks, tuple(_definitions(rest))))
    return tuple(found)


def definitions(grammar: str) -> dict[str, Expression]:
    """Return every rule and terminal of a grammar by its name, in the order of the text."""
    return {one.name: one.expression for section in sections(grammar) for one in section.definitions}


def _opening_comment(text: str) -> tuple[str, ...]:
    """Return the comment lines with which a text begins."""
    lines = []
    for line in text.lstrip("\n").split("\n"):
        if not line.startswith("//"):
            break
        lines.append(line.removeprefix("//").removeprefix(" "))
    while lines and not lines[0]:
        lines.pop(0)
    return tuple(lines)


def _definitions(text: str) -> Iterator[Definition]:
    """Yield the rules and terminals of a text; one goes on in the lines that begin with white space."""
    lines = (line for line in text.split("\n") if line.strip() and not line.startswith(("//", "%")))
    for whole in re.split(r"\n(?!\s)", "\n".join(lines)):
        match = _DEFINITION.fullmatch(whole.replace("\n", " "))
        if match is None:
            if whole:
                raise ValueError(f"expected `name : what it is`, found `{whole}`")
            continue
        yield Definition(match["name"], _Reader(match["body"]).whole())


class _Reader:
    """Reads the right side of a definition, one piece after the other."""

    def __init__(self, body: str) -> None:
        self._body = body
        self._pieces = [match["piece"] for match in _PIECE.finditer(body)]
        if _PIECE.sub("", body).strip():
            raise ValueError(f"expected the notation of a rule, found `{body}`")

    def whole(self) -> Expression:
        expression = self._choice()
        if self._pieces:
            raise ValueError(f"expected the end, found `{self._pieces[0]}` in `{self._body}`")
        return expression

    def _choice(self) -> Expression:
        options = [self._sequence()]
        while self._take("|"):
            options.append(self._sequence())
        return choice(tuple(options))

    def _sequence(self) -> Expression:
        parts = []
        while self._pieces and self._pieces[0] not in ("|", ")", "]"):
            if self._pieces[0].startswith("->"):  # the name of a node in the tree says nothing about the text
                self._pieces.pop(0)
            else:
                parts.append(self._repeated())
        return sequence(tuple(parts))

    def _repeated(self) -> Expression:
        part = self._single()
        if self._take("*"):
            return Optional(Repeat(part))
        if self._take("+"):
            return Repeat(part)
        return Optional(part) if self._take("?") else part

    def _single(self) -> Expression:
        piece = self._pieces.pop(0)
        if piece in ("(", "["):
            inner = self._choice()
            if not self._take(")" if piece == "(" else "]"):
                raise ValueError(f"`{piece}` is never closed in `{self._body}`")
            return inner if piece == "(" else Optional(inner)
        if piece[0] == '"':
            return Text(re.sub(r"\\(.)", r"\1", piece[1:-1]))
        return Pattern(piece[1:-1]) if piece[0] == "/" else Symbol(piece)

    def _take(self, piece: str) -> bool:
        """Take the next piece if it is this one."""
        if not self._pieces or self._pieces[0] != piece:
            return False
        self._pieces.pop(0)
        return True
