"""One mistake, one message: what is said of right scripts after one slip of the hand.

Each script of tests/scripts, examples and the pages on the language is edited in one place: a word or sign too many,
one too few, twice, swapped with the next, misspelt, in the wrong case or from another keyboard. How many such texts are
told of more than one error is measured, and may not become more; so is how many are told of another error once the
edits that are safe have been applied. `--all-edits` tries all edits.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeAlias

import pytest

from mlmg_lang.definitions.gather import Files, NoFiles
from mlmg_lang.diagnostics import Diagnostic, Severity
from mlmg_lang.front_end import analyse
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.script_files import used_files
from mlmg_lang.source import Source

ROOT = Path(__file__).parents[3]
FENCE = re.compile(r"^```motion-script(.*)\n((?:.*\n)*?)```", re.MULTILINE)
N_TRIED = 2_000
MOST = 0.005
"""The share of edits that may be told of more than one error."""
N_MENDED = 500
WORSE = 0.005
"""The share of edits that may be told of another error once all edits have been applied that are said to be safe."""

INSERTED = (
    *(",", ";", ".", ":", "=", "->", "|", "(", ")", "{", "}", '"', "3"),
    *("then", "please", "and", "with", "for", "not", "once"),
)
WIDE = str.maketrans(";:,()={}|", "；：，（）＝｛｝｜")


@dataclass(frozen=True)
class Right:
    """A script that has no error on its library."""

    text: str
    library: str
    start: str | None = None
    name: str = ""
    files: Files = field(default_factory=NoFiles)

    def errors(self, text: str, libraries: Mapping[str, Any]) -> list[Diagnostic]:
        """Return what is said of a text in its place."""
        found = analyse(Source(text, self.name), libraries[self.library], self.start, self.files).diagnostics
        return [one for one in found if one.severity is Severity.ERROR]


Slip: TypeAlias = tuple[Right, str, str]
"""A script, what kind of a slip is made in it, and the text then."""


@dataclass(frozen=True)
class Page:
    """The files that a page shows, by name."""

    files: Mapping[str, str]

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        """Return one of them."""
        return (Source(self.files[path], path), ()) if path in self.files else f"there is no file `{path}`"


def scripts() -> Iterator[Right]:
    """Yield scripts that may be right on the library that they are for."""
    for folder in ("tests/scripts", "examples"):
        for path in sorted((ROOT / folder).rglob("*.ms")):
            text = path.read_text(encoding="utf-8")
            start = re.search(r"^# start: *(.*?) *$", text, re.MULTILINE)
            for library in ("reference", "left-hand", "hands"):
                yield Right(text, library, start and start[1], str(path), used_files(path))
    for page in ("language.md", "types.md"):
        files: dict[str, str] = {}
        for match in FENCE.finditer((ROOT / "docs" / page).read_text(encoding="utf-8")):
            info = match[1].split()
            if info[:1] == ["file"]:
                files[info[1]] = match[2]
            yield Right(match[2], next(iter(info), "reference"), files=Page(dict(files)))


@pytest.fixture(scope="module")
def right_scripts(libraries: Mapping[str, Any]) -> list[Right]:
    """Return each script that is right, once, without its comments."""
    found: dict[str, Right] = {}
    for script in scripts():
        text = re.sub(r"[ \t]*#.*$", "", script.text, flags=re.MULTILINE)
        if libraries.get(script.library) is not None and text not in found and not script.errors(text, libraries):
            found[text] = Right(text, script.library, script.start, script.name, script.files)
    return list(found.values())


def edits(text: str) -> Iterator[tuple[str, str]]:
    """Yield all slips of one place in a script: of which kind, and the text then."""
    tokens = [token for token in tokenize(Source(text)) if token.type != "NEWLINE"]
    for token in tokens:
        start, end = token.span.start, token.span.end
        for kind, right in (*_left_out_or_added(token), *_misspelt(token)):
            if right != token.text:
                yield f"{kind} {token.type}", text[:start] + right + text[end:]
        for sign in INSERTED:
            yield f"insert {sign}", f"{text[:end]} {sign}{text[end:]}"
    for one, other in pairwise(tokens):
        between = text[one.span.end : other.span.start]
        if between and "\n" not in between:
            swapped = text[: one.span.start] + other.text + between + one.text + text[other.span.end :]
            yield f"swap {one.type} {other.type}", swapped


def _left_out_or_added(token: Token) -> Iterator[tuple[str, str]]:
    yield "drop", ""
    yield "double", f"{token.text} {token.text}"
    yield "wide", token.text.translate(WIDE)
    if token.type == "STRING":
        yield from (("unquote", token.text[1:]), ("unquote", token.text[:-1]))
        yield from (
            ("curly", f"“{token.text[1:]}"),
            ("curly", f"{token.text[:-1]}”"),
            ("curly", f"“{token.text[1:-1]}”"),
        )
    if token.type == "INTEGER":
        yield from (("minus", f"-{token.text}"), ("minus", f"–{token.text}"), ("point", f"{token.text}."))
        yield from (
            ("letter", f"{token.text}x"),
            ("wide", token.text.translate(str.maketrans("0123456789", "０１２３４５６７８９"))),
        )


def _misspelt(token: Token) -> Iterator[tuple[str, str]]:
    word = token.text
    if not word[0].isalpha():
        return
    middle = len(word) // 2
    before, letter, after = word[:middle], word[middle], word[middle + 1 :]
    yield "letter left out", before + after
    yield "letter twice", before + letter + letter + after
    yield "other letter", f"{before}x{after}"
    yield "case", word.swapcase()
    if middle:
        yield "letters swapped", before[:-1] + letter + before[-1] + after


@pytest.fixture(scope="module")
def slips(right_scripts: list[Right], request: pytest.FixtureRequest) -> Callable[[int], Sequence[Slip]]:
    """Return a function: about how many -> so many slips in right scripts, or all of them."""
    every = [(script, *edit) for script in right_scripts for edit in edits(script.text)]
    # Those of a kind stand beside each other, so that each kind is tried as often as it is there.
    every.sort(key=lambda one: one[1])
    return lambda n: every if request.config.getoption("--all-edits") else every[:: len(every) // n]


def safely_mended(text: str, told: Sequence[Diagnostic]) -> str:
    """Return a text with the safe edits of what is told of it, but those that touch one before them."""
    found = (fix for one in told for fix in one.fixes[:1] if fix.safe and fix.span.end <= len(text))
    end = len(text) + 1
    for fix in sorted(found, key=lambda fix: fix.span, reverse=True):
        if fix.span.end < end:
            end = fix.span.start
            text = text[:end] + fix.replacement + text[fix.span.end :]
    return text


def test_one_slip_is_told_as_one_mistake(libraries: Mapping[str, Any], slips: Callable[[int], Sequence[Slip]]) -> None:
    tried = slips(N_TRIED)
    wrong = [(kind, text) for script, kind, text in tried if len(script.errors(text, libraries)) > 1]
    share = len(wrong) / len(tried)
    kinds = Counter(kind for kind, _ in wrong).most_common()
    print(f"{len(wrong)} of {len(tried)} edits ({share:.2%}) give more than one error: {kinds}")
    assert share <= MOST, kinds


def test_safe_edits_of_one_slip_lead_to_no_other_error(
    libraries: Mapping[str, Any], slips: Callable[[int], Sequence[Slip]]
) -> None:
    tried = slips(N_MENDED)
    worse = []
    for script, kind, text in tried:
        told = script.errors(text, libraries)
        mended = safely_mended(text, told)
        known = {(one.code, one.message) for one in told}
        left = script.errors(mended, libraries) if mended != text else []
        worse += [f"{kind}: {one.message}" for one in left if (one.code, one.message) not in known][:1]
    print(f"{len(worse)} of {len(tried)} edits are told of another error when mended: {worse}")
    assert len(worse) / len(tried) <= WORSE, worse


def test_the_edits_are_many_and_of_many_kinds(right_scripts: list[Right]) -> None:
    assert len(right_scripts) > 90
    assert len({kind for script in right_scripts for kind, _ in edits(script.text)}) > 100
