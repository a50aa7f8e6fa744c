"""A place between the parentheses of a definition's use -> what it takes, and which of that is being written."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass

from mlmg_lang.analysis import Analysis, InPieces
from mlmg_lang.definitions.gather import Signature
from mlmg_lang.ide.arguments import argument_name, arguments, open_parentheses, used_definition
from mlmg_lang.ide.touching import tokens_at
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.tokens import Token
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
    _, base = analysis.source.file(offset)
    tokens, further = tokens_at(analysis, max(offset - 1, base))  # at the beginning of a line, that of the one before
    before = tokens[: bisect_left(tokens, offset - further, key=lambda token: token.span.start)]
    definitions = made.gathered.definitions
    for opening in open_parentheses(before):
        let = used_definition(before[:opening], definitions)
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


def _active(inside: Sequence[Token], parameters: Sequence[ParameterHelp]) -> int | None:
    """Return the number of the parameter that is being written, from what stands behind its parenthesis."""
    *before, last = map(argument_name, arguments(inside))
    numbers = {normal(one.name): at for at, one in enumerate(parameters)}
    if last is not None:
        return numbers.get(last)
    # Of those that say no name, each is for the next that is free.
    free = [at for name, at in numbers.items() if name not in before]
    return next(iter(free[before.count(None) :]), None)
