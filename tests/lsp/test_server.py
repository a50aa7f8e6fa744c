"""A server is begun, told of texts, asked about them and ended, as editors do it."""

from __future__ import annotations

import subprocess
import sys
from itertools import count

import pytest

URI = "untitled:Untitled-1"
PULLING = {"textDocument": {"diagnostic": {}}, "workspace": {"diagnostics": {"refreshSupport": True}}}
PUSHED = {
    "textDocument": {"publishDiagnostics": {"relatedInformation": True, "tagSupport": {"valueSet": [1]}}},
    "window": {"workDoneProgress": True},
}
OPTIONS = {"tabSize": 4, "insertSpaces": True}
WHOLE = {"start": {"line": 0, "character": 0}, "end": {"line": 99, "character": 0}}


def encoded_length(text: str, encoding: str) -> int:
    return (
        len(text.encode({"utf-8": "utf-8", "utf-16": "utf-16-le", "utf-32": "utf-32-le"}[encoding]))
        // ({"utf-8": 1, "utf-16": 2, "utf-32": 4}[encoding])
    )


@pytest.fixture(scope="module")
def open_anew(start_for_all):
    """Return a function: an encoding and a text -> a client that counts in it, and the text's address.

    Clients are shared by the tests of this module, addresses are not.
    """
    clients, addresses = {}, (f"untitled:Untitled-{number}" for number in count())

    def open_text(encoding, text):
        if encoding not in clients:
            clients[encoding] = start_for_all()
            clients[encoding].initialize({"general": {"positionEncodings": [encoding, "utf-16"]}})
        uri = next(addresses)
        clients[encoding].open(uri, text)
        return clients[encoding], uri

    return open_text


def refusal(client, method: str, params: object) -> int:
    return client.outcome(client.begin(method, params))["error"]["code"]


def test_it_says_who_it_is_and_what_it_does(start_program):
    result = start_program().initialize()
    assert result["serverInfo"]["name"] == "mlmg lsp"
    told = result["capabilities"]
    assert told["positionEncoding"] == "utf-16"
    assert told["textDocumentSync"]["change"] == 2
    assert {"completionProvider", "codeActionProvider", "documentFormattingProvider"} <= set(told)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-32"])
@pytest.mark.parametrize(
    "before", ["", "# 😀 走路\n", "IDLE # 😀 走路\tx\u2028y\x0cz\x85\r\n", "# a\rIDLE\r\n", '("走路😀" or '], ids=repr
)
def test_places_are_counted_as_the_client_counts(open_anew, encoding, before):
    client, uri = open_anew(encoding, f"{before}WLAK\t for 3 sec")
    line = before.replace("\r\n", "\n").replace("\r", "\n").rpartition("\n")[2]
    first = encoded_length(line, encoding)
    found = next(one for one in client.diagnostics(uri) if "WLAK" in one["message"])["range"]
    number = before.replace("\r\n", "\n").replace("\r", "\n").count("\n")
    assert found == {
        "start": {"line": number, "character": first},
        "end": {"line": number, "character": first + 4},
    }
    client.edit(uri, 2, {"range": found, "text": "WALK"})
    assert not any("WLAK" in one["message"] for one in client.diagnostics(uri, 2))


def test_the_first_encoding_of_the_client_that_is_known_is_taken(start):
    told = start().initialize({"general": {"positionEncodings": ["latin-1", "utf-32", "utf-8"]}})
    assert told["capabilities"]["positionEncoding"] == "utf-32"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-32"])
def test_what_a_client_counts_in_that_does_not_say_so_can_be_set(start, encoding):
    client = start("--position-encoding", encoding)
    assert client.initialize()["capabilities"]["positionEncoding"] == encoding
    client.open(URI, '("走路😀" or (')
    (found,) = client.diagnostics(URI)
    assert found["range"]["start"]["character"] == encoded_length('("走路😀" or (', encoding)


def test_what_a_client_says_that_it_counts_in_comes_before_what_is_set(start):
    told = start("--position-encoding", "utf-8").initialize({"general": {"positionEncodings": ["utf-32"]}})
    assert told["capabilities"]["positionEncoding"] == "utf-32"


