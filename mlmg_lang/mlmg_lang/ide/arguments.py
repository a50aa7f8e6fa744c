"""The tokens of a statement up to a place -> the argument that is being written there, and what parameters are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from mlmg_lang.definitions.gather import Definitions, Kind
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.build_syntax import name_from_token
from mlmg_lang.parsing.tokens import ENDS_PARENTHESES, NAMES, Token
from mlmg_lang.spelling import normal

_PARTS = frozenset({"LEFT", "COMMA", "EQUALS"})
"""What an argument or its value stands behind."""


@dataclass(frozen=True, slots=True)
class Argument:
    """What is about to be written in the use of a definition.

    Attributes
    ----------
    parameter : that it is for; None if there is none left, or it has to be named first.
    kind : of what is wanted; None if that is not known.
    nameable : the parameters that it could name.
    owner : the name of the definition, in NFC.
    """

    parameter: syntax.Parameter | None
    kind: Kind | None
    nameable: tuple[syntax.Parameter, ...]
    owner: str

    @property
    def takes_motion(self) -> bool:
        """Return whether a motion can be written there."""
        return self.parameter is not None and self.kind is not Kind.DURATION


def argument_at(before: Sequence[Token], definitions: Definitions) -> Argument | None:
    """Return the argument that begins, or whose value does, behind some tokens; None if none does."""
    opening = next(iter(open_parentheses(before)), None)
    if opening is None or before[-1].type not in _PARTS:
        return None
    let = used_definition(before[:opening], definitions)
    if let is None or let.parameters is None:
        return None
    *given, last = arguments(before[opening + 1 :])
    by_name = {normal(parameter.name.text): parameter for parameter in let.parameters}
    named = [name for name in map(argument_name, given) if name is not None]
    name = argument_name(last)
    if name is not None:
        return _argument(let, by_name.get(name), (), definitions)
    free = let.parameters[len(given) - len(named) :]
    nameable = tuple(parameter for parameter in free if normal(parameter.name.text) not in named)
    return _argument(let, None if named else next(iter(free), None), nameable, definitions)


def parameter_kinds(statement: Sequence[Token], definitions: Definitions) -> Mapping[str, Kind | None]:
    """Return the parameters of the definition that tokens are the beginning of, and of which kind they seem to be.

    That is told by their defaults, and by how what stands of the definition uses them.
    """
    if [token.type for token in statement[:1]] != ["LET"] or len(statement) < 3 or statement[2].type != "LEFT":
        return {}
    head = (part for part in arguments(statement[3:]) if part and part[0].type in ("NAME", "UNIT"))
    kinds = {part[0].text: _of_default(part[2:]) for part in head}
    body = next((at for at in range(3, len(statement)) if not open_parentheses(statement[:at])), None)
    if body is None:
        return {}  # In the head itself there are none yet.
    for at in range(body, len(statement)):
        name = statement[at].text
        is_named = [token.type for token in statement[at + 1 : at + 2]] == ["EQUALS"]
        if name in kinds and kinds[name] is None and not is_named:
            kinds[name] = _used_as(statement[:at], definitions)
    return kinds


def names_of_definition(statement: Sequence[Token], definitions: Definitions) -> frozenset[str]:
    """Return what the definition that tokens are the beginning of gives a meaning in it, in NFC.

    That is its own name, which it cannot use, and its parameters.
    """
    if [token.type for token in statement[:1]] != ["LET"] or len(statement) < 2 or statement[1].type not in NAMES:
        return frozenset()
    own = name_from_token(statement[1]).text
    return frozenset(map(normal, (own, *parameter_kinds(statement, definitions))))


def used_definition(before: Sequence[Token], definitions: Definitions) -> syntax.Let | None:
    """Return the definition whose name stands last, unless it is being defined there."""
    if not before or before[-1].type not in NAMES or (len(before) > 1 and before[-2].type == "LET"):
        return None
    return definitions.find(name_from_token(before[-1]))


def open_parentheses(tokens: Sequence[Token]) -> list[int]:
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


def arguments(inside: Sequence[Token]) -> Iterator[list[Token]]:
    """Yield the arguments behind a parenthesis that are written so far, up to where it is closed; at least one."""
    depth = 0
    argument: list[Token] = []
    for token in inside:
        depth += (token.type == "LEFT") - (token.type == "RIGHT")
        if depth < 0:
            break
        if token.type == "COMMA" and depth == 0:
            yield argument
            argument = []
        elif token.type not in ("COMMENT", "NEWLINE"):
            argument.append(token)
    yield argument


def argument_name(argument: Sequence[Token]) -> str | None:
    """Return the name, in NFC, of the parameter that an argument says it is for."""
    if len(argument) > 1 and argument[0].type in NAMES and argument[1].type == "EQUALS":
        return normal(name_from_token(argument[0]).text)
    return None


def _argument(
    let: syntax.Let,
    parameter: syntax.Parameter | None,
    nameable: tuple[syntax.Parameter, ...],
    definitions: Definitions,
) -> Argument:
    owner = normal(let.name.text)
    signature = definitions.signatures.get(owner)
    kinds = {} if signature is None else signature.kinds
    kind = None if parameter is None else kinds.get(normal(parameter.name.text))
    return Argument(parameter, kind, nameable, owner)


def _of_default(default: Sequence[Token]) -> Kind | None:
    if not default:
        return None
    return Kind.DURATION if default[0].type in ("INTEGER", "DECIMAL") else Kind.MOTION


def _used_as(before: Sequence[Token], definitions: Definitions) -> Kind | None:
    """Return what a name behind some tokens is used as."""
    argument = argument_at(before, definitions)
    if argument is not None:
        return argument.kind
    return Kind.DURATION if before[-1].type == "FOR" else Kind.MOTION
