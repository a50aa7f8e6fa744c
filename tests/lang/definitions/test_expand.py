"""What stands where a definition is used, held against what a person would have written there by hand."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mlmg_lang.definitions import expand
from mlmg_lang.front_end import Analysis, analyse
from mlmg_lang.parsing import syntax
from mlmg_lang.planning.resolved import Command, Cycles, Once, Seconds
from mlmg_lang.source import Source

Codes = Callable[..., list[str]]
Resolves = Callable[..., list[dict[str, tuple[str, ...]]]]


# --- a small model of definitions: it can be written down, and it can be put in by hand ---


@dataclass(frozen=True)
class Plain:
    """A name of the library."""

    name: str


@dataclass(frozen=True)
class Given:
    """A parameter of the definition that this stands in."""

    name: str


@dataclass(frozen=True)
class Use:
    """A definition, with its arguments by the names of the parameters; those left out have their defaults."""

    let: Let
    arguments: Mapping[str, Any]
    by_name: bool


@dataclass(frozen=True)
class Joined:
    """Operands joined by `with`, `and` or `or`."""

    word: str
    operands: tuple[Any, ...]


@dataclass(frozen=True)
class Negated:
    operand: Any


@dataclass(frozen=True)
class On:
    """What a graph does."""

    graph: str
    operand: Any


@dataclass(frozen=True)
class Let:
    """A definition; `parameters` by name, with their defaults if they have one; a duration is a text."""

    name: str
    parameters: Mapping[str, Any]
    body: Any
    duration: str | Given | None = None


def written(part: Any) -> str:
    """Return how a script with definitions says it."""
    match part:
        case str():
            return part
        case Plain(name) | Given(name):
            return name
        case Use(let, arguments, by_name):
            if by_name:
                given = [f"{name} = {written(value)}" for name, value in reversed(arguments.items())]
            else:
                given = [written(value) for value in arguments.values()]
            return f"{let.name}({', '.join(given)})" if given or let.parameters else let.name
        case Joined(word, operands):
            return f"({f' {word} '.join(map(written, operands))})"
        case Negated(operand):
            return f"(not {written(operand)})"
        case On(graph, operand):
            return f"({graph} {written(operand)})"
        case Let(name, parameters, body, duration):
            takes = [name if value is None else f"{name} = {written(value)}" for name, value in parameters.items()]
            lasts = f" for {written(duration)}" if duration is not None else ""
            listed = f"({', '.join(takes)})" if takes else ""
            return f"let {name}{listed} = {written(body)}{lasts}"
    raise AssertionError(part)


def by_hand(part: Any, values: Mapping[str, str]) -> str:
    """Return how a script without definitions says it."""
    match part:
        case str():
            return part
        case Plain(name):
            return name
        case Given(name):
            return values[name]
        case Use(let):
            return f"({by_hand(let.body, arguments_of(part, values))})"
        case Joined(word, operands):
            return f"({f' {word} '.join(by_hand(operand, values) for operand in operands)})"
        case Negated(operand):
            return f"(not {by_hand(operand, values)})"
        case On(graph, Plain(name)):
            return f"({graph} {name})"
        case On(graph, operand):
            return f"({graph} ({by_hand(operand, values)}))"
    raise AssertionError(part)


def arguments_of(use: Use, values: Mapping[str, str]) -> dict[str, str]:
    """Return what the parameters stand for in a use, in parentheses if they are motions."""
    found = {}
    for name, default in use.let.parameters.items():
        value = by_hand(use.arguments[name], values) if name in use.arguments else by_hand(default, {})
        found[name] = value if value[0].isdigit() else f"({value})"
    return found


@dataclass(frozen=True)
class Script:
    lets: tuple[Let, ...]
    commands: tuple[tuple[Any, str], ...]

    @property
    def defined(self) -> str:
        """Return it with the definitions that it needs, after where they are used."""
        said = [f"{written(motion)}{amount}" for motion, amount in self.commands]
        return "\n".join([*said, *(written(let) for let in self.lets if let.name in self._needed())])

    @property
    def plain(self) -> str:
        """Return it with all put in by hand."""
        said = []
        for motion, amount in self.commands:
            lasts = motion.let.duration if isinstance(motion, Use) else None
            if lasts is not None:
                lasts = f" for {by_hand(lasts, arguments_of(motion, {}))}"
            said.append(by_hand(motion, {}) + (lasts or amount))
        return "\n".join(said)

    def _needed(self) -> set[str]:
        needed: set[str] = set()
        pending: list[Any] = [motion for motion, _ in self.commands]
        while pending:
            match pending.pop():
                case Use(let, arguments):
                    needed.add(let.name)
                    pending += [let.body, *arguments.values(), *let.parameters.values()]
                case Joined(_, operands):
                    pending += operands
                case Negated(operand) | On(_, operand):
                    pending.append(operand)
        return needed


def given_in(part: Any) -> set[str]:
    """Return the parameters that stand in an expression; what is given to no use would not be put in by hand."""
    match part:
        case Given(name):
            return {name}
        case Use(_, arguments):
            return set().union(*map(given_in, arguments.values()))
        case Joined(_, operands):
            return set().union(*map(given_in, operands))
        case Negated(operand) | On(_, operand):
            return given_in(operand)
    return set()


TAGS = ["IDLE", "WALK", "TALK", "SWING_HAND", "WAVE", "Walk_01", "Talk_02"]
GRAPHS = ["Full-Body", "Upper-Body", "Left-Hand", "Sub"]
PARAMETERS = ["x", "y", "A1", "TALK"]
"""Some are spelt like definitions and tags, which they hide."""


@st.composite
def motions(draw: st.DrawFn, lets: Sequence[Let], parameters: Mapping[str, Any], depth: int) -> Any:
    """Draw an expression that may use some definitions and parameters."""
    lets = [let for let in lets if let.name not in parameters and (depth or None not in let.parameters.values())]
    kinds = ["plain"] + ["use"] * 2 * bool(lets) + ["given"] * 3 * bool(parameters)
    if depth:
        kinds += ["with", "and", "or", "not", "on"]

    def inner(atomic: bool = False) -> Any:
        return draw(motions(lets, parameters, 0 if atomic else depth - 1))

    match draw(st.sampled_from(kinds)):
        case "given":
            return Given(draw(st.sampled_from(list(parameters))))
        case "use":
            return draw(uses(lets, parameters, depth - 1)) if depth else Use(draw(st.sampled_from(lets)), {}, False)
        case "with" | "and" | "or" as word:
            return Joined(word, tuple(inner() for _ in range(draw(st.integers(2, 3)))))
        case "not":
            return Negated(inner())
        case "on":
            return On(draw(st.sampled_from(GRAPHS)), inner(draw(st.booleans())))
        case _:
            return Plain(draw(st.sampled_from([tag for tag in TAGS if tag not in parameters])))


@st.composite
def uses(draw: st.DrawFn, lets: Sequence[Let], parameters: Mapping[str, Any], depth: int) -> Use:
    """Draw the use of one of some definitions; those in its arguments are no whole statements."""
    let = draw(st.sampled_from(lets))
    inside = [other for other in lets if other.duration is None]
    by_name = draw(st.booleans())
    arguments: dict[str, Any] = {}
    for name, default in let.parameters.items():
        if default is not None and draw(st.booleans()):
            by_name = by_name or name != list(let.parameters)[-1]
        else:
            lasts = let.duration == Given(name)
            arguments[name] = draw(DURATIONS) if lasts else draw(motions(inside, parameters, depth))
    return Use(let, arguments, by_name)


DURATIONS = st.sampled_from(["2 sec", "0.5 min", "3 cycles", "10 frames"])


@st.composite
def scripts(draw: st.DrawFn) -> Script:
    lets: list[Let] = []
    for number in range(draw(st.integers(1, 4))):
        names = draw(st.lists(st.sampled_from(PARAMETERS), max_size=2, unique=True))
        usable = [let for let in lets if let.duration is None]
        parameters = {name: draw(st.none() | motions([], {}, 1)) for name in names}
        body = draw(motions(usable, parameters, 2))
        parameters = {name: default for name, default in parameters.items() if name in given_in(body)}
        duration: str | Given | None = None
        if draw(st.integers(0, 3)) == 0:
            duration = draw(DURATIONS)
            if draw(st.booleans()) and "t" not in parameters:
                parameters["t"] = draw(st.none() | DURATIONS)
                duration = Given("t")
        lets.append(Let(f"A{number}", parameters, body, duration))
    commands = []
    usable = [let for let in lets if let.duration is None]
    for _ in range(draw(st.integers(1, 3))):
        motion = draw(uses(lets, {}, 1) | motions(usable, {}, 2))
        lasts = isinstance(motion, Use) and motion.let.duration is not None
        commands.append((motion, "" if lasts else draw(st.sampled_from(["", " for 1 sec", " once"]))))
    return Script(tuple(lets), tuple(commands))


def played(analysis: Analysis) -> Any:
    """Return what a script plays, without where it says so."""
    if analysis.resolved is None:
        return None
    return [
        (
            [(layer.graph, layer.candidates, [out.motion for out in layer.left_out]) for layer in one.layers],
            one.duration,
        )
        for one in analysis.resolved.statements
        if isinstance(one, Command)
    ]


def mistakes(analysis: Analysis) -> set[str]:
    return {one.code for one in analysis.diagnostics if one.severity == "error"}


@settings(max_examples=2 * settings().max_examples)
@given(scripts())
def test_a_definition_means_what_it_says_in_parentheses(left_hand_always: Any, script: Script) -> None:
    defined = analyse(Source(script.defined), left_hand_always)
    plain = analyse(Source(script.plain), left_hand_always)
    assert mistakes(defined) == mistakes(plain), (script.defined, script.plain)
    assert played(defined) == played(plain), (script.defined, script.plain)


# --- where a definition may be used, and with what ---


@pytest.mark.parametrize(
    ("script", "plain"),
    [
        ("A\nlet A = WALK", "WALK"),
        ("let A = WALK or TALK\nA and IDLE", "(WALK or TALK) and IDLE"),
        ("let A = WALK with TALK\nA", "WALK with TALK"),
        ("let A(x) = Upper-Body x\nWALK with A(TALK)", "WALK with Upper-Body TALK"),
        ("let A(x) = Upper-Body x\nWALK with A(TALK or SWING_HAND)", "WALK with Upper-Body (TALK or SWING_HAND)"),
        ("let A(x) = x\nUpper-Body A(TALK)", "Upper-Body TALK"),
        ("let A = TALK\nUpper-Body A", "Upper-Body TALK"),
        ("let A = TALK\nUpper-Body (A and IDLE)", "Upper-Body (TALK and IDLE)"),
        ("let A(x) = not x\nnot A(WALK or TALK)", "not (not (WALK or TALK))"),
        ("let A(x, y = TALK) = x with y\nA(WALK)", "WALK with TALK"),
        ("let A(x = WALK) = x\nA", "WALK"),
        ("let A(x = WALK) = x\nA()", "WALK"),
        ("let A(x = B) = x\nlet B = WALK\nA", "WALK"),
        ("let A(x, y) = x with y\nA(y = TALK, x = WALK)", "WALK with TALK"),
        ("let A(x, y) = x with y\nA(WALK, y = TALK)", "WALK with TALK"),
        ("let A(x, y = TALK, z = WALK) = z with Upper-Body (x or y)\nA(SWING_HAND, z = IDLE)", ""),
        ("let A(x) = B(x)\nlet B(x) = x with TALK\nA(WALK)", "WALK with TALK"),
        ("let A(x) = B(x) with TALK\nlet B(y) = y or IDLE\nA(WALK)", "(WALK or IDLE) with TALK"),
        ("let A(WALK) = WALK with Upper-Body TALK\nA(IDLE)", "IDLE with Upper-Body TALK"),
        ("let WALK = IDLE\nWALK", "IDLE"),
        ("let caf\u00e9 = WALK\ncafe\u0301", "WALK"),
        ("let A(\u00e9) = e\u0301\nA(e\u0301 = WALK)", "WALK"),
        ('let "my walk" = WALK\n"my walk"', "WALK"),
        ('let "end walk"(x) = x\n"end walk"(WALK)', "WALK"),
        ("repeat 2 { A; choose { A | B } }\nlet A = WALK\nlet B = TALK", "repeat 2 { WALK; choose { WALK | TALK } }"),
    ],
)
def test_it_means_the_same_as_what_is_written_by_hand(script: str, plain: str, reference: Any) -> None:
    plain = plain or "IDLE with Upper-Body (SWING_HAND or TALK)"
    defined, by_hand = analyse(Source(script), reference), analyse(Source(plain), reference)
    assert mistakes(defined) == mistakes(by_hand) == set()
    assert defined.resolved is not None
    assert played(defined) == played(by_hand)


@pytest.mark.parametrize(
    ("script", "duration"),
    [
        ("let A = WALK for 2 sec\nA", Seconds(2.0)),
        ("let A = WALK once\nA", Once()),
        ("let A(t) = WALK for t\nA(3 cycles)", Cycles(3.0)),
        ("let A(t = 4 sec) = WALK for t\nA", Seconds(4.0)),
        ("let A(t = 4 sec) = WALK for t\nA(1 min)", Seconds(60.0)),
        ("let A(x, t = 4 sec) = x for t\nA(t = 2 sec, x = WALK)", Seconds(2.0)),
        ("let A(x) = x for 45 frames\nA(WALK)", Seconds(1.5)),
        ("let A(t) = WALK for t\nA(0.5 sec)\nlet B(t) = TALK for t", Seconds(0.5)),
        ("let A(x) = x\nA(WALK) for 2 sec", Seconds(2.0)),
        ("let A = WALK\nA once", Once()),
        ("let A = WALK\nA", None),
    ],
)
def test_a_definition_may_say_how_long(script: str, duration: Any, reference: Any) -> None:
    plan = analyse(Source(script), reference).resolved
    assert plan is not None
    (command,) = plan.statements
    assert isinstance(command, Command)
    assert command.duration == duration


def test_a_command_is_where_its_definition_is_used_and_its_layers_where_they_are_written(reference: Any) -> None:
    source = Source("let A(x) = x with Upper-Body TALK for 2 sec\nA(WALK)")
    plan = analyse(source, reference).resolved
    assert plan is not None
    (command,) = plan.statements
    assert isinstance(command, Command)
    assert source.slice(command.span) == "A(WALK)"
    assert [source.slice(layer.span) for layer in command.layers] == ["WALK", "Upper-Body TALK"]


# --- what is wrong with how one is used ---


def said(script: str, library: Any = None) -> list[tuple[str, str, str]]:
    """Return code, message and place of what is said of a script."""
    source = Source(script)
    found = analyse(source, library).diagnostics
    return [(one.code, one.message, source.slice(one.span) if one.span else "") for one in found]


@pytest.mark.parametrize(
    ("use", "code", "message", "place"),
    [
        ("ZERO()", "MS055", "`ZERO` takes no arguments", "ZERO()"),
        ("ZERO(WALK)", "MS055", "`ZERO` takes no arguments", "ZERO(WALK)"),
        ("EMPTY(WALK)", "MS055", "`EMPTY` takes no arguments", "WALK"),
        ("ONE", "MS055", "`ONE` is used without its `x`", "ONE"),
        ("ONE()", "MS055", "`ONE` is used without its `x`", "ONE()"),
        ("ONE(A, B)", "MS055", "`ONE` takes 1 argument", "B"),
        ("TWO(A, B, C)", "MS055", "`TWO` takes 2 arguments", "C"),
        ("TWO(A)", "MS055", "`TWO` is used without its `y`", "TWO(A)"),
        ("TWO()", "MS055", "`TWO` is used without its `x` and `y`", "TWO()"),
        ("TWO(A, x = B)", "MS055", "`x` is given twice", "x = B"),
        ("TWO(x = A, x = B)", "MS055", "`x` is given twice", "x = B"),
        ("TWO(x = A, B)", "MS055", "an argument without a name stands before those with one", "B"),
        ("TWO(A, z = B)", "MS055", "`TWO` has no parameter `z`", "z"),
        ("ONE(2 sec)", "MS056", "`x` of `ONE` is a motion; this is a duration", "2 sec"),
        ("LONG(A)", "MS056", "`t` of `LONG` is a duration; this is a motion", "A"),
        ("LONG((2 sec))", "MS010", "", "sec"),
        ("LONG(2 sec) for 3 sec", "MS057", "`LONG` says itself how long it lasts", "3 sec"),
        ("LONG(2 sec) once", "MS057", "`LONG` says itself how long it lasts", "once"),
        (
            "A with LONG(2 sec)",
            "MS057",
            "`LONG` says how long it lasts, so it is a whole statement and cannot stand in another",
            "LONG(2 sec)",
        ),
        (
            "(SHORT)",
            "MS057",
            "`SHORT` says how long it lasts, so it is a whole statement and cannot stand in another",
            "SHORT",
        ),
        (
            "ONE(SHORT)",
            "MS057",
            "`SHORT` says how long it lasts, so it is a whole statement and cannot stand in another",
            "SHORT",
        ),
    ],
)
def test_a_use_that_does_not_fit_is_one_mistake_with_its_place(use: str, code: str, message: str, place: str) -> None:
    lets = {
        "ZERO": "let ZERO = WALK",
        "EMPTY": "let EMPTY() = WALK",
        "ONE": "let ONE(x) = x",
        "TWO": "let TWO(x, y) = x with y",
        "LONG": "let LONG(t) = WALK for t",
        "SHORT": "let SHORT = WALK for 1 sec",
    }
    needed = [let for name, let in lets.items() if name in use]
    ((found, words, where),) = said("\n".join([use, *needed]))
    assert found == code
    assert (words, where) == (message, place) or code == "MS010"


def test_the_definition_is_shown_with_what_it_takes() -> None:
    (one,) = analyse(Source("ONE\nlet ONE(x, y = WALK with TALK, t = 2 sec) = x with y for t")).diagnostics
    assert [note.message for note in one.notes] == ["it is defined here as `ONE(x, y = ..., t = 2 sec)`"]


def test_a_misspelt_parameter_is_told_the_likeliest() -> None:
    (one,) = analyse(
        Source("GREET(motoin = WALK)\nlet GREET(other = TALK, motion = IDLE) = motion or other")
    ).diagnostics
    assert one.help == "it has `motion`"


def test_a_mistake_inside_of_a_definition_says_where_it_is_used(reference: Any) -> None:
    source = Source("let A(x) = x with Upper-Body TALK\nWALK\nA(SWING_HAND)")
    (one,) = (one for one in analyse(source, reference).diagnostics if one.severity == "error")
    assert one.span is not None
    assert source.slice(one.span) == "Upper-Body"
    assert [note.span and source.slice(note.span) for note in one.notes] == ["A(SWING_HAND)"]


def test_a_mistake_in_a_definition_is_told_once_however_often_it_is_used(codes: Codes, reference: Any) -> None:
    assert codes("let A(x) = x with WLAK\nA(WALK)\nA(TALK)\nrepeat 2 { A(IDLE) }", reference) == ["MS021"]
    assert codes("let A(x) = not (x with TALK)\nA(WALK)\nA(IDLE)", reference) == ["MS034"]
    assert codes("let A = B(WALK, TALK)\nlet B(x) = x\nA for 1 sec\nA", reference) == ["MS055"]


def test_what_a_definition_is_given_is_looked_up_where_it_is_given(reference: Any) -> None:
    source = Source("let A(x) = Upper-Body x\nWALK with A(WALK)")
    (one,) = analyse(source, reference).diagnostics
    assert one.code == "MS022"
    assert one.span is not None
    assert source.position(one.span.start) == (2, 13)


def test_a_graph_cannot_be_given(codes: Codes, reference: Any) -> None:
    assert codes("let A(g) = g (WALK)\nA(Upper-Body)", reference) == ["MS025"]
    assert codes("let A(g) = g(WALK, TALK)\nA(IDLE)", reference) == ["MS028"]
    assert codes("let A(g) = g WALK\nA(Upper-Body)", reference) == ["MS025"]
    assert codes("let A(x) = x\nA(Upper-Body)", reference) == ["MS024"]


# --- what is not used ---


@pytest.mark.parametrize(
    ("script", "unused"),
    [
        ("let A = WALK", []),
        ('use "more.ms"\nlet A = WALK', []),
        ("let A = WALK\nTALK", ["A"]),
        ("let A = WALK\nA", []),
        ("let A = B\nlet B = WALK\nTALK", ["A", "B"]),
        ("let A = B\nlet B = WALK\nA", []),
        ("let A(x = B) = x\nlet B = WALK\nA", []),
        ("let A(B) = B\nlet B = WALK\nA(WALK)", ["B"]),
        ("let A = WALK\nB(A)\nlet B(x) = x", []),
        ("let A = WALK\nUpper-Body A", []),
        ("let A = WALK\nrepeat 2 { choose { WALK | A } }", []),
        ("let A = WALK\nend A", ["A"]),
        ("let A = WALK\nA(", []),
        ("let A = WALK\nWALK WALK WALK", []),
        ("let A = WALK\nlet B = TALK TALK TALK", []),
    ],
)
def test_a_definition_that_nothing_uses_is_told_in_a_script_that_does_something(script: str, unused: list[str]) -> None:
    assert [place for code, _, place in said(script) if code == "MS054"] == unused


def test_what_is_not_used_is_not_told_where_it_may_have_been_meant(codes: Codes, reference: Any) -> None:
    assert codes("let STROLL = WALK\nSTROL", reference) == ["MS021"]
    assert codes("let STROLL(x) = x\nSTROL(WALK)", reference) == ["MS028"]
    assert codes("let A(time = 1 sec) = WALK for tme\nA", reference) == ["MS027"]


# --- what becomes too large ---


CHAIN = "\n".join(f"let A{number} = A{number + 1}" for number in range(200))


@pytest.mark.parametrize(
    "script",
    [
        f"A0\n{CHAIN}\nlet A200 = WALK",
        "A0\n" + "\n".join(f"let A{n} = A{n + 1} or A{n + 1}" for n in range(300)) + "\nlet A300 = WALK",
        "A(" * 60 + "WALK" + ")" * 60 + "\nlet A(x) = x or x",
        "A(" * 60 + "WALK" + ")" * 60 + "\nlet A(x) = " + "(" * 60 + "x" + ")" * 60,
        "A(" * 60 + "WALK" + ")" * 60 + "\nlet A(x) = " + "not " * 60 + "x",
        "A(" * 12 + "WALK" + ")" * 12 + "\nlet A(x) = B(B(x)) and B(x)\nlet B(x) = x or (x and x)",
        "A0(WALK)\n" + "\n".join(f"let A{n}(x) = A{n + 1}(A{n + 1}(x))" for n in range(40)) + "\nlet A40(x) = x or x",
    ],
)
def test_what_grows_without_bound_is_one_mistake(script: str, codes: Codes, reference: Any) -> None:
    assert codes(script, reference) == ["MS048"]
    assert codes(script) == ["MS048"]


@pytest.mark.parametrize("depth", [30, 60])
def test_what_is_as_deep_as_may_be_is_played(depth: int, codes: Codes, reference: Any) -> None:
    script = "A(" * depth + "WALK" + ")" * depth + "\nlet A(x) = x"
    assert codes(script, reference) == []
    assert codes("A(" + "(" * depth + "WALK" + ")" * depth + ")\nlet A(x) = " + "(" * depth + "x" + ")" * depth) == []


def test_a_large_command_without_definitions_may_stand_beside_one(codes: Codes, reference: Any) -> None:
    assert codes("let A = WALK\nA for 1 sec\n" + " or ".join(["TALK"] * 5_000), reference) == []


def test_a_script_may_not_grow_too_large_in_all(codes: Codes, monkeypatch: pytest.MonkeyPatch) -> None:
    script = "let A = " + " or ".join(["WALK"] * 500) + "\n" + "A for 1 sec\n" * 30 + "WALK\n" * 30
    assert codes(script) == []
    monkeypatch.setattr(expand, "MAX_ALL_NODES", 10_000)
    assert codes(script) == ["MS048"]
    ((_, _, place),) = said(script)
    assert place == "A for 1 sec"


# --- what has none ---


def test_a_script_without_definitions_is_left_as_it_is() -> None:
    analysis = analyse(Source("WALK with TALK\nrepeat 2 { IDLE }"))
    assert analysis.expanded is analysis.script


def test_a_command_that_uses_none_is_left_as_it_is() -> None:
    analysis = analyse(Source("let A = WALK\nWALK with (TALK or (A))\nIDLE or not (TALK and Upper-Body (WALK))"))
    _, used, plain = analysis.script.items
    assert [type(item) for item in analysis.expanded.items] == [syntax.Command, syntax.Command]
    assert analysis.expanded.items[1] is plain
    assert analysis.expanded.items[0] is not used


def test_names_in_another_case_are_not_those_of_definitions(codes: Codes, reference: Any) -> None:
    assert codes("let Strolling = WALK\nstrolling", reference) == ["MS021"]