@pytest.mark.parametrize("text", ["", "IDLE", "\r\n", "# 走"], ids=repr)
def test_a_text_without_a_mistake_is_told_to_have_none(open_anew, text):
    client, uri = open_anew("utf-16", text)
    assert client.diagnostics(uri, 1) == []


def test_diagnostics_come_with_their_version_code_help_and_meaning(start):
    client = start()
    client.initialize(PUSHED)
    client.open(URI, "WLAK for 3 sec\nlet x = WALK\n", version=7)
    unknown = client.diagnostics(URI, 7)[0]
    assert (unknown["code"], unknown["severity"], unknown["source"]) == ("MS021", 1, "mlmg")
    assert "help: " in unknown["message"]
    assert unknown["data"]["rule"].startswith("No graph of the library")
    client.edit(URI, 8, {"text": "let x = WALK\nIDLE\n"})
    (unused,) = client.diagnostics(URI, 8)
    assert unused["tags"] == [1]


def test_what_is_said_of_a_text_is_taken_back_when_it_is_closed(start):
    client = start()
    client.initialize(PUSHED)
    client.open(URI, "WLAK\n")
    assert client.diagnostics(URI)
    client.notify("textDocument/didClose", {"textDocument": {"uri": URI}})
    assert client.diagnostics(URI) == []


def test_a_client_that_asks_for_diagnostics_is_answered_and_not_told(start):
    client = start()
    client.initialize(PULLING)
    client.open(URI, "WLAK\n")
    asked = {"textDocument": {"uri": URI}}
    report = client.ask("textDocument/diagnostic", asked)
    assert report["kind"] == "full"
    assert [one["code"] for one in report["items"]] == ["MS021"]
    again = client.ask("textDocument/diagnostic", asked | {"previousResultId": report["resultId"]})
    assert again["kind"] == "unchanged"
    client.edit(URI, 2, {"text": "WALK\nIDLE\n"})
    assert client.ask("textDocument/diagnostic", asked)["items"][0]["code"] == "MS047"
    client.leave()
    assert not [one for one in client.rest() if one.get("method") == "textDocument/publishDiagnostics"]


def test_the_likeliest_fix_is_offered_and_mends_the_text(start):
    client = start()
    client.initialize(PUSHED)
    client.open(URI, "😀\r\nWalk01 for 3 sec\r\n")
    client.diagnostics(URI)
    place = {"start": {"line": 1, "character": 2}, "end": {"line": 1, "character": 2}}
    asked = {"textDocument": {"uri": URI}, "range": place, "context": {"diagnostics": []}}
    actions = client.ask("textDocument/codeAction", asked)
    fix = next(one for one in actions if one["kind"] == "quickfix")
    assert fix["title"] == "Write `Walk_01`"
    assert fix["isPreferred"]
    (edit,) = fix["edit"]["changes"][URI]
    assert edit["newText"] == "Walk_01"
    assert edit["range"]["start"] == {"line": 1, "character": 0}


def test_all_that_is_sure_is_fixed_at_once_when_that_is_chosen(start):
    client = start()
    resolving = {"resolveSupport": {"properties": ["edit"]}}
    capabilities = {
        "textDocument": {"codeAction": resolving},
        "workspace": {"workspaceEdit": {"documentChanges": True}},
    }
    client.initialize(capabilities)
    client.open(URI, "walk01 for 3 sec\nidle FOR 2 sec\n", version=3)
    client.diagnostics(URI)
    context = {"diagnostics": [], "only": ["source.fixAll"]}
    (action,) = client.ask(
        "textDocument/codeAction", {"textDocument": {"uri": URI}, "range": WHOLE, "context": context}
    )
    assert "edit" not in action
    (change,) = client.ask("codeAction/resolve", action)["edit"]["documentChanges"]
    assert change["textDocument"] == {"uri": URI, "version": 3}
    assert [edit["newText"] for edit in change["edits"]] == ["Walk_01 for 3 sec\n", "IDLE for 2 sec\n"]


# --- it goes on, and it ends ---


def test_it_ends_in_order_when_it_is_told_to(start_program):
    client = start_program()
    client.initialize()
    assert client.leave() == 0


def test_it_ends_when_the_client_has_gone_without_a_word(start_program):
    client = start_program()
    client.initialize()
    client.close()
    assert client.process.wait(30) == 1


