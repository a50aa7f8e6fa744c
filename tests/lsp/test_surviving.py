"""What a server survives: ends without a word, messages that are none, strange texts, libraries that change."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

import pytest

URI = "untitled:Untitled-1"
PUSHED = {"textDocument": {"publishDiagnostics": {}}, "window": {}}
HERE = {"textDocument": {"uri": URI}, "position": {"line": 0, "character": 1}}
OPTIONS = {"tabSize": 4, "insertSpaces": True}
NOWHERE = "untitled:nowhere"
HUGE = (1 << 31) - 1
"""The greatest number that may stand in a place."""


def codes(diagnostics) -> list[str]:
    return [one["code"] for one in diagnostics]


def is_as_ever(client) -> bool:
    """Return whether a server still reads, checks and answers."""
    client.forget()
    client.open("untitled:as-ever", "WLAK for 3 sec", 77)
    found = client.ask_at("completion", "untitled:as-ever", 0, 1)["items"]
    return codes(client.diagnostics("untitled:as-ever", 77)) == ["MS021"] and "WALK" in [one["label"] for one in found]


@pytest.fixture(scope="module")
def survivor(start_for_all):
    """Return a client of a server that goes through one thing after the other."""
    client = start_for_all()
    client.initialize(PUSHED)
    yield client
    assert client.leave() == 0


# --- a server that is killed ---


def test_a_server_that_is_killed_leaves_nothing_behind_and_the_next_says_the_same(
    start_program, tmp_path, demo_library, monkeypatch
):
    for name in ("temporary", "library"):
        (tmp_path / name).mkdir()
    library = Path(shutil.copy(demo_library.path, tmp_path / "library" / "my.mlmg"))
    monkeypatch.setenv("TMPDIR", str(tmp_path / "temporary"))
    said = []
    for ends in (lambda client: client.process.kill(), lambda client: client.leave()):
        client = start_program("--library", str(library))
        client.initialize(PUSHED)
        client.open(URI, "WLAK for 3 sec\nIDLE\n")
        said.append((client.diagnostics(URI), client.ask("textDocument/documentSymbol", HERE)))
        client.open("untitled:long", "WALK   for 3 sec\n" * 20_000)
        client.begin("textDocument/formatting", {"textDocument": {"uri": "untitled:long"}, "options": OPTIONS})
        children = Path(f"/proc/{client.process.pid}/task/{client.process.pid}/children")
        assert not children.exists() or children.read_text(encoding="ascii") == ""
        ends(client)
        client.process.wait(60)
    assert said[0] == said[1]
    assert codes(said[0][0])[:1] == ["MS021"]
    assert [path.name for path in tmp_path.glob("*/*")] == ["my.mlmg"]
    assert library.read_bytes() == demo_library.path.read_bytes()


def test_a_client_that_goes_in_the_middle_of_a_message_ends_the_server(start_program):
    client = start_program()
    client.initialize()
    client.send_raw(b'Content-Length: 1000\r\n\r\n{"jsonrpc"')
    client.close()
    assert client.process.wait(60) == 1


def test_a_client_that_goes_while_it_is_answered_ends_the_server(start_program):
    client = start_program()
    client.initialize()
    client.open(URI, "WALK   for 3 sec\n" * 5_000)
    for _ in range(5):
        client.begin("textDocument/formatting", {"textDocument": {"uri": URI}, "options": OPTIONS})
    client.close()
    assert client.process.wait(60) == 1


# --- messages that are none ---


def with_length(length: int, body: bytes) -> bytes:
    return b"Content-Length: %d\r\n\r\n%b" % (length, body)


NOTED = json.dumps({"jsonrpc": "2.0", "method": "$/setTrace", "params": {"value": "off"}}).encode()


@pytest.mark.parametrize(
    "rubbish",
    [
        with_length(-5, NOTED),
        with_length(0, b""),
        with_length(3, NOTED) + b"\r\n",
        with_length(len(NOTED) + 7, NOTED) + with_length(len(NOTED), NOTED) + b"\r\n",
        with_length(1 << 40, b""),
        with_length(int("9" * 50), b"{}"),
        b"\0" * 100_000 + b"\r\n\r\n",
        with_length(200_000, b"[" * 200_000),
        with_length(2_000_000, b'{"jsonrpc": "2.0", "method": "x", "params": ' + b'{"a":' * 390_000 + b"0" * 49_956),
        with_length(4, b"null"),
        with_length(4, b"[[]]"),
        with_length(10_002, b"-" + b"9" * 10_001),
    ],
    ids=lambda one: repr(one[:40]),
)
def test_what_is_no_message_does_not_take_what_comes_after_it_along(survivor, rubbish):
    client = survivor
    client.send_raw(rubbish)
    assert is_as_ever(client)


@pytest.mark.parametrize(
    "message",
    [
        {"id": [], "method": "shutdown"},
        {"id": {"a": 1}, "method": "textDocument/hover", "params": HERE},
        {"id": 1.5, "method": "textDocument/hover", "params": HERE},
        {"id": None, "method": "textDocument/hover", "params": HERE},
        {"id": 100_007},
        {"id": "never asked", "result": {"a": 1}},
        {"id": "never asked", "error": "no"},
        {"id": [], "result": None},
        {"method": 5},
        {"method": None, "id": 100_008},
        {"method": "textDocument/didOpen"},
        {"method": "textDocument/didOpen", "params": [1, 2]},
        {"method": "textDocument/didOpen", "params": {"textDocument": {"uri": 5, "text": None, "version": "x"}}},
        {"method": "textDocument/didChange", "params": {"textDocument": {"uri": URI}, "contentChanges": "all"}},
        {"method": "textDocument/didChange", "params": {"textDocument": HERE["textDocument"]}},
        {"method": "textDocument/didClose", "params": HERE},
        {"method": "textDocument/didSave", "params": HERE},
        {"method": "$/cancelRequest", "params": {"id": []}},
        {"method": "$/cancelRequest"},
        {"method": "workspace/didChangeConfiguration", "params": {"settings": [{"mlmg": 5}]}},
        {"method": "workspace/didChangeConfiguration", "params": {"settings": {"mlmg": {"library": 5}}}},
        {"method": "workspace/didChangeWatchedFiles", "params": {"changes": [{"uri": "\0", "type": 2}]}},
        {"method": "workspace/didChangeWatchedFiles", "params": {"changes": [{"uri": URI, "type": 99}]}},
        {"method": "workspace/didChangeWorkspaceFolders", "params": {"event": {"added": [{"uri": "x"}]}}},
        {"method": "initialized"},
        {"method": "initialize", "params": {}},
    ],
    ids=json.dumps,
)
def test_a_message_of_the_wrong_shape_is_passed_over(survivor, message):
    client = survivor
    client.send(**message)
    assert is_as_ever(client)


@pytest.mark.parametrize(
    ("method", "params"),
    [
        ("textDocument/hover", None),
        ("textDocument/hover", {"textDocument": {"uri": URI}, "position": "here"}),
        ("textDocument/hover", {"textDocument": {"uri": URI}, "position": {"line": "x", "character": None}}),
        ("textDocument/rename", HERE | {"newName": 5}),
        ("textDocument/codeAction", HERE | {"range": [], "context": 5}),
        ("completionItem/resolve", {"label": 5, "data": {"uri": 7}}),
        ("completionItem/resolve", {"label": "x", "data": {"uri": "untitled:not-open"}}),
        ("codeAction/resolve", {"title": "x", "data": "x"}),
        ("workspace/executeCommand", {"command": "no.such", "arguments": {}}),
        ("textDocument/semanticTokens/full/delta", {"textDocument": {"uri": URI}, "previousResultId": 5}),
        ("textDocument/hover", HERE | {"textDocument": {"uri": "untitled:not-open"}}),
        ("no/such", {"a": "b"}),
    ],
    ids=str,
)
def test_a_request_of_the_wrong_shape_gets_one_answer(survivor, method, params):
    client = survivor
    client.open(URI, "WALK")
    number = client.begin(method, params)
    assert client.outcome(number)["id"] == number
    assert is_as_ever(client)


def test_answers_of_the_wrong_shape_to_what_the_server_asks_are_passed_over(start, demo_library):
    client = start()
    client.answer_with("workspace/configuration", 5)
    client.answer_with("client/registerCapability", "no")
    capabilities = {"workspace": {"configuration": True, "didChangeWatchedFiles": {"dynamicRegistration": True}}}
    client.initialize(PUSHED | capabilities)
    client.wait_for("workspace/configuration")
    assert is_as_ever(client)


# --- places that there are not ---


@pytest.mark.parametrize(
    ("start_at", "end_at", "expected"),
    [
        ((0, 4), (HUGE, HUGE), "WALKX"),
        ((HUGE, 0), (HUGE, 0), "WALK\nIDLEX"),
        ((1, HUGE), (0, HUGE), "WALKX"),
        ((1, 2), (0, 1), "WXLE"),
    ],
)
def test_an_edit_at_a_place_that_there_is_not_is_made_at_the_next_that_there_is(survivor, start_at, end_at, expected):
    client = survivor
    client.open(URI, "WALK\nIDLE")
    ends = [dict(zip(("line", "character"), at, strict=True)) for at in (start_at, end_at)]
    client.edit(URI, 2, {"range": dict(zip(("start", "end"), ends, strict=True)), "text": "X"})
    client.open("untitled:expected", expected)
    found = client.diagnostics("untitled:expected", 1)
    assert client.diagnostics(URI, 2) == found
    for uri in (URI, "untitled:expected"):
        client.ask("textDocument/formatting", {"textDocument": {"uri": uri}, "options": OPTIONS})
    both = [client.ask("textDocument/documentSymbol", {"textDocument": {"uri": u}}) for u in (URI, "untitled:expected")]
    assert both[0] == both[1]


@pytest.mark.parametrize("place", [(-1, 0), (0, -5), (HUGE + 1, 0), (0, 1 << 70)], ids=str)
def test_an_edit_at_what_is_no_place_is_passed_over(survivor, place):
    client = survivor
    client.forget()
    client.open(NOWHERE, "WLAK", 1)
    assert codes(client.diagnostics(NOWHERE, 1)) == ["MS021"]
    at = dict(zip(("line", "character"), place, strict=True))
    client.edit(NOWHERE, 2, {"range": {"start": at, "end": at}, "text": "X"})
    ends = {"start": {"line": 0, "character": 0}, "end": {"line": 0, "character": 4}}
    client.edit(NOWHERE, 3, {"range": ends, "text": "WALK"})
    assert client.diagnostics(NOWHERE, 3) == []


@pytest.mark.parametrize("place", [(-1, -1), (0, -1), (1 << 70, 0), (HUGE, HUGE), (0, HUGE), (1, 0)], ids=str)
def test_what_is_asked_of_a_place_that_there_is_not_is_answered(survivor, place):
    client = survivor
    client.open(URI, "WALK")
    at = dict(zip(("line", "character"), place, strict=True))
    here = {"textDocument": {"uri": URI}, "position": at, "range": {"start": at, "end": at}}
    more = {"newName": "x", "context": {"diagnostics": [], "includeDeclaration": True}, "positions": [at]}
    for method in (
        *("hover", "completion", "definition", "references", "documentHighlight", "signatureHelp", "codeAction"),
        *("inlayHint", "selectionRange", "semanticTokens/range", "rangeFormatting", "rename", "onTypeFormatting"),
    ):
        asked = here | more | {"options": OPTIONS, "ch": "\n"}
        answer = client.outcome(client.begin(f"textDocument/{method}", asked))
        assert answer.get("error", {}).get("code") != -32603, (method, answer)
    assert is_as_ever(client)


# --- texts ---


def test_a_text_that_is_opened_twice_is_what_it_was_opened_with_last(survivor):
    client = survivor
    client.open(URI, "WLAK", 1)
    client.open(URI, "WALK for 1 sec\nIDLE", 1)
    client.edit(
        URI, 2, {"range": {"start": {"line": 1, "character": 0}, "end": {"line": 1, "character": 4}}, "text": "WLAK"}
    )
    (wrong,) = client.diagnostics(URI, 2)
    assert wrong["range"]["start"]["line"] == 1
    for _ in range(2):
        client.notify("textDocument/didClose", {"textDocument": {"uri": URI}})
    assert client.outcome(client.begin("textDocument/hover", HERE))["error"]["code"] == -32801
    assert is_as_ever(client)


def test_versions_may_go_backwards(survivor):
    client = survivor
    client.open(URI, "WLAK", 9)
    assert codes(client.diagnostics(URI, 9)) == ["MS021"]
    client.edit(URI, 3, {"text": "WALK for 1 sec"})
    assert client.diagnostics(URI, 3) == []
    client.edit(URI, -1, {"text": "WLAK"})
    assert codes(client.diagnostics(URI, -1)) == ["MS021"]


@pytest.mark.parametrize(
    "uri",
    [
        *(
            "untitled:Untitled-1",
            "git:/a/b.ms?%7B%22ref%22%3A%22~%22%7D",
            "vscode-notebook-cell:/a.ms#W0",
            "memory://x",
        ),
        *(
            "file:///no/such/folder/a%20b%F0%9F%98%80.ms",
            "file://host/share/a.ms",
            "file:///",
            "file:",
            "not a uri",
            "",
        ),
        *("file:///a%00b.ms", "file:///%ff%fe.ms", "http://[::1/a.ms"),
    ],
    ids=repr,
)
def test_a_text_of_whatever_address_is_checked(survivor, uri):
    client = survivor
    client.open(uri, "WLAK")
    assert codes(client.diagnostics(uri)) == ["MS021"]
    client.edit(uri, 2, {"text": 'use "a.ms"\nlet x = WALK\nx for 2 sec'})
    assert "MS058" in codes(client.diagnostics(uri, 2))
    for method in ("hover", "definition", "references"):
        client.ask_at(method, uri, 2, 0, context={"includeDeclaration": True})
    edit = client.ask_at("rename", uri, 2, 0, newName="y")
    assert [uri] == list(edit["changes"])
    client.notify("textDocument/didClose", {"textDocument": {"uri": uri}})
    assert is_as_ever(client)


def test_half_a_character_is_no_reason_to_fail(survivor):
    client = survivor
    client.open(URI, "WALK # \ud83d\nWLAK # \ude00\nW\ud83dK")
    assert "MS021" in codes(client.diagnostics(URI, 1))
    for method in ("semanticTokens/full", "documentSymbol", "foldingRange"):
        client.ask(f"textDocument/{method}", {"textDocument": {"uri": URI}})
    client.ask("textDocument/formatting", {"textDocument": {"uri": URI}, "options": OPTIONS})
    at = {"line": 0, "character": 8}
    client.edit(URI, 2, {"range": {"start": at, "end": at}, "text": "\ude00"})
    assert "MS021" in codes(client.diagnostics(URI, 2))


# --- libraries that change ---


@pytest.fixture
def library(tmp_path: Path, demo_library) -> Path:
    (tmp_path / "mlmg.toml").write_text('library = "my.mlmg"', encoding="utf-8")
    return Path(shutil.copy(demo_library.path, tmp_path / "my.mlmg"))


def changed(client, library: Path) -> None:
    client.notify("workspace/didChangeWatchedFiles", {"changes": [{"uri": library.as_uri(), "type": 2}]})


def truncate(library: Path) -> None:
    os.truncate(library, library.stat().st_size // 3)


def become_folder(library: Path) -> None:
    library.unlink()
    library.mkdir()


def become_empty(library: Path) -> None:
    library.write_bytes(b"")


def overwrite(library: Path) -> None:
    library.write_bytes(os.urandom(library.stat().st_size))


@pytest.mark.parametrize("harm", [truncate, Path.unlink, become_folder, become_empty, overwrite])
def test_a_library_may_be_harmed_and_come_back_while_it_is_used(start, tmp_path, library, demo_library, harm):
    client, script = start("--stdio"), (tmp_path / "a.ms").as_uri()
    client.initialize(PUSHED)
    client.open(script, "WLAK for 3 sec")
    assert codes(client.diagnostics(script, 1)) == ["MS021"]
    harm(library)
    client.edit(script, 2, {"text": "Walk_01 for 3 secs\nWALK ("})  # nobody has told the server of it yet
    assert client.diagnostics(script, 2)
    for method in ("hover", "completion", "definition", "documentHighlight"):
        client.ask_at(method, script, 0, 3)
    changed(client, library)
    assert "my.mlmg" in client.wait_for("window/showMessage")["message"]
    client.edit(script, 3, {"text": "WLAK for 3 sec\nWALK ("})
    assert "MS021" not in codes(client.diagnostics(script, 3))
    assert client.ask_at("completion", script, 0, 0)["items"]
    if library.is_dir():
        library.rmdir()
    shutil.copy(demo_library.path, library)
    changed(client, library)
    client.wait(lambda one: one.get("method") == "textDocument/publishDiagnostics" and "MS021" in str(one))
    assert client.leave() == 0


def test_a_library_may_be_replaced_while_it_is_asked_about(start, tmp_path, library, demo_library):
    client, script = start("--stdio"), (tmp_path / "a.ms").as_uri()
    client.initialize(PUSHED)
    client.open(script, "WALK with Upper-Body TALK for 3 sec\n" * 50)
    assert client.diagnostics(script, 1) == []
    place = {"textDocument": {"uri": script}, "position": {"line": 3, "character": 2}}
    for version in range(2, 8):
        methods = ("hover", "completion", "definition", "semanticTokens/full", "documentSymbol")
        numbers = [client.begin(f"textDocument/{method}", place) for method in methods]
        built = Path(shutil.copy(demo_library.path, tmp_path / "built.mlmg"))
        built.replace(library)
        changed(client, library)
        numbers += [client.begin(f"textDocument/{method}", place) for method in methods]
        answers = [client.outcome(number) for number in numbers]
        assert {answer.get("error", {}).get("code") for answer in answers} <= {None, -32801}
        client.edit(script, version, {"text": "WALK for 3 sec\n" * version + "WLAK"})
        client.wait(lambda one, v=version: "MS021" in str(one) and one["params"].get("version") == v)
    assert client.leave() == 0
