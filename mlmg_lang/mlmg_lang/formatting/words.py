"""The tokens of a sound statement -> how each is written, with the space before it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

from mlmg_grammar import is_name, reserved_words
from mlmg_lang.parsing.amounts import UNITS
from mlmg_lang.parsing.build_syntax import motion_script, name_from_token
from mlmg_lang.parsing.structure import SUB
from mlmg_lang.parsing.tokens import NAMES, NUMBERS, Token
from mlmg_lang.spelling import normal

_NEVER_AFTER_SPACE: Final = frozenset({"RIGHT", "COMMA", "COLON"})


@dataclass(frozen=True, slots=True)
class Words:
    """What must be known of a whole script to write its words.

    Attributes
    ----------
    defined : the names that it defines, in NFC.
    uses : whether it uses another file, which may define more.
    """

    defined: frozenset[str]
    uses: bool

    def written(self, tokens: Sequence[Token]) -> list[str]:
        """Return each token as it is written, with the space before it, if there is to be one.

        Parameters
        ----------
        tokens : of one sound statement, without comments and line ends.
        """
        texts: list[str] = []
        before = ""
        for at, token in enumerate(tokens):
            kind, text = token.type, token.text
            if kind == "UNIT" and before in NUMBERS:
                text = UNITS[text]
            elif kind in NUMBERS:
                text = shortest_number(text)
            elif kind == "STRING" and before != "USE":
                text = _unquoted(token)
            texts.append(f" {text}" if self._has_space(tokens, at) else text)
            before = kind
        return texts

    def _has_space(self, tokens: Sequence[Token], at: int) -> bool:
        """Return whether there is a space between a token and the one before it."""
        kind = tokens[at].type
        if at == 0 or kind in _NEVER_AFTER_SPACE or tokens[at - 1].type == "LEFT":
            return False
        return kind != "LEFT" or tokens[at - 1].type not in NAMES or self._is_group(tokens, at)

    def _is_group(self, tokens: Sequence[Token], at: int) -> bool:
        """Return whether a parenthesis after a name begins the group of a graph, not what a definition takes."""
        name = tokens[at - 1]
        if tokens[0].type == "LET" and at == 2:
            return False
        if normal(name_from_token(name).text) in self.defined or not _may_be_group(tokens, at):
            return False
        return not self.uses or name.span.end < tokens[at].span.start


def words_of(statements: Iterable[Sequence[Token]]) -> Words:
    """Return what must be known of a script, from the tokens of its statements."""
    defined: set[str] = set()
    uses = False
    for tokens in statements:
        if tokens[0].type == "LET" and len(tokens) > 1 and tokens[1].type in NAMES:
            defined.add(normal(name_from_token(tokens[1]).text))
        uses = uses or tokens[0].type == "USE"
    return Words(frozenset(defined), uses)


def shortest_number(digits: str) -> str:
    """Return a number without the zeros that say nothing: `05` is `5`, `1.50` is `1.5`, `10.0` is `10`."""
    whole, _, fraction = digits.partition(".")
    fraction = fraction.rstrip("0")
    return f"{whole.lstrip('0') or '0'}{f'.{fraction}' if fraction else ''}"


def _unquoted(token: Token) -> str:
    """Return a name in quotes without them, where it would be the same name."""
    name = name_from_token(token).text
    if not is_name(name) or name in UNITS or name.casefold() == SUB.casefold():
        return token.text
    return token.text if name.lower() in reserved_words(motion_script()) else name


def _may_be_group(tokens: Sequence[Token], at: int) -> bool:
    """Return whether the parentheses that begin at a token hold one motion expression and nothing else."""
    if tokens[at + 1].type in NUMBERS | {"RIGHT"}:
        return False
    depth = 0
    for token in tokens[at:]:
        depth += (token.type == "LEFT") - (token.type == "RIGHT")
        if depth == 0:
            break
        if depth == 1 and token.type in ("COMMA", "EQUALS"):
            return False
    return True
