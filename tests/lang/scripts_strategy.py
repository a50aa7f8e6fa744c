"""Valid scripts of the whole grammar, however their writers lay them out: a strategy for hypothesis.

Tests get it by a fixture (see formatting/conftest.py), since test folders are no packages.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from hypothesis import strategies as st

Draw: TypeAlias = Callable[[st.SearchStrategy], object]
Words: TypeAlias = list[str]

NAMES = (
    *("WALK", "TALK", "IDLE", "Idle_01", "Upper-Body", "Left-Hand", "Sub", "sec", "frames", "走路", "é"),
    *("A_NAME_THAT_TAKES_MUCH_OF_A_LINE_AND_MORE", "很长的名字" * 4),
    *('"hand on hip"', '"WALK"', '"with"', '"WITH"', '"Sub"', '"min"', '"3d"', '"a \\"b\\" \\\\"', '"# {"'),
)
PLAIN = ("x", "y", "t", "min", "走", "GREET")
UNITS = ("sec", "s", "second", "seconds", "ms", "min", "minute", "minutes", "frame", "frames", "cycle", "cycles")
NUMBERS = ("1", "10", "05", "1.5", "2.50", "0.10", "007.0")
SPACES = (" ", "   ", "\t", "\u00a0", " \ufeff")
COMMENTS = ("#", "# a comment", "#walk }  ", "# (走) \t", '# "', "# mlmg: ignore[MS020]")
JOINED = frozenset({"with", "and", "or", "for", "once"})
SIGNS = frozenset("(),=:")


def scripts(max_items: int = 6) -> st.SearchStrategy[str]:
    """Return a strategy of scripts without syntax errors; whether their names mean something is another matter."""
    return st.composite(lambda draw: _script(draw, max_items))()


def _script(draw: Draw, max_items: int) -> str:
    items = [_top(draw) for _ in range(draw(st.integers(0, max_items)))]
    return _gap(draw, ends=True) + _joined(draw, items) + _gap(draw, ends=True)


# --- statements ------------------------------------------------------------------------------------------


def _top(draw: Draw) -> str:
    kind = draw(st.sampled_from(("let", "use", "item", "item", "item")))
    if kind == "use":
        return f'use{_space(draw)}"{draw(st.sampled_from(("a.ms", "WALK", "with")))}"'
    return _laid_out(draw, _let(draw)) if kind == "let" else _item(draw, 2)


def _item(draw: Draw, depth: int) -> str:
    kinds = ("command", "command", "command", "wait", "end") + ("repeat", "choose") * (depth > 0)
    kind = draw(st.sampled_from(kinds))
    if kind == "repeat":
        count = draw(st.sampled_from(("1", "3", "010")))
        return f"repeat{_space(draw)}{count}{_free(draw)}{{{_body(draw, depth - 1)}}}"
    if kind == "choose":
        branches = [_branch(draw, depth - 1) for _ in range(draw(st.integers(1, 3)))]
        return f"choose{_free(draw)}{{{'|'.join(branches)}}}"
    if kind == "wait":
        return _laid_out(draw, ["wait", *_amount(draw)])
    if kind == "end":
        return _laid_out(draw, ["end", _one_of(draw, NAMES)])
    return _laid_out(draw, _command(draw))


def _branch(draw: Draw, depth: int) -> str:
    weight = draw(st.sampled_from(("", "", "2:", "3 :", "01:")))
    return _gap(draw) + weight + _body(draw, depth)


def _body(draw: Draw, depth: int) -> str:
    items = [_item(draw, depth) for _ in range(draw(st.integers(0, 3)))]
    return _gap(draw, ends=True) + _joined(draw, items) + _gap(draw, ends=True)


def _joined(draw: Draw, items: list[str]) -> str:
    ends = ("\n", "\r\n", "\r", ";", "; ", " ;\n", ";;", "\n\n\n", "\n;\n")
    text = ""
    for n, item in enumerate(items):
        text += item if n == 0 else _gap(draw) * draw(st.booleans()) + _one_of(draw, ends) + _gap(draw) + item
    return text


def _let(draw: Draw) -> Words:
    name = _one_of(draw, (*PLAIN, *NAMES))
    n_parameters = draw(st.integers(-1, 2))
    parameters: Words = []
    for _ in range(n_parameters):
        default = ["=", *_value(draw, 1)] if draw(st.booleans()) else []
        parameters += [",", _one_of(draw, PLAIN), *default]
    brackets = ["(", *parameters[1:], ")"] if n_parameters >= 0 else []
    return ["let", name, *brackets, "=", *_command(draw)]


def _command(draw: Draw) -> Words:
    last = draw(st.sampled_from(("nothing", "for", "once")))
    ending = {"nothing": [], "once": ["once"]}.get(last)
    return [
        *_motion(draw, draw(st.sampled_from((0, 0, 1, 2)))),
        *(["for", *_amount(draw)] if ending is None else ending),
    ]


def _amount(draw: Draw) -> Words:
    return [_one_of(draw, NAMES)] if draw(st.integers(0, 3)) == 0 else _quantity(draw)


def _quantity(draw: Draw) -> Words:
    return [_one_of(draw, NUMBERS), _one_of(draw, UNITS)]


# --- motions ---------------------------------------------------------------------------------------------


def _motion(draw: Draw, depth: int) -> Words:
    return _chain(draw, "with", lambda: _chain(draw, "or", lambda: _chain(draw, "and", lambda: _term(draw, depth))))


def _chain(draw: Draw, joiner: str, operand: Callable[[], Words]) -> Words:
    words = operand()
    for _ in range(draw(st.sampled_from((0, 0, 0, 0, 0, 1, 2)))):
        words += [joiner, *operand()]
    return words


def _term(draw: Draw, depth: int) -> Words:
    kind = draw(st.sampled_from(("atom", "atom", "qualified") + ("not", "group") * (depth > 0)))
    if kind == "not":
        return ["not", *_term(draw, depth - 1)]
    if kind == "group":
        return ["(", *_motion(draw, depth - 1), ")"]
    return [*[_one_of(draw, NAMES)] * (kind == "qualified"), *_atom(draw, depth)]


def _atom(draw: Draw, depth: int) -> Words:
    name = _one_of(draw, NAMES)
    if depth == 0 or draw(st.booleans()):
        return [name]
    arguments: Words = []
    for _ in range(draw(st.integers(0, 2))):
        label = [_one_of(draw, PLAIN), "="] if draw(st.booleans()) else []
        arguments += [",", *label, *_value(draw, depth - 1)]
    return [name, "(", *arguments[1:], ")"]


def _value(draw: Draw, depth: int) -> Words:
    return _quantity(draw) if draw(st.integers(0, 2)) == 0 else _motion(draw, depth)


# --- layout ----------------------------------------------------------------------------------------------


def _laid_out(draw: Draw, words: Words) -> str:
    """Return words with white space between them, and line ends and comments where they mean nothing."""
    text, depth, before = "", 0, ""
    for word in words:
        depth -= word == ")"
        tight = before in SIGNS or word in SIGNS or before in NUMBERS or not before
        loose = bool(before) and (depth > 0 or word in JOINED)
        if loose and draw(st.integers(0, 5)) == 0:
            text += _gap(draw, breaks=True)
        else:
            text += _free(draw) if tight and before else _space(draw) if before else ""
        text += word
        depth += word == "("
        before = word
    return text


def _gap(draw: Draw, breaks: bool = False, ends: bool = False) -> str:
    """Return white space and comments between statements; with `ends`, `;` too. With `breaks` there is a line end."""
    parts = ["\n"] if breaks else []
    for _ in range(draw(st.sampled_from((0, 0, 0, 1, 1, 3)))):
        comment = draw(st.booleans())
        parts.append(f"{_free(draw)}{_one_of(draw, COMMENTS)}\n" if comment else _one_of(draw, ("\n", " ", "\r\n")))
        parts += [";"] * (ends and draw(st.integers(0, 4)) == 0)
    return "".join(reversed(parts)) if breaks else "".join(parts)


def _space(draw: Draw) -> str:
    return " " if draw(st.integers(0, 3)) else _one_of(draw, SPACES)


def _free(draw: Draw) -> str:
    return draw(st.sampled_from(("", "", " ", "  ")))


def _one_of(draw: Draw, choices: tuple[str, ...]) -> str:
    return draw(st.sampled_from(choices))