def test_it_ends_when_the_process_of_the_client_has_gone(start_program):
    gone = subprocess.Popen([sys.executable, "-c", "pass"])
    gone.wait()
    client = start_program()
    client.initialize(processId=gone.pid)
    assert client.process.wait(30) == 1


@pytest.mark.parametrize(
    "rubbish",
    [
        b"Content-Length: 5\r\n\r\n{]}}}",
        b"rubbish\r\n\r\nContent-Length: no\r\n\r\n",
        b"Content-Length: 2\r\nContent-Type: x\r\n\r\n[]",
        b'Content-Length: 17\r\n\r\n{"jsonrpc":"2.0"}',
        b"Content-Length: 4\r\n\r\n\xff\xfe\xfd\xfc",
    ],
    ids=repr,
)
def test_what_is_no_message_is_passed_over(start, rubbish):
    client = start()
    client.initialize()
    client.send_raw(rubbish)
    client.open(URI, "IDLE")
    assert client.diagnostics(URI) == []


def test_a_request_that_is_not_as_it_should_be_is_refused(start):
    client = start()
    asked = {"textDocument": {"uri": URI}, "options": OPTIONS}
    assert refusal(client, "textDocument/formatting", asked) == -32002
    client.initialize()
    assert refusal(client, "textDocument/formatting", {"no": "text"}) == -32602
    assert refusal(client, "no/suchThing", {}) == -32601
    client.send(id="bare", method="no/suchThing")
    assert client.outcome("bare")["error"]["code"] == -32601
    assert refusal(client, "initialize", {"capabilities": {}, "processId": None}) == -32600
    client.notify("$/setTrace", {"value": "verbose"})
    client.notify("$/whatever", {"value": 1})
    client.edit("untitled:not-open", 2, {"text": "x"})
    client.notify("$/cancelRequest", {"id": 999})
    assert client.leave() == 0


def test_what_is_asked_of_a_text_that_changes_meanwhile_is_refused_as_that(start):
    client = start()
    client.initialize()
    client.open(URI, "WALK for 3 sec\n" * 20_000)
    number = client.begin("textDocument/formatting", {"textDocument": {"uri": URI}, "options": OPTIONS})
    client.edit(URI, 2, {"text": "IDLE"})
    assert client.outcome(number)["error"]["code"] == -32801
    assert client.diagnostics(URI, 2) == []


def test_work_that_is_cancelled_stops(start):
    client = start()
    client.initialize()
    client.open(URI, "WALK   for 3 sec\n" * 50_000)
    number = client.begin("textDocument/formatting", {"textDocument": {"uri": URI}, "options": OPTIONS})
    client.notify("$/cancelRequest", {"id": number})
    assert client.outcome(number)["error"]["code"] == -32800
    client.notify("textDocument/didClose", {"textDocument": {"uri": URI}})
    assert client.diagnostics(URI) == []


# --- files and libraries ---


def test_each_root_has_its_library(start, tmp_path, demo_library):
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
    (tmp_path / "one" / "mlmg.toml").write_text(f'library = "{demo_library.path.as_posix()}"', encoding="utf-8")
    client = start("--stdio")
    folders = [{"uri": (tmp_path / name).as_uri(), "name": name} for name in ("one", "two")]
    client.initialize(PUSHED, workspaceFolders=folders)
    with_library, without = ((tmp_path / name / "a.ms").as_uri() for name in ("one", "two"))
    client.open(with_library, "WLAK")
    assert [one["code"] for one in client.diagnostics(with_library)] == ["MS021"]
    client.open(without, "WLAK")
    assert client.diagnostics(without) == []
    assert "No library is named" in client.wait_for("window/showMessage")["message"]


def test_a_client_that_asks_is_told_to_ask_again_when_it_sets_the_library(start, tmp_path, demo_library):
    client = start("--stdio")
    client.answer_with("workspace/configuration", [{}])
    refreshed = {"diagnostics": {"refreshSupport": True}, "configuration": True}
    client.initialize({"textDocument": {"diagnostic": {}}, "workspace": refreshed}, rootUri=tmp_path.as_uri())
    client.open(URI, "WLAK")
    assert client.ask("textDocument/diagnostic", {"textDocument": {"uri": URI}})["items"] == []
    client.answer_with("workspace/configuration", [{"library": str(demo_library.path)}])
    client.notify("workspace/didChangeConfiguration", {"settings": None})
    client.wait_for("workspace/diagnostic/refresh")
    found = client.ask("textDocument/diagnostic", {"textDocument": {"uri": URI}})["items"]
    assert [one["code"] for one in found] == ["MS021"]


