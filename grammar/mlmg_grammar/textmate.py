"""The grammar's terminals -> a TextMate grammar, and what VS Code asks of a language besides.

The patterns together match every character of a line, and of those that match at a place the first counts: so they cut
a line into the same tokens as the compiler. What a name is for is said as `roles` says it.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from functools import cached_property
from types import MappingProxyType
from typing import Any, Final, TypeAlias

from mlmg_grammar import grammar_text
from mlmg_grammar.definitions import definitions
from mlmg_grammar.expressions import Choice, Expression, Optional, Pattern, Repeat, Sequence, Symbol, Text
from mlmg_grammar.roles import BEGINS_STATEMENT, ROLES, Role

SCOPE_NAME: Final = "source.motion-script"
FILE_TYPES: Final = ("ms",)

SCOPES: Final[Mapping[Role, str]] = MappingProxyType(
    {
        Role.COMMENT: "comment.line.number-sign",
        Role.DECLARATION: "storage.type.let",
        Role.IMPORT: "keyword.control.import",
        Role.STATEMENT: "keyword.control",
        Role.JOINER: "keyword.operator.wordlike",
        Role.CLAUSE: "keyword.other.clause",
        Role.RESERVED: "keyword.reserved",
        Role.NUMBER: "constant.numeric",
        Role.UNIT: "keyword.other.unit",
        Role.NAME: "variable.other.motion",
        Role.QUOTED: "string.quoted.double",
        Role.GRAPH: "entity.name.type.graph",
        Role.CALL: "entity.name.function.call",
        Role.DEFINED: "entity.name.function.definition",
        Role.PARAMETER: "variable.parameter",
        Role.WRONG: "invalid.illegal",
    }
)
"""What themes call each role; white space has none, and signs have one each."""

SIGNS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "LEFT": "punctuation.section.parens.begin",
        "RIGHT": "punctuation.section.parens.end",
        "OPEN": "punctuation.section.block.begin",
        "CLOSE": "punctuation.section.block.end",
        "BAR": "punctuation.separator.branch",
        "SEMICOLON": "punctuation.terminator.statement",
        "COLON": "punctuation.separator.weight",
        "COMMA": "punctuation.separator.argument",
        "EQUALS": "keyword.operator.assignment",
    }
)

_ESCAPES: Final = (
    {"match": r"\\[\"\\]", "name": "constant.character.escape.motion-script"},
    {"match": r"\\.", "name": "invalid.illegal.escape.motion-script"},
)

_WORDS: Final = (Role.DECLARATION, Role.IMPORT, Role.STATEMENT, Role.JOINER, Role.CLAUSE, Role.RESERVED)
_SCRIPT: Final = (
    *("white-space", "comment", "definition", "end", "amount", "words"),
    *("quantity", "quoted", "names", "signs", "wrong"),
)
"""The rules that can match anywhere in a script; the first that matches counts."""

Rule: TypeAlias = dict[str, Any]


def textmate_grammar() -> Rule:
    """Return the grammar as editors read it: VS Code, Sublime Text, Zed, GitHub."""
    return _Maker().grammar()


def language_configuration() -> Rule:
    """Return what VS Code asks of a language beside its colours: brackets, comments, words, folding, indentation."""
    word = _Maker()
    number = word.any_of("DECIMAL", "INTEGER")
    pairs = [["{", "}"], ["(", ")"]]
    closing = [{"open": left, "close": right, "notIn": ["string", "comment"]} for left, right in pairs]
    quotes = {"open": '"', "close": '"', "notIn": ["string", "comment"]}
    return {
        "comments": {"lineComment": "#"},
        "brackets": pairs,
        "colorizedBracketPairs": pairs,
        "autoClosingPairs": [*closing, quotes],
        "autoCloseBefore": ' \t\r\n)}|;:,=#"',
        "surroundingPairs": [*pairs, ['"', '"']],
        "wordPattern": f"{number}|{word.regexp('NAME')}",
        "folding": {"offSide": False, "markers": {"start": r"^\s*#\s*region\b", "end": r"^\s*#\s*endregion\b"}},
        "indentationRules": {
            "increaseIndentPattern": r"^(?:[^\"#{}]|\"(?:[^\"\\]|\\.)*\"|\{[^{}]*\})*\{(?:[^{}]|\{[^{}]*\})*$",
            "decreaseIndentPattern": r"^\s*\}",
        },
        "onEnterRules": [
            {"beforeText": r"^[^#]*\{\s*$", "afterText": r"^\s*\}", "action": {"indent": "indentOutdent"}},
            {"beforeText": r"^[^#]*\{\s*(?:#.*)?$", "action": {"indent": "indent"}},
        ],
    }


def as_json(rule: Rule) -> str:
    """Return the text of a file of it."""
    return json.dumps(rule, indent=2, ensure_ascii=True) + "\n"


def oniguruma(regexp: str) -> str:
    r"""Return a regular expression of Python as Oniguruma writes it: code points as `\x{...}`."""
    return re.sub(r"\\x([0-9a-f]{2})|\\u([0-9a-f]{4})|\\U([0-9a-f]{8})", _code_point, regexp)


def _code_point(match: re.Match[str]) -> str:
    digits = next(group for group in match.groups() if group)
    return f"\\x{{{int(digits, 16):x}}}"


class _Maker:
    """Writes patterns from the terminals. `space`, `names` and so on are regular expressions of Oniguruma."""

    def __init__(self) -> None:
        self._terminals = definitions(grammar_text())

    # --- regular expressions ---

    def regexp(self, terminal: str) -> str:
        """Return what a terminal matches, as a regular expression of Python."""
        return self._written(self._terminals[terminal])

    def _written(self, expression: Expression) -> str:
        match expression:
            case Text(text):
                regexp = re.escape(text)
            case Pattern(regexp):
                pass
            case Symbol(name):
                regexp = self.regexp(name)
            case Sequence(parts):
                regexp = "".join(map(self._written, parts))
            case Choice(options):
                regexp = f"(?:{'|'.join(map(self._written, options))})"
            case Optional(Repeat(part, None)):
                regexp = f"(?:{self._written(part)})*"
            case Repeat(part, None):
                regexp = f"(?:{self._written(part)})+"
            case Optional(part):
                regexp = f"(?:{self._written(part)})?"
            case _:
                raise ValueError(f"expected what a terminal can be made of, found {expression}")
        return regexp

    def any_of(self, *terminals: str) -> str:
        """Return what one of several terminals matches, the first that does."""
        return f"(?:{'|'.join(map(self.regexp, terminals))})"

    def _words(self, *wanted: Role) -> str:
        """Return the reserved words of some roles, each whole."""
        words = (terminal for terminal, role in ROLES.items() if role in wanted)
        return self.any_of(*words) + self.regexp("_NAME_END")

    @cached_property
    def space(self) -> str:
        return f"(?:{self.regexp('SPACE')})?"

    @cached_property
    def name(self) -> str:
        """A name to its very end, without quotes; it may be a reserved word, unless that has been ruled out."""
        return self.regexp("NAME") + self.regexp("_NAME_END")

    @cached_property
    def no_word(self) -> str:
        """Not a reserved word here, nor what cannot begin a name."""
        return f"(?!{self._words(*_WORDS)}|{self.regexp('SPACE')})"

    @cached_property
    def any_name(self) -> str:
        return f"{self.no_word}(?:{self.name}|{self.regexp('STRING')})"

    # --- rules ---

    def grammar(self) -> Rule:
        """Return the whole grammar; each rule says which others may stand in it."""
        escapes = {"patterns": [dict(escape) for escape in _ESCAPES]}
        return {
            "information_for_contributors": ["Made from motion_script.lark; see docs/grammar.md."],
            "name": "Motion Script",
            "scopeName": SCOPE_NAME,
            "fileTypes": list(FILE_TYPES),
            "patterns": [_include("script")],
            "repository": {
                "script": {"patterns": [_include(name) for name in _SCRIPT]},
                "white-space": {"match": oniguruma(self.regexp("SPACE"))},
                "comment": self._comment(),
                "definition": {"patterns": [self._parameters(), self._definition()]},
                "default": self._default(),
                "group": self._group(),
                "end": self._end(),
                "amount": {"patterns": list(self._amount())},
                "words": {"patterns": list(self._keywords())},
                "quantity": {"patterns": list(self._quantities())},
                "quoted": {"patterns": list(self._quoted())},
                "names": {"patterns": list(self._names())},
                "signs": {"patterns": [_match(self.regexp(sign), SIGNS[sign]) for sign in SIGNS]},
                "wrong": _match(self.any_of("UNCLOSED", "UNKNOWN"), SCOPES[Role.WRONG]),
                "escapes": escapes,
            },
        }

    def _comment(self) -> Rule:
        sign = self.regexp("COMMENT").removeprefix("#")
        return _match(f"(#){sign}", SCOPES[Role.COMMENT], {1: "punctuation.definition.comment"})

    def _keywords(self) -> Iterable[Rule]:
        return (_match(self._words(role), SCOPES[role]) for role in _WORDS)

    def _quantities(self) -> Iterable[Rule]:
        number = self.any_of("DECIMAL", "INTEGER")
        yield _match(f"({number}){self.space}({self.regexp('UNIT')})", None, {1: Role.NUMBER, 2: Role.UNIT})
        yield _match(number, SCOPES[Role.NUMBER])

    def _quoted(self) -> Iterable[Rule]:
        string = self.regexp("STRING")
        for regexp, role in (
            (f"{string}(?=\\()", Role.CALL),
            (f"{string}(?={self.space}(?:\\(|{self.any_name}))", Role.GRAPH),
            (string, None),
        ):
            scope = SCOPES[Role.QUOTED] if role is None else f"{SCOPES[Role.QUOTED]} {SCOPES[role]}"
            yield {**_match(regexp, scope), **_escapes(0)}

    def _names(self) -> Iterable[Rule]:
        """Yield what a name is by what comes after it."""
        yield _match(f"{self.name}(?={self.space}=)", SCOPES[Role.PARAMETER])
        yield _match(f"{self.name}(?=\\()", SCOPES[Role.CALL])
        yield _match(f"{self.name}(?={self.space}(?:\\(|{self.any_name}))", SCOPES[Role.GRAPH])
        yield _match(self.name, SCOPES[Role.NAME])

    def _end(self) -> Rule:
        """`end GRAPH`."""
        end = f"({self.regexp('END')}{self.regexp('_NAME_END')}){self.space}({self.any_name})"
        return _match(end, None, {1: Role.STATEMENT, 2: Role.GRAPH})

    def _amount(self) -> Iterable[Rule]:
        """Yield `for` and `wait` before a name, which can only be a parameter's."""
        for word, role in (("FOR", Role.CLAUSE), ("WAIT", Role.STATEMENT)):
            head = f"({self.regexp(word)}{self.regexp('_NAME_END')}){self.space}"
            yield _match(f"{head}({self.no_word}{self.name})", None, {1: role, 2: Role.PARAMETER})

    # --- definitions ---

    def _head(self) -> str:
        """`let NAME`, in two groups."""
        return f"({self.regexp('LET')}{self.regexp('_NAME_END')}){self.space}({self.any_name})"

    def _definition(self) -> Rule:
        return _match(self._head(), None, {1: Role.DECLARATION, 2: Role.DEFINED})

    def _parameters(self) -> Rule:
        """`let NAME ( ... )`: what stands in the parentheses are parameters."""
        begin = _match(f"{self._head()}{self.space}(\\()", None, {1: Role.DECLARATION, 2: Role.DEFINED, 3: "LEFT"})
        parameter = _match(self.name, SCOPES[Role.PARAMETER])
        inner = ("default", "group", *_SCRIPT[: _SCRIPT.index("names")])
        after = _SCRIPT[_SCRIPT.index("names") + 1 :]
        return {
            "begin": begin["match"],
            "beginCaptures": begin["captures"],
            "end": oniguruma(f"(\\))|{self._cut_off()}"),
            "endCaptures": {"1": {"name": f"{SIGNS['RIGHT']}.motion-script"}},
            "patterns": [*map(_include, inner), parameter, *map(_include, after)],
        }

    def _default(self) -> Rule:
        """What stands after the `=` of a parameter."""
        return {
            "begin": "=",
            "beginCaptures": {"0": {"name": f"{SIGNS['EQUALS']}.motion-script"}},
            "end": oniguruma(f"(?=[,)])|{self._cut_off()}"),
            "patterns": [_include("group"), _include("script")],
        }

    def _group(self) -> Rule:
        """Parentheses inside of those of the parameters."""
        return {
            "begin": "\\(",
            "beginCaptures": {"0": {"name": f"{SIGNS['LEFT']}.motion-script"}},
            "end": oniguruma(f"(\\))|{self._cut_off()}"),
            "endCaptures": {"1": {"name": f"{SIGNS['RIGHT']}.motion-script"}},
            "patterns": [_include("group"), _include("script")],
        }

    def _cut_off(self) -> str:
        """Return where a parenthesis that is not closed ends, as layout has it."""
        return f"(?=[;{{}}|])|^(?={self.space}{self._words(*BEGINS_STATEMENT)})"


def _include(name: str) -> Rule:
    return {"include": f"#{name}"}


def _match(regexp: str, scope: str | None, groups: Mapping[int, Role | str] | None = None) -> Rule:
    """Return a rule that matches a regular expression of Python, and says what it and its groups are."""
    rule: Rule = {"match": oniguruma(regexp)}
    if scope is not None:
        rule["name"] = _full(scope)
    if groups:
        rule["captures"] = {str(group): _capture(what) for group, what in groups.items()}
    return rule


def _capture(what: Role | str) -> Rule:
    if not isinstance(what, Role):
        return {"name": _full(SIGNS.get(what, what))}
    names = (Role.GRAPH, Role.DEFINED)
    return {"name": _full(SCOPES[what]), **({"patterns": [_include("escapes")]} if what in names else {})}


def _escapes(group: int) -> Rule:
    return {"captures": {str(group): {"patterns": [_include("escapes")]}}}


def _full(scopes: str) -> str:
    """Return scopes with the name of the language at the end of each."""
    return " ".join(f"{scope}.motion-script" for scope in scopes.split())
