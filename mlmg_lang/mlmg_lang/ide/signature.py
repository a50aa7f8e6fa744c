"""A place between the parentheses of a definition's use -> what it takes, and which of that is being written."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass

from mlmg_lang.analysis import Analysis, InPieces
from mlmg_lang.definitions.gather import Signature
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.build_syntax import name_from_token
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import ENDS_PARENTHESES, NAMES, Token
from mlmg_lang.source import Source
from mlmg_lang.spelling import normal


@dataclass(frozen=True, slots=True)
class ParameterHelp:
    """One of the things that a definition takes.

    Attributes
    ----------
    start, end : where it is in the label, in code points.
    says : what it is.
    """

    name: str
    start: int
    end: int
    says: str


@dataclass(frozen=True, slots=True)
class SignatureHelp:
    """What a definition takes.

    Attributes
    ----------
    label : as in `GREET(x, t = 2 sec)`.
    active : the number of the parameter that is being written, from 0; None if there is no such.
    """

    label: str
    parameters: tuple[ParameterHelp, ...]
    active: int | None


def signature_help(analysis: Analysis, offset: int) -> SignatureHelp | None:
    """Return what is being written at an offset in the use of a definition; None elsewhere."""
    made = analysis.made
    before = _tokens_before(analysis, offset)
    definitions = made.gathered.definitions
    for opening in _open(before):
        let = _used(before[:opening], made)
        if let is not None and let.parameters is not None:
            label, parameters = described(let, definitions.signatures.get(normal(let.name.text)), made)
            return SignatureHelp(label, parameters, _active(before[opening + 1 :], parameters))
    return None


def described(let: syntax.Let, signature: Signature | None, made: InPieces) -> tuple[str, tuple[ParameterHelp, ...]]:
    """Return a definition's name with what it takes, as it is written; and each of its parameters.

    Parameters
    ----------
    let : with addresses.
    """
    label = script_name(let.name.text)
    if let.parameters is None:
        return label, ()
    parameters: list[ParameterHelp] = []
    label += "("
    for number, parameter in enumerate(let.parameters):
        label += ", " if number else ""
        name = script_name(parameter.name.text)
        default = parameter.default
        written = name if default is None else f"{name} = {' '.join(made.addressed.slice(default.span).split())}"
        kind = None if signature is None else signature.kinds.get(normal(parameter.name.text))
        says = f"a {kind}" if kind is not None else ""
        parameters.append(ParameterHelp(parameter.name.text, len(label), len(label) + len(written), says))
        label += written
    return f"{label})", tuple(parameters)


def _tokens_before(analysis: Analysis, offset: int) -> Sequence[Token]:
    """Return the tokens that begin before an offset, as far back as a parenthesis can be open there."""
    source, made = analysis.source, analysis.made
    if offset > len(source.text):
        file, base = source.file(offset)
        return tokenize(Source(file.text[: offset - base]))
    number = max(bisect_left(made.places.line_starts, offset) - 1, 0)
    line = made.lines[number]
    address = offset - made.places.line_starts[number] + line.address
    return line.tokens[: bisect_left(line.tokens, address, key=lambda token: token.span.start)]


def _open(tokens: Sequence[Token]) -> list[int]:
    """Return the parentheses that are open behind some tokens, the innermost first."""
    found: list[int] = []
    depth = 0
    for at in range(len(tokens) - 1, -1, -1):
        kind = tokens[at].type
        if kind in ENDS_PARENTHESES:
            break
        if kind == "LEFT" and depth == 0:
            found.append(at)
        depth += (kind == "RIGHT") - (kind == "LEFT" and depth > 0)
    return found


def _used(before: Sequence[Token], made: InPieces) -> syntax.Let | None:
    """Return the definition whose name stands last, unless it is being defined there."""
    if not before or before[-1].type not in NAMES or (len(before) > 1 and before[-2].type == "LET"):
        return None
    return made.gathered.definitions.find(name_from_token(before[-1]))


def _active(inside: Sequence[Token], parameters: Sequence[ParameterHelp]) -> int | None:
    """Return the number of the parameter that is being written, from what stands behind its parenthesis."""
    depth = number = 0
    argument: list[Token] = []
    for token in inside:
        depth += (token.type == "LEFT") - (token.type == "RIGHT")
        if token.type == "COMMA" and depth == 0:
            number, argument = number + 1, []
        elif token.type not in ("COMMENT", "NEWLINE"):
            argument.append(token)
    if len(argument) > 1 and argument[0].type in NAMES and argument[1].type == "EQUALS":
        name = normal(name_from_token(argument[0]).text)
        return next((at for at, one in enumerate(parameters) if normal(one.name) == name), None)
    return number if number < len(parameters) else None
