"""The grammar's own text, read as rules."""

from __future__ import annotations

import re

import pytest

from mlmg_grammar import grammar_text, make
from mlmg_grammar.definitions import definitions, sections
from mlmg_grammar.expressions import Choice, Expression, Optional, Pattern, Repeat, Sequence, Symbol, Text, walk
from mlmg_lang.parsing.tokens import CONTINUES, OPENS_STATEMENT

A, B, C = Symbol("a"), Symbol("b"), Symbol("C")


@pytest.mark.parametrize(
    ("text", "expression"),
    [
        ("x : a", A),
        ("?x : a b", Sequence((A, B))),
        ("x : a | b -> node", Choice((A, B))),
        ("x : a\n  | b C", Choice((A, Sequence((B, C))))),
        ("x : [a] (b | C)", Sequence((Optional(A), Choice((B, C))))),
        ("x : a* b+ C?", Sequence((Optional(Repeat(A)), Repeat(B), Optional(C)))),
        ("x : (a b)*", Optional(Repeat(Sequence((A, B))))),
        ('X.1 : "\\"" /[a-z"|]+/', Sequence((Text('"'), Pattern('[a-z"|]+')))),
        ("// nothing\nx : a\n%ignore C", A),
    ],
)
def test_a_definition_is_read_as_lark_reads_it(text: str, expression: Expression) -> None:
    assert list(definitions(text).values()) == [expression]


@pytest.mark.parametrize("text", ["x : (a", "x : a)", "x : a ~ 3", "nothing", "x : a\ny a"])
def test_what_is_not_in_the_notation_is_an_error(text: str) -> None:
    with pytest.raises(ValueError, match=r"found|closed"):
        definitions(text)


def test_a_section_has_its_title_its_comment_and_its_definitions() -> None:
    first, second = sections("// x\n\n// # One\n//\n// Two\n//  three.\n\n// other\na : b\n")
    assert (first.title, first.remarks, first.definitions) == ("", ("x",), ())
    assert (second.title, second.remarks) == ("One", ("Two", " three."))
    assert [one.name for one in second.definitions] == ["a"]


def test_every_rule_and_terminal_of_the_parser_is_found() -> None:
    language = make(starts=("script", "line", "unparsed"))
    made = {str(rule.origin.name) for rule in language.rules} | {terminal.name for terminal in language.terminals}
    helpers = {name for name in made if name.startswith("__")}
    parts = {"_NAME_START", "_NAME_PART", "_NAME_END"}
    assert set(definitions(grammar_text())) - parts == made - helpers


def test_every_symbol_that_is_used_is_defined() -> None:
    known = definitions(grammar_text())
    used = {part.name for one in known.values() for part in walk(one) if isinstance(part, Symbol)}
    assert used <= set(known)


def test_the_comment_on_layout_names_the_words_that_layout_knows() -> None:
    (layout,) = (section for section in sections(grammar_text()) if section.title == "Layout")
    known = definitions(grammar_text())
    words = {one.text: name for name, one in known.items() if isinstance(one, Text) and one.text.isalpha()}
    goes_on, begins = (
        {words[word] for word in re.findall(r"`(\w+)`", clause)}
        for clause in re.findall(r"begins with ((?:`\w+`,? ?(?:or )?)+)", " ".join(layout.remarks))
    )
    assert (goes_on, begins) == (CONTINUES, OPENS_STATEMENT)
