"""After each of many random edits, all that is said of a text is what a fresh server says of it.

The fresh one is a process that is told the whole text each time; it is compared in turn with one that was just started.
With `--edits N`, N edits are tried: `make edits`.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from runpy import run_path
from typing import Any

import pytest

MADE = run_path(str(Path(__file__).parent / "random_edits.py"))
Author, after, as_sent = MADE["Author"], MADE["after"], MADE["as_sent"]
N_IN_A_SESSION = 100
WAYS = {
    "utf-8": {"textDocument": {"diagnostic": {}}},
    "utf-16": {"textDocument": {"publishDiagnostics": {"relatedInformation": True}}},
    "utf-32": {},
}
"""By encoding, the other capabilities of the client: it asks for diagnostics, or is told."""


class Editor:
    """A client with one text open, of which all is asked after each edit."""

    def __init__(self, start: Callable[..., Any], uri: str, encoding: str) -> None:
        self.client = start()
        self.client.initialize(WAYS[encoding] | {"general": {"positionEncodings": [encoding]}})
        self.uri, self.encoding, self.version = uri, encoding, 0
        self.tokens: dict[str, Any] = {}

    def open(self, text: str) -> Any:
        """Show a text, in place of the one before; return what is said of it."""
        if self.version:
            self.client.notify("textDocument/didClose", {"textDocument": {"uri": self.uri}})
        self.version += 1
        self.tokens = {}
        self.client.open(self.uri, text, self.version)
        return self.told()

    def edit(self, text: str, edit: Any) -> None:
        self.version += 1
        self.client.edit(self.uri, self.version, *as_sent(text, edit, self.encoding))

    def told(self) -> dict[str, Any]:
        """Return tokens, symbols and diagnostics."""
        asked = {"textDocument": {"uri": self.uri}}
        tokens = self.client.begin(*self.asking_for_tokens())
        methods = ("documentSymbol", "foldingRange")
        numbers = [(method, self.client.begin(f"textDocument/{method}", asked)) for method in methods]
        self.tokens = with_changes(self.tokens, self.client.result(tokens))
        found = {method: self.client.result(number) for method, number in numbers}
        found["tokens"] = self.tokens["data"]
        if "diagnostic" in WAYS[self.encoding].get("textDocument", {}):
            found["diagnostics"] = self.client.ask("textDocument/diagnostic", asked)["items"]
        else:
            found["diagnostics"] = self.client.diagnostics(self.uri, self.version)
        self.client.forget()
        return found

    def asking_for_tokens(self) -> tuple[str, Any]:
        """Return the request for what has changed of the tokens; now and then, for all."""
        asked: dict[str, Any] = {"textDocument": {"uri": self.uri}}
        if "resultId" in self.tokens and self.version % 4:
            return "textDocument/semanticTokens/full/delta", asked | {"previousResultId": self.tokens["resultId"]}
        return "textDocument/semanticTokens/full", asked


def with_changes(tokens: dict[str, Any], answer: dict[str, Any]) -> dict[str, Any]:
    """Return the tokens that an answer stands for, which may be all of them or what has changed."""
    if "data" in answer:
        return answer
    data = list(tokens["data"])
    for edit in sorted(answer["edits"], key=lambda one: one["start"], reverse=True):
        data[edit["start"] : edit["start"] + edit["deleteCount"]] = edit.get("data", [])
    return {"data": data, "resultId": answer.get("resultId")}


def sessions(n_edits: int) -> Iterator[tuple[int, int]]:
    """Yield a seed for each session, and how many edits it has."""
    for seed in range(-(-n_edits // N_IN_A_SESSION)):
        yield seed, min(N_IN_A_SESSION, n_edits - seed * N_IN_A_SESSION)


def play(seed: int, n_edits: int, edited: Editor, fresh: Editor) -> tuple[str, Any]:
    """Make the edits of a session; return the text at its end, and what was said of it."""
    author, haste = Author(seed), random.Random(seed)
    assert edited.open(author.text) == fresh.open(author.text)
    made: list[tuple[str, Any]] = []
    for _ in range(n_edits):
        for _ in range(haste.choice((1, 1, 1, 1, 1, 1, 1, 3))):  # some come before the last is understood
            made.append((author.text, author.edit()))
            edited.edit(*made[-1])
        told = edited.told()
        if told != fresh.open(author.text):
            pytest.fail(f"seed {seed}, {edited.encoding}\n{shortest(made, edited, fresh)}")
    return author.text, told


def shortest(made: Sequence[tuple[str, Any]], edited: Editor, fresh: Editor) -> str:
    """Return the fewest last edits after which it fails, with the text before them."""
    for first in reversed(range(len(made))):
        text = made[first][0]
        edited.open(text)
        for before, edit in made[first:]:
            edited.edit(before, edit)
            text, told = after(before, edit), edited.told()
        expected = fresh.open(text)
        if told != expected:
            return (
                f"text {made[first][0]!r}\nedits {[edit for _, edit in made[first:]]!r}\n"
                f"only after the edits: {without(told, expected)}\nonly afresh: {without(expected, told)}"
            )
    return f"only in haste: text {made[0][0]!r}\nedits {[edit for _, edit in made]!r}"


def without(told: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    """Return what is told and is not told by another."""
    items = {name: found["data"] if isinstance(found, dict) else found for name, found in told.items()}
    others = {name: found["data"] if isinstance(found, dict) else found for name, found in other.items()}
    return {
        name: [one for one in found if one not in others[name]]
        for name, found in items.items()
        if found != others[name]
    }


@pytest.fixture
def uri(tmp_path: Path) -> str:
    (tmp_path / "used.ms").write_text(MADE["USED"], encoding="utf-8")
    return (tmp_path / "script.ms").as_uri()


@pytest.mark.parametrize("encoding", WAYS)
def test_after_any_edits_all_that_is_said_is_what_a_fresh_server_says(start, start_program, uri, encoding, request):
    edited, fresh = (Editor(start, uri, encoding) for _ in range(2))
    n_edits = -(-request.config.getoption("--edits") // len(WAYS))
    for seed, n_in_session in sessions(n_edits):
        text, told = play(1000 * list(WAYS).index(encoding) + seed, n_in_session, edited, fresh)
        just_started = Editor(start_program, uri, encoding)
        assert just_started.open(text) == told
        assert just_started.client.leave() == 0
