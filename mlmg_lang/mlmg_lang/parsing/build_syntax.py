"""The grammar's rules -> nodes of the syntax tree; and the parser that does it, made once."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import lark
from lark import Transformer

from mlmg_grammar import is_name, load
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Span


@cache
def motion_script() -> lark.Lark:
    """Return the parser of Motion Script, which makes syntax trees."""
    return load(_Builder())


def name_from_token(token: Token) -> syntax.Name:
    """Return the name that a token spells, be it sound or not."""
    if token.type not in ("STRING", "UNCLOSED"):
        return syntax.Name(token.text, False, is_name(token.text), token.span)
    closed = re.fullmatch(r'"(?:[^"\\]++|\\.)*+"', token.text) is not None
    inside = token.text[1 : -1 if closed else None]
    sound = closed and inside.strip() != "" and not bad_escapes(inside)
    return syntax.Name(re.sub(r"\\(.)", r"\1", inside), True, sound, token.span)


def bad_escapes(inside: str) -> list[str]:
    r"""Return the escapes in a quoted name that are neither `\"` nor `\\`."""
    escapes = (found[0] for found in re.finditer(r"\\.?", inside))
    return [escape for escape in escapes if escape not in ('\\"', "\\\\")]


class _Builder(Transformer[lark.Token, Any]):
    """One method for each rule, called with what the rule is made of when the parser reduces it."""

    def let(self, parts: list[Any]) -> syntax.Let:
        _, name, parameters, _, command = parts
        return syntax.Let(name, parameters, command, _across([parts[0], command]))

    def parameters(self, parts: list[Any]) -> tuple[syntax.Parameter, ...]:
        return tuple(part for part in parts if isinstance(part, syntax.Parameter))

    def parameter(self, parts: list[Any]) -> syntax.Parameter:
        name, default = parts[0], parts[-1]  # the last is None where there is no `=`
        return syntax.Parameter(name, default, _across(parts))

    def use(self, parts: list[Any]) -> syntax.Use:
        return syntax.Use(name_from_token(parts[1]), _across(parts))

    def wait(self, parts: list[Any]) -> syntax.Wait:
        return syntax.Wait(parts[1], _across(parts))

    def end(self, parts: list[Any]) -> syntax.End:
        return syntax.End(parts[1], _across(parts))

    def repeat_head(self, parts: list[Any]) -> syntax.RepeatHead:
        return syntax.RepeatHead(parts[1].text, _across(parts))

    def choose_head(self, parts: list[Any]) -> syntax.ChooseHead:
        return syntax.ChooseHead(_across(parts))

    def weight(self, parts: list[Any]) -> syntax.Weight:
        return syntax.Weight(parts[0].text, _across(parts))

    def command(self, parts: list[Any]) -> syntax.Command:
        motion, *rest = (part for part in parts if part is not None)
        once = rest[0].span if len(rest) == 1 else None
        duration = rest[1] if len(rest) == 2 else None
        return syntax.Command(motion, duration, once, _across(parts))

    def quantity(self, parts: list[Any]) -> syntax.Quantity:
        number, unit = parts
        return syntax.Quantity(number.text, unit.text, _across(parts))

    def layered(self, parts: list[Any]) -> syntax.With:
        return syntax.With(tuple(parts[::2]), _across(parts))

    def either(self, parts: list[Any]) -> syntax.Or:
        return syntax.Or(tuple(parts[::2]), _across(parts))

    def both(self, parts: list[Any]) -> syntax.And:
        return syntax.And(tuple(parts[::2]), _across(parts))

    def qualified(self, parts: list[Any]) -> syntax.Qualified:
        return syntax.Qualified(parts[0], parts[1], _across(parts))

    def negated(self, parts: list[Any]) -> syntax.Not:
        return syntax.Not(parts[1], _across(parts))

    def group(self, parts: list[Any]) -> syntax.Group:
        return syntax.Group(parts[1], _across(parts))

    def reference(self, parts: list[Any]) -> syntax.Reference:
        return syntax.Reference(parts[0], parts[0].span)

    def call(self, parts: list[Any]) -> syntax.Call:
        arguments = tuple(part for part in parts if isinstance(part, syntax.Argument))
        return syntax.Call(parts[0], arguments, _across(parts))

    def argument(self, parts: list[Any]) -> syntax.Argument:
        name, _, value = parts
        return syntax.Argument(name, value, _across(parts))

    def name(self, parts: list[Any]) -> syntax.Name:
        return name_from_token(parts[0])

    plain = name


def _across(parts: list[Any]) -> Span:
    """Return the span of all parts. (In a line that was mended they may have changed places.)"""
    there = [part.span for part in parts if part is not None]
    return Span(min(span.start for span in there), max(span.end for span in there))
