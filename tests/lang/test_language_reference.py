"""Every example in the pages on the language does what is written below it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from mlmg_lang.definitions.expand import MAX_NODES
from mlmg_lang.definitions.gather import MAX_FILES
from mlmg_lang.diagnostics import CODES, Diagnostic, Severity
from mlmg_lang.execution import drawing, executed
from mlmg_lang.front_end import Analysis, analyse
from mlmg_lang.parsing.layout import MAX_DEPTH
from mlmg_lang.parsing.parse import MAX_MISTAKES, MAX_STATEMENT
from mlmg_lang.parsing.structure import LONGEST_S, MAX_EXECUTED
from mlmg_lang.parsing.tokenize import MAX_TOKENS
from mlmg_lang.perform import perform
from mlmg_lang.planning.resolved import Choose, Command, Cycles, End, Once, Repeat, Seconds, Statement, Wait
from mlmg_lang.source import Source
from mlmg_runtime.library import Library

DOCS = Path(__file__).parents[2] / "docs"
PAGES = ("language.md", "types.md")
FENCE = re.compile(
    r"^```motion-script(?P<info>.*)\n(?P<text>(?:.*\n)*?)```\n(?:```result\n(?P<result>(?:.*\n)*?)```\n)?", re.M
)


@dataclass(frozen=True)
class Example:
    """A script in a page.

    Attributes
    ----------
    info : what stands after `motion-script`: a library, `plays`, or `file` with a name.
    result : what is written below it; None where nothing is.
    files : those above it, by name.
    """

    page: str
    line: int
    info: tuple[str, ...]
    text: str
    result: str | None
    files: Mapping[str, str]

    @property
    def library(self) -> str:
        """Return the library that it is read against."""
        return next((word for word in self.info if word != "plays"), "reference")

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        """Return a file that the page shows."""
        return (Source(self.files[path], path), ()) if path in self.files else f"there is no file `{path}`"


def examples() -> Iterator[Example]:
    for page in PAGES:
        text = (DOCS / page).read_text(encoding="utf-8")
        files: dict[str, str] = {}
        for match in FENCE.finditer(text):
            info = tuple(match["info"].split())
            if info[:1] == ("file",):
                files = {**files, info[1]: match["text"]}
            line = text.count("\n", 0, match.start()) + 1
            yield Example(page, line, info, match["text"], match["result"], files)


EXAMPLES = list(examples())
WITH_RESULT = [one for one in EXAMPLES if one.result is not None]
FILES = [one for one in EXAMPLES if one.info[:1] == ("file",)]
PLAYED = [one for one in EXAMPLES if "plays" in one.info]


def named(example: Example) -> str:
    return f"{example.page}:{example.line}"


def result(analysis: Analysis) -> Iterator[str]:
    """Yield what a page shows of a script: what is played, then what is said of it."""
    if analysis.resolved is not None:
        yield f"starts in {analysis.resolved.start}"
        yield from shown(analysis.resolved.statements, analysis.source)
    for one in analysis.diagnostics:
        assert one.span is not None
        line, column = analysis.source.position(one.span.start)
        yield f"{line}:{column} {one.severity}[{one.code}]: {one.message}"


def shown(statements: Iterable[Statement], source: Source) -> Iterator[str]:
    for statement in statements:
        line, _ = source.position(statement.span.start)
        match statement:
            case Command(layers, duration):
                targets = "; ".join(f"{layer.graph} {' '.join(layer.candidates)}" for layer in layers)
                yield f"{line}: {targets}{', ' if duration else ''}{how_long(duration)}"
            case Wait(duration):
                yield f"{line}: wait {how_long(duration).removeprefix('for ')}"
            case End(graph):
                yield f"{line}: end {graph}"
            case Repeat(count, body):
                yield f"{line}: {count} times"
                yield from (f"  {inner}" for inner in shown(body, source))
            case Choose(branches):
                yield f"{line}: one of"
                for branch in branches:
                    yield f"  weight {branch.weight}"
                    yield from (f"    {inner}" for inner in shown(branch.body, source))


def how_long(duration: Seconds | Cycles | Once | None) -> str:
    match duration:
        case Seconds(number):
            return f"for {number:g} s"
        case Cycles(number):
            return f"for {number:g} cycles"
        case Once():
            return "once"
    return ""


@pytest.mark.parametrize("example", WITH_RESULT, ids=named)
def test_an_example_does_what_the_page_says(example: Example, libraries: Mapping[str, Any]) -> None:
    analysis = analyse(Source(example.text), libraries[example.library], files=example)
    assert "\n".join(result(analysis)) + "\n" == example.result


@pytest.mark.parametrize("example", FILES, ids=named)
def test_a_file_that_a_page_shows_has_no_errors(example: Example) -> None:
    found = analyse(Source(example.text), files=example).diagnostics
    assert [one for one in found if one.severity is Severity.ERROR] == []


@pytest.mark.parametrize("example", PLAYED, ids=named)
def test_an_example_plays_on_the_demo_library(example: Example, demo_library: Library) -> None:
    analysis = analyse(Source(example.text), demo_library, files=example)
    assert analysis.resolved is not None
    report = perform(analysis.resolved, demo_library).report
    lines = {command["span"][0] for command in report["commands"]}
    assert lines <= {number for number, _ in enumerate(example.text.split("\n"), start=1)}
    assert report["n_frames"] > 0


@pytest.mark.parametrize("example", PLAYED, ids=named)
def test_what_plays_lasts_as_long_as_the_page_says(example: Example, demo_library: Library) -> None:
    plan = analyse(Source(example.text), demo_library, files=example).resolved
    assert plan is not None
    report = perform(plan, demo_library).report
    commands = [step for step in executed(plan, drawing(0)) if isinstance(step, Command)]
    for command, entry in zip(commands, report["commands"], strict=True):
        length = demo_library.n_frames(entry["motions"][command.layers[0].graph])
        match command.duration:
            case Cycles(number):
                assert entry["end"] - entry["arrive"] == round(number * length)
            case Seconds(number):
                assert entry["end"] - entry["arrive"] == round(number * report["frame_rate"])
            case Once():
                assert 0 < entry["end"] - entry["arrive"] <= length


def test_every_code_of_names_types_playing_and_definitions_stands_in_the_page_on_types() -> None:
    text = (DOCS / "types.md").read_text(encoding="utf-8")
    meant = {code for code in CODES if "MS020" <= code < "MS060"} | {"MS015", "MS016", "MS017"}
    assert set(re.findall(r"MS\d+", text)) == meant


def test_every_code_is_shown_by_an_example() -> None:
    shown_codes = set(re.findall(r"\[(MS\d+)\]", "".join(one.result or "" for one in EXAMPLES)))
    of_files_and_limits = {"MS001", "MS005", "MS006", "MS007", "MS008", "MS059"}
    of_options = {"MS044"}
    of_letters_and_signs = {"MS002", "MS003", "MS004", "MS010", "MS012", "MS013", "MS014", "MS018", "MS019"}
    assert set(CODES) - shown_codes == of_files_and_limits | of_options | of_letters_and_signs


def test_the_limits_are_those_of_the_compiler() -> None:
    text = (DOCS / "language.md").read_text(encoding="utf-8").partition("## Limits")[2]
    numbers = [int(number.replace(",", "")) for number in re.findall(r"\| ([\d,]+) \| MS", text)]
    assert numbers == [MAX_DEPTH, MAX_MISTAKES, MAX_STATEMENT, MAX_TOKENS, MAX_EXECUTED, MAX_NODES, MAX_FILES]
    assert LONGEST_S == 24 * 3600


@pytest.mark.parametrize("page", [*PAGES, "grammar.md"])
def test_every_link_of_a_page_leads_somewhere(page: str) -> None:
    for target in re.findall(r"\]\(([^)]+)\)", (DOCS / page).read_text(encoding="utf-8")):
        file, _, heading = target.partition("#")
        path = DOCS / (file or page)
        assert path.is_file(), target
        assert not heading or heading in set(headings(path.read_text(encoding="utf-8"))), target


def headings(text: str) -> Iterator[str]:
    """Yield what links call the headings of a page."""
    for title in re.findall(r"^#+ (.*)$", text, re.MULTILINE):
        yield re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-")


def test_every_example_of_the_pages_is_run() -> None:
    texts = [(DOCS / page).read_text(encoding="utf-8") for page in PAGES]
    assert len(EXAMPLES) == sum(text.count("```motion-script") for text in texts)
    assert len(WITH_RESULT) == sum(text.count("```result") for text in texts) == len(EXAMPLES) - len(FILES)
    assert len(WITH_RESULT) > 40
    assert len(PLAYED) > 5


def test_the_page_lists_every_code_with_its_severity_and_title() -> None:
    text = (DOCS / "language.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (MS\d+) \| (\w+) \| (.*) \|$", text, re.MULTILINE)
    assert rows == [(code, rule.severity.value, rule.title) for code, rule in CODES.items()]