def test_a_client_that_shows_buttons_offers_the_demo_library(start, tmp_path, demo_library, monkeypatch):
    monkeypatch.setenv("MLMG_CACHE", str(demo_library.path.parent))
    client = start("--stdio")
    client.answer_with("window/showMessageRequest", {"title": "Use the demo library"})
    client.initialize(PUSHED | {"experimental": {"offers": True}}, rootUri=tmp_path.as_uri())
    script = (tmp_path / "a.ms").as_uri()
    client.open(script, "WLAK")
    assert "No library is named" in client.wait_for("window/showMessageRequest")["message"]
    while not (found := client.diagnostics(script)):
        pass
    assert found[0]["code"] == "MS021"
    assert (tmp_path / "mlmg.toml").read_text("utf-8") == 'library = "demo"\n'


def test_nothing_is_offered_that_would_write_over_a_file(start, tmp_path):
    (tmp_path / "mlmg.toml").write_text("# mine\n", encoding="utf-8")
    client = start("--stdio")
    client.initialize(PUSHED | {"experimental": {"offers": True}}, rootUri=tmp_path.as_uri())
    client.open((tmp_path / "a.ms").as_uri(), "WLAK")
    assert "No library is named" in client.wait_for("window/showMessage")["message"]
    assert (tmp_path / "mlmg.toml").read_text("utf-8") == "# mine\n"


def test_a_client_sets_the_library_and_may_set_another(start, tmp_path, demo_library):
    client = start("--stdio")
    options = {"library": str(demo_library.path)}
    client.initialize(PUSHED, rootUri=tmp_path.as_uri(), initializationOptions=options)
    client.open(URI, "WLAK")
    assert [one["code"] for one in client.diagnostics(URI)] == ["MS021"]
    client.notify("workspace/didChangeConfiguration", {"settings": {"mlmg": {"library": "none.mlmg"}}})
    said = client.wait_for("window/showMessage")["message"]
    assert "none.mlmg" in said
    assert client.diagnostics(URI) == []


def test_settings_are_asked_for_where_the_client_can_be_asked(start, demo_library):
    client = start("--stdio")
    client.answer_with("workspace/configuration", [{"library": str(demo_library.path)}])
    client.initialize(PUSHED | {"workspace": {"configuration": True}})
    assert client.wait_for("workspace/configuration")["items"] == [{"section": "mlmg"}]
    client.open(URI, "WLAK")
    client.wait(lambda one: one.get("method") == "textDocument/publishDiagnostics" and one["params"]["diagnostics"])


def test_a_library_that_is_broken_and_then_built_is_told_of_once_and_then_used(start, tmp_path, demo_library):
    library, script = tmp_path / "my.mlmg", (tmp_path / "a.ms").as_uri()
    library.write_bytes(b"no library")
    (tmp_path / "mlmg.toml").write_text('library = "my.mlmg"', encoding="utf-8")
    client = start("--stdio")
    client.initialize(PUSHED | {"workspace": {"didChangeWatchedFiles": {"dynamicRegistration": True}}})
    client.open(script, "WLAK (")
    codes = [one["code"] for one in client.diagnostics(script)]
    assert codes
    assert "MS021" not in codes
    assert "my.mlmg" in client.wait_for("window/showMessage")["message"]
    registered = client.wait_for("client/registerCapability")["registrations"]
    assert registered[0]["method"] == "workspace/didChangeWatchedFiles"
    library.write_bytes(demo_library.path.read_bytes())
    client.notify("workspace/didChangeWatchedFiles", {"changes": [{"uri": library.as_uri(), "type": 2}]})
    assert client.wait_for("$/progress")["value"]["kind"] == "begin"
    client.edit(script, 2, {"text": "WLAK"})
    client.wait(lambda one: "MS021" in str(one.get("params")))


