from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.layout import MAX_DEPTH
from mlmg_lang.parsing.parse import MAX_MISTAKES, Parsed, parse
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source

WORDS = [
    "WALK",
    "Upper-Body",
    "with",
    "and",
    "not",
    "(",
    ")",
    "{",
    "}",
    "|",
    ";",
    "\n",
    "for",
    "10",
    "sec",
    "repeat",
    "3",
    "let",
    "=",
    "FOR",
    ".",
    '"',
]


def parsed(text: str) -> Parsed:
    source = Source(text)
    return parse(source, tokenize(source))


def only(text: str) -> syntax.Item:
    result = parsed(text)
    assert result.diagnostics == ()
    (item,) = result.script.items
    return item


def shown(node: syntax.Node) -> str:
    """Return an expression with every group in brackets."""
    match node:
        case syntax.Reference(name):
            return name.text
        case syntax.Qualified(graph, motion):
            return f"{graph.text}:{shown(motion)}"
        case syntax.Call(name, arguments):
            return f"{name.text}<{', '.join(shown(argument.value) for argument in arguments)}>"
        case syntax.Group(motion):
            return f"({shown(motion)})"
        case syntax.Not(operand):
            return f"[not {shown(operand)}]"
        case syntax.And(operands):
            return f"[{' and '.join(map(shown, operands))}]"
        case syntax.Or(operands):
            return f"[{' or '.join(map(shown, operands))}]"
        case syntax.With(operands):
            return f"[{' with '.join(map(shown, operands))}]"
        case syntax.Quantity(number, unit):
            return f"{number} {unit}"
    raise AssertionError(node)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("A with B or C and D", "[A with [B or [C and D]]]"),
        ("A and B or C with D", "[[[A and B] or C] with D]"),
        ("A with B with C", "[A with B with C]"),
        ("A with (B with C)", "[A with ([B with C])]"),
        ("not A and B", "[[not A] and B]"),
        ("not not A", "[not [not A]]"),
        ("G A and B", "[G:A and B]"),
        ("not G A", "[not G:A]"),
        ("G (A and B)", "G<[A and B]>"),
        ("G(A)", "G<A>"),
        ("G H(A)", "G:H<A>"),
        ("F(A with B, 2 sec)", "F<[A with B], 2 sec>"),
        ('"hand on hip" "a \\"b\\" \\\\"', 'hand on hip:a "b" \\'),
        ("sec with frames", "[sec with frames]"),
    ],
)
def test_words_bind_as_the_language_says(text: str, expected: str) -> None:
    command = only(text)
    assert isinstance(command, syntax.Command)
    assert shown(command.motion) == expected


def test_a_definition_keeps_its_parameters_and_their_defaults() -> None:
    let = only("let GREET(x, t = 2 sec, y = A with B) = x with y for t")
    assert isinstance(let, syntax.Let)
    assert let.parameters is not None
    assert [(p.name.text, p.default and shown(p.default)) for p in let.parameters] == [
        ("x", None),
        ("t", "2 sec"),
        ("y", "[A with B]"),
    ]
    assert isinstance(let.command.duration, syntax.Name)


def test_a_definition_without_parentheses_differs_from_one_with_none_in_them() -> None:
    bare, empty = only("let A = B"), only("let A() = B")
    assert isinstance(bare, syntax.Let)
    assert isinstance(empty, syntax.Let)
    assert (bare.parameters, empty.parameters) == (None, ())


def test_named_arguments_keep_their_names() -> None:
    command = only("F(A, t = 2 sec)")
    assert isinstance(command, syntax.Command)
    assert isinstance(command.motion, syntax.Call)
    assert [argument.name and argument.name.text for argument in command.motion.arguments] == [None, "t"]


def test_a_choice_has_weights_and_may_have_empty_branches() -> None:
    choose = only("choose { 2: A; B | C\n | }")
    assert isinstance(choose, syntax.Choose)
    weights = [branch.weight and branch.weight.number for branch in choose.branches]
    assert (weights, [len(branch.body) for branch in choose.branches]) == (["2", None, None], [2, 1, 0])


