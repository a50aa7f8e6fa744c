"""The grammar -> its page in the documentation, and a picture of each rule."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from mlmg_grammar.definitions import Definition, Section
from mlmg_grammar.ebnf import ebnf
from mlmg_grammar.expressions import Text
from mlmg_grammar.railroad import railroad
from mlmg_grammar.readable import readable

PICTURES: Final = "grammar"
"""The folder of the pictures, beside the page."""

_INTRODUCTION: Final = """\
# The grammar of Motion Script

*This page is made from [motion_script.lark](../grammar/mlmg_grammar/motion_script.lark) by `make grammars`, its
comments included; what the words mean is told in [the language](language.md).*

In the rules, `[ ]` holds what may be left out, `{ }` what comes any number of times, `|` stands between alternatives.
Words and signs in quotes stand in the text as they are; names in capitals are tokens, told of at the end. Between
tokens there may be white space and comments. In the pictures every way from the left to the right along the rails is a
text that the rule allows.
"""


def pages(grammar: str) -> dict[str, str]:
    """Return the page and its pictures, by the name of the file from the folder of the documentation."""
    sections = readable(grammar)
    text = "\n".join((_INTRODUCTION, *(block for section in sections for block in _section(section))))
    return {"grammar.md": text, **{_picture(rule): railroad(rule) for section in sections for rule in _rules(section)}}


def _section(section: Section) -> Iterator[str]:
    """Yield the blocks of a part of the page."""
    if not section.title:
        return
    yield f"## {section.title}\n"
    if section.remarks:
        yield "\n".join(section.remarks) + "\n"
    rules = tuple(_rules(section))
    fixed = [one.expression.text for one in section.definitions if isinstance(one.expression, Text)]
    if fixed:
        yield " ".join(f"`{text}`" for text in fixed) + "\n"
    elif section.definitions and not rules:
        yield _code(section.definitions)
    for rule in rules:
        yield f"### {rule.name}\n\n![{ebnf(rule).replace('[', '&#91;').replace(']', '&#93;')}]({_picture(rule)})\n"
        yield _code((rule,))


def _rules(section: Section) -> Iterator[Definition]:
    return (one for one in section.definitions if one.name.islower())


def _code(definitions: tuple[Definition, ...]) -> str:
    width = max(len(one.name) for one in definitions)
    return "```ebnf\n" + "".join(f"{ebnf(one, width)}\n" for one in definitions) + "```\n"


def _picture(rule: Definition) -> str:
    return f"{PICTURES}/{rule.name}.svg"