def test_a_client_that_asks_for_diagnostics_is_told_to_ask_again(start, tmp_path, demo_library):
    client = start("--stdio")
    client.initialize(PULLING)
    script, settings = (tmp_path / "a.ms").as_uri(), tmp_path / "mlmg.toml"
    client.open(script, "WLAK")
    asked = {"textDocument": {"uri": script}}
    assert client.ask("textDocument/diagnostic", asked)["items"] == []
    settings.write_text(f'library = "{demo_library.path.as_posix()}"', encoding="utf-8")
    client.notify("workspace/didChangeWatchedFiles", {"changes": [{"uri": settings.as_uri(), "type": 1}]})
    client.wait(lambda one: one.get("method") == "workspace/diagnostic/refresh")
    assert [one["code"] for one in client.ask("textDocument/diagnostic", asked)["items"]] == ["MS021"]


def test_a_client_that_asks_but_cannot_be_told_to_ask_again_is_told(start, tmp_path, demo_library):
    client = start("--stdio")
    told = client.initialize({"textDocument": {"diagnostic": {}}})["capabilities"]
    assert "diagnosticProvider" not in told
    assert "diagnosticProvider" in start().initialize(PULLING)["capabilities"]
    script, settings = (tmp_path / "a.ms").as_uri(), tmp_path / "mlmg.toml"
    client.open(script, "WLAK")
    assert client.diagnostics(script) == []
    settings.write_text(f'library = "{demo_library.path.as_posix()}"', encoding="utf-8")
    client.notify("workspace/didChangeWatchedFiles", {"changes": [{"uri": settings.as_uri(), "type": 1}]})
    assert [one["code"] for one in client.diagnostics(script)] == ["MS021"]


def test_used_files_count_as_they_stand_in_the_editor_and_on_disk(start, tmp_path):
    client = start()
    client.initialize(PUSHED)
    used, user = tmp_path / "used.ms", (tmp_path / "user.ms").as_uri()
    client.open(user, 'use "used.ms"\nstroll\n')
    assert "MS058" in [one["code"] for one in client.diagnostics(user)]
    used.write_text("let stroll = WALK for 3 sec\n", encoding="utf-8")
    client.notify("workspace/didChangeWatchedFiles", {"changes": [{"uri": used.as_uri(), "type": 1}]})
    assert client.diagnostics(user) == []
    client.open(used.as_uri(), "let stroll = WLAK for 3 sec\n")
    client.edit(used.as_uri(), 2, {"text": "let stroll = WLAK for 4 sec\n"})
    (wrong,) = client.diagnostics(user)
    assert wrong["range"]["start"] == {"line": 0, "character": 4}
    assert wrong["relatedInformation"][0]["location"]["uri"] == used.as_uri()


def test_a_file_outside_of_the_workspace_is_as_good_as_any(start, tmp_path):
    root, other = tmp_path / "root", tmp_path / "other"
    for folder in (root, other):
        folder.mkdir()
    client = start()
    client.initialize(rootUri=root.as_uri())
    client.open((other / "a.ms").as_uri(), "WLAK")
    assert [one["code"] for one in client.diagnostics((other / "a.ms").as_uri())] == ["MS021"]


def test_progress_is_shown_while_a_library_is_loaded(start):
    client = start()
    client.initialize(PUSHED)
    client.open(URI, "IDLE")
    assert [client.wait_for("$/progress")["value"]["kind"] for _ in range(2)] == ["begin", "end"]


def test_only_this_machine_may_connect(start):
    for address in ("0.0.0.0:4711", "127.0.0.1", "127.0.0.1:99999"):
        assert start("--tcp", address).process.wait(30) == 2


@pytest.mark.parametrize("uri", ["untitled:half-\ud800.ms", "file:///tmp/half-\ud800.ms"])
def test_a_text_is_checked_whose_address_has_half_a_character(start, uri):
    client = start()
    client.initialize()
    client.open(uri, "WLAK\n")
    assert [one["code"] for one in client.diagnostics(uri)] == ["MS021"]


def test_what_is_asked_after_the_end_was_announced_is_refused(start):
    client = start("--stdio")
    client.initialize()
    client.ask("shutdown")
    for method in ("shutdown", "textDocument/hover", "workspace/executeCommand"):
        assert client.outcome(client.begin(method, {}))["error"]["code"] == -32600
    client.notify("exit")
    assert client.process.wait(60) == 0