def test_a_line_goes_on_where_the_next_begins_with_a_joining_word() -> None:
    command = only("A\n  with B # both\n\n  for 2 sec")
    assert isinstance(command, syntax.Command)
    assert shown(command.motion) == "[A with B]"
    assert isinstance(command.duration, syntax.Quantity)


def test_after_a_mistake_the_other_statements_are_still_there() -> None:
    result = parsed("A\nB for\nC; D E F; G")
    kinds = [type(item).__name__ for item in result.script.items]
    assert kinds == ["Command", "Broken", "Command", "Broken", "Command"]
    assert len(result.diagnostics) == 2


def test_a_mistake_that_can_be_mended_leaves_a_statement() -> None:
    result = parsed("A WITH B for 10")
    (command,) = result.script.items
    assert isinstance(command, syntax.Command)
    assert shown(command.motion) == "[A with B]"
    assert [one.code for one in result.diagnostics] == ["MS011", "MS016"]


@pytest.mark.parametrize("text", ["Upper-Body not TALK", "A for 2 sec with B"])
def test_a_mended_statement_covers_all_that_was_written(text: str) -> None:
    (command,) = parsed(text).script.items
    assert (command.span.start, command.span.end) == (0, len(text))
    for node in syntax.walk(command):
        for child in syntax.children(node):
            assert node.span.start <= child.span.start <= child.span.end <= node.span.end


def test_what_stands_in_braces_without_a_head_is_still_read() -> None:
    assert [type(item).__name__ for item in parsed("A { B for; C }").script.items] == ["Command", "Broken", "Command"]


@pytest.mark.parametrize(
    "text", ["(" * 10_000 + "A" + ")" * 10_000, "not " * 10_000 + "A", "F(" * 5_000, "not (" * 5_000]
)
def test_deep_nesting_is_one_mistake(text: str) -> None:
    assert [one.code for one in parsed(text).diagnostics] == ["MS005"]


def test_nesting_as_deep_as_is_allowed_is_read() -> None:
    only("(" * MAX_DEPTH + "A" + ")" * MAX_DEPTH)


def test_parentheses_side_by_side_are_not_nested() -> None:
    only(" with ".join("not (not A)" for _ in range(MAX_DEPTH)))


def test_a_statement_that_nobody_could_have_written_is_not_read() -> None:
    found = parsed(f"A\n{'A or ' * 5_000}A\nB")
    assert [one.code for one in found.diagnostics] == ["MS007"]
    assert [type(item) for item in found.script.items] == [syntax.Command, syntax.Broken, syntax.Command]


def test_of_a_text_without_end_the_beginning_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("tokenize", "parse"):
        monkeypatch.setattr(f"mlmg_lang.parsing.{module}.MAX_TOKENS", 4)
    found = parsed("A\nB\nC\nD\n")
    assert [one.code for one in found.diagnostics] == ["MS007"]
    assert len(found.script.items) == 2


def test_endless_mistakes_end_in_one_that_says_so() -> None:
    diagnostics = parsed("A for\n" * 1000).diagnostics
    assert [one.code for one in diagnostics[-2:]] == ["MS017", "MS006"]
    assert len(diagnostics) == MAX_MISTAKES + 1


@given(st.text())
def test_any_text_gives_a_tree_with_its_spans_in_the_text(text: str) -> None:
    result = parsed(text)
    for node in syntax.walk(result.script):
        assert 0 <= node.span.start <= node.span.end <= len(text)
    for one in result.diagnostics:
        assert one.span is not None
        assert 0 <= one.span.start <= one.span.end <= len(text)


@given(st.lists(st.sampled_from(WORDS), max_size=16).map(" ".join))
def test_any_words_give_a_tree_whose_parts_lie_in_each_other(text: str) -> None:
    result = parsed(text)
    for node in syntax.walk(result.script):
        for child in syntax.children(node):
            assert node.span.start <= child.span.start <= child.span.end <= node.span.end
    broken = any(isinstance(node, syntax.Broken) for node in syntax.walk(result.script))
    assert result.diagnostics or not broken
