"""What tests of the grammar share: a small reader of TextMate grammars, as editors have a large one."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import pytest

Rule = Mapping[str, Any]
Piece = tuple[int, int, tuple[str, ...]]


@cache
def compiled(oniguruma: str) -> re.Pattern[str]:
    """Return a pattern of Oniguruma for Python; the grammar uses only what both understand, but for code points."""
    return re.compile(re.sub(r"\\x\{([0-9a-f]+)\}", lambda match: f"\\U{int(match[1], 16):08x}", oniguruma))


@dataclass
class Ahead:
    """What each pattern matches next in a line, kept until it is passed: else a long line takes its length squared."""

    line: str
    next: dict[str, re.Match[str] | None] = field(default_factory=dict)

    def search(self, pattern: str, at: int) -> re.Match[str] | None:
        """Return the first match of a pattern from a place on; places are asked for in order."""
        known = self.next.get(pattern)
        if pattern not in self.next or (known is not None and known.start() < at):
            self.next[pattern] = compiled(pattern).search(self.line, at)
        return self.next[pattern]


@dataclass
class TextMate:
    """Colours text by a grammar: match, begin and end, captures, include; one line after the other."""

    grammar: Rule

    def pieces(self, text: str) -> Iterator[tuple[str, tuple[str, ...]]]:
        """Yield every stretch of a text with its scopes, outermost first, without that of the language."""
        stack: list[Rule] = [self.grammar]
        for line in re.findall(r"[^\r\n]*(?:\r\n|\n|\r)|[^\r\n]+", text):
            yield from ((line[start:end], scopes) for start, end, scopes in self._line(line, stack))

    def _line(self, line: str, stack: list[Rule]) -> Iterator[Piece]:
        at = 0
        ahead = Ahead(line)
        while at < len(line):
            rule, key, match = self._first(ahead, at, stack[-1])
            if match is None:
                yield at, len(line), ()
                return
            if match.start() > at:
                yield at, match.start(), ()
            captures = rule.get("captures" if key == "match" else f"{key}Captures", {})
            yield from self._captured(match, rule.get("name", ""), captures)
            if key == "begin":
                stack.append(rule)
            elif key == "end":
                stack.pop()
            at = match.end()

    def _first(self, ahead: Ahead, at: int, inside: Rule) -> tuple[Rule, str, re.Match[str] | None]:
        """Return the rule that matches first, and of those that match there the one that is listed first."""
        rules = [(inside, "end")] if "end" in inside else []
        rules += [(rule, "match" if "match" in rule else "begin") for rule in self._flat(inside["patterns"])]
        found = [(rule, key, ahead.search(rule[key], at)) for rule, key in rules]
        return min(found, key=lambda one: len(ahead.line) + 1 if one[2] is None else one[2].start())

    def _flat(self, patterns: list[Rule]) -> Iterator[Rule]:
        for rule in patterns:
            target = self.grammar["repository"][rule["include"][1:]] if "include" in rule else rule
            if "match" in target or "begin" in target:
                yield target
            else:
                yield from self._flat(target["patterns"])

    def _captured(self, match: re.Match[str], name: str, captures: Mapping[str, Rule]) -> Iterator[Piece]:
        """Yield what a match is cut into by its groups; groups do not overlap here, but for the whole."""
        outer = (*name.split(), *captures.get("0", {}).get("name", "").split())
        at = match.start()
        for group, capture in sorted(captures.items(), key=lambda one: int(one[0])):
            start, end = match.span(int(group))
            if group == "0" or start < 0:
                continue
            if at < start:
                yield at, start, outer
            yield start, end, (*outer, *capture.get("name", "").split())
            at = end
        if at < match.end():
            yield at, match.end(), outer


@pytest.fixture(scope="session")
def textmate() -> Callable[[Rule], TextMate]:
    """Return what colours text by a grammar."""
    return TextMate
