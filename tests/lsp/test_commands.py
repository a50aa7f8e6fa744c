"""Lenses above commands, and what they do: `workspace/executeCommand`."""

from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from mlmg_lang import compile, play
from mlmg_lang.explaining.explain import explanation_from_analysis
from mlmg_lang.explaining.text import render_text
from mlmg_lang.front_end import analyse
from mlmg_lang.source import Source
from mlmg_runtime import bvh

SHOWING = {"window": {"showDocument": {"support": True}, "workDoneProgress": True}}
TEXT = "IDLE for 1 sec\nrepeat 2 {\n    WALK for 1 sec\n}\n"


@pytest.fixture
def script(tmp_path):
    return tmp_path / "stroll 走.ms"


@pytest.fixture
def client(start, script):
    client = start()
    client.initialize(SHOWING)
    client.answer_with("window/showDocument", {"success": True})
    client.open(script.as_uri(), TEXT)
    client.diagnostics(script.as_uri())
    return client


def command(name: str, **about: object) -> dict[str, object]:
    return {"command": f"mlmg.{name}", "arguments": [about]}


def refused(client, asked) -> dict[str, object]:
    return client.outcome(client.begin("workspace/executeCommand", asked))["error"]


def path_of(uri: str) -> Path:
    return Path(unquote(urlsplit(uri).path))


def lenses(client, uri: str) -> list[tuple[int, str, str]]:
    found = client.ask("textDocument/codeLens", {"textDocument": {"uri": uri}})
    return [(one["range"]["start"]["line"], one["command"]["title"], one["command"]["command"]) for one in found]


def test_a_script_can_be_played_and_explained_and_each_command_asked_for_its_candidates(client, script):
    assert lenses(client, script.as_uri()) == [
        (0, "play to BVH", "mlmg.play"),
        (0, "explain", "mlmg.explain"),
        (0, "4 candidates on Full-Body", "mlmg.candidates"),
        (2, "3 candidates on Full-Body", "mlmg.candidates"),
    ]
    client.edit(script.as_uri(), 2, {"text": "WLAK\n"})
    assert lenses(client, script.as_uri()) == []


def test_the_motion_is_written_beside_the_script_and_it_is_said_where(client, script, demo_library, tmp_path):
    done = client.ask("workspace/executeCommand", command("play", uri=script.as_uri()))
    written = tmp_path / "stroll 走.bvh"
    plan, _ = compile(TEXT, demo_library)
    bvh.write(play(plan, demo_library).bvh, tmp_path / "expected.bvh")
    assert written.read_bytes() == (tmp_path / "expected.bvh").read_bytes()
    assert path_of(done["uri"]) == written
    message = client.wait(lambda one: str(written) in str(one.get("params")))
    assert message["method"] == "window/showMessage"
    assert f"{done['n_frames']} frames" in message["params"]["message"]
    client.leave()
    assert "window/showDocument" not in [one.get("method") for one in client.rest()]


def test_it_is_shown_how_far_the_playing_is(client, script):
    client.edit(script.as_uri(), 2, {"text": TEXT * 80})
    client.begin("workspace/executeCommand", command("play", uri=script.as_uri()))
    wanted = client.wait(lambda one: "Playing" in str(one.get("params")))["params"]
    assert wanted["value"] == {"kind": "begin", "title": "Playing", "cancellable": True}
    told = []
    while not told or told[-1]["kind"] != "end":
        own = client.wait_for("$/progress")
        told += [own["value"]] if own["token"] == wanted["token"] else []
    percentages = [one["percentage"] for one in told if one["kind"] == "report"]
    assert percentages
    assert percentages == sorted(percentages)


def test_a_client_that_shows_no_progress_of_ours_can_ask_for_it_by_a_token(start, script):
    client = start()
    client.initialize()
    client.open(script.as_uri(), TEXT)
    client.ask("workspace/executeCommand", command("play", uri=script.as_uri()) | {"workDoneToken": 17})
    told = client.wait_for("$/progress")
    assert (told["token"], told["value"]["kind"]) == (17, "begin")
    client.open(script.as_uri(), TEXT)
    client.ask("workspace/executeCommand", command("play", uri=script.as_uri()))
    client.leave()
    rest = client.rest()
    assert {one["params"]["token"] for one in rest if one.get("method") == "$/progress"} == {17}
    assert "window/workDoneProgress/create" not in [one.get("method") for one in rest]


@pytest.mark.parametrize("way", ["progress", "request"])
def test_playing_that_is_given_up_stops_and_leaves_nothing_behind(client, script, tmp_path, way):
    client.edit(script.as_uri(), 2, {"text": "WALK for 20 sec\nIDLE for 20 sec\n" * 500})
    number = client.begin("workspace/executeCommand", command("play", uri=script.as_uri()))
    token = client.wait(lambda one: "'report'" in str(one.get("params")) and "statements" in str(one))["params"][
        "token"
    ]
    if way == "progress":
        client.notify("window/workDoneProgress/cancel", {"token": token})
    else:
        client.notify("$/cancelRequest", {"id": number})
    assert client.outcome(number)["error"]["code"] == -32800
    client.wait(lambda one: "'end'" in str(one.get("params")) and token in str(one["params"]))
    assert list(tmp_path.glob("*.bvh")) == []
    assert list(tmp_path.glob(".*.tmp")) == []
    client.edit(script.as_uri(), 3, {"text": TEXT})
    assert client.ask("workspace/executeCommand", command("play", uri=script.as_uri()))["n_frames"] > 0


@pytest.mark.parametrize(("chosen", "is_replaced"), [("Replace it", True), ("Leave it", False), (None, False)])
def test_a_file_that_was_there_before_is_replaced_only_if_that_is_wanted(client, script, tmp_path, chosen, is_replaced):
    there = tmp_path / "stroll 走.bvh"
    there.write_text("a clip", encoding="utf-8")
    client.answer_with("window/showMessageRequest", chosen and {"title": chosen})
    client.ask("workspace/executeCommand", command("play", uri=script.as_uri()))
    assert str(there) in client.wait_for("window/showMessageRequest")["message"]
    assert (there.read_text(encoding="utf-8") != "a clip") == is_replaced
    if is_replaced:
        client.ask("workspace/executeCommand", command("play", uri=script.as_uri()))
        client.leave()
        assert "window/showMessageRequest" not in [one.get("method") for one in client.rest()]


def test_where_a_motion_is_written_and_whether_there_is_a_report_can_be_said(client, script, tmp_path):
    to, report = tmp_path / "a.bvh", tmp_path / "a.json"
    to.touch()
    asked = {"uri": script.as_uri(), "to": to.as_uri(), "report": report.as_uri(), "shown": False}
    done = client.ask("workspace/executeCommand", command("play", **asked))
    assert path_of(done["uri"]) == to
    assert to.stat().st_size
    assert '"commands"' in report.read_text(encoding="utf-8")
    for wrong in ((tmp_path / "a.fbx").as_uri(), "untitled:a.bvh"):
        assert refused(client, command("play", uri=script.as_uri(), to=wrong))["code"] in (-32803, -32602)
    client.leave()
    said = [one for one in client.rest() if one.get("method") == "window/showMessage"]
    assert not [one for one in said if "a.bvh" in one["params"]["message"]]


@pytest.mark.parametrize("name", ["play", "explain"])
@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("IDLE\nWLAK\n)\n", "the script has 2 mistakes; line 2: no tag or motion `WLAK`"),
        ("# nothing\n", "there is nothing to play"),
    ],
)
def test_what_cannot_be_played_is_refused_in_words(client, script, tmp_path, name, text, why):
    client.edit(script.as_uri(), 2, {"text": text})
    error = refused(client, command(name, uri=script.as_uri()))
    assert error["code"] == -32803
    assert why in error["message"]
    assert list(tmp_path.glob("*.bvh")) == []


def test_without_a_library_or_a_file_nothing_is_played(start, client, script):
    client.open("untitled:Untitled-1", TEXT)
    assert "save it first" in refused(client, command("play", uri="untitled:Untitled-1"))["message"]
    assert "not open" in refused(client, command("play", uri="file:///elsewhere.ms"))["message"]
    alone = start("--stdio")
    alone.initialize()
    alone.open(script.as_uri(), TEXT)
    assert lenses(alone, script.as_uri()) == []
    assert "no library is known" in refused(alone, command("explain", uri=script.as_uri()))["message"]


def test_where_a_motion_cannot_be_written_it_is_said_before_it_is_played(client, script, tmp_path):
    (tmp_path / "folder.bvh").mkdir()
    error = refused(client, command("play", uri=script.as_uri(), to=(tmp_path / "folder.bvh").as_uri()))
    assert "folder.bvh" in error["message"]


def test_what_will_be_played_is_explained_in_a_document_of_the_editor(client, script, demo_library):
    done = client.ask("workspace/executeCommand", command("explain", uri=script.as_uri()))
    shown = client.wait_for("window/showDocument")
    page = path_of(shown["uri"])
    analysis = analyse(Source(TEXT, str(script)), demo_library)
    assert done["text"] == render_text(explanation_from_analysis(analysis, demo_library))
    assert page.read_text(encoding="utf-8") == done["text"]
    assert not shown["external"]
    client.leave()
    assert not page.exists()


@pytest.mark.parametrize("shows", [False, True])
def test_where_the_editor_shows_no_documents_it_is_told_where_the_text_is(start, script, shows):
    client = start()
    client.initialize(SHOWING if shows else {})
    client.open(script.as_uri(), TEXT)
    answers = ({"success": False}, None, "yes", {})
    failures = ({"error": {"code": -32603, "message": "no"}}, {"error": None})
    for answer in (*({"result": one} for one in answers), *failures) if shows else (None,):
        client.answer_by("window/showDocument", answer)
        client.ask("workspace/executeCommand", command("explain", uri=script.as_uri()))
        message = client.wait_for("window/showMessage")["message"]
        assert Path(message.removeprefix("written to ")).read_text(encoding="utf-8").startswith(str(script))
    client.leave()
    assert ("window/showDocument" in [one.get("method") for one in client.rest()]) == shows


def test_an_answer_may_say_that_it_is_no_error(client, script):
    client.answer_by("window/showDocument", {"result": {"success": True}, "error": None})
    client.ask("workspace/executeCommand", command("explain", uri=script.as_uri()))
    client.leave()
    assert "window/showMessage" not in [one.get("method") for one in client.rest()]


def test_a_command_is_done_though_the_editor_does_not_say_whether_it_has_shown_what_came_of_it(client, script):
    client.answer_by("window/showDocument", None)
    for _ in range(2):
        assert client.ask("workspace/executeCommand", command("explain", uri=script.as_uri()))["text"]
        assert path_of(client.wait_for("window/showDocument")["uri"]).exists()


def test_a_command_is_asked_for_its_candidates_where_it_stands(client, script):
    place = {"line": 2, "character": 6}
    text = client.ask("workspace/executeCommand", command("candidates", uri=script.as_uri(), position=place))["text"]
    assert text.startswith("line 3  WALK for 1 sec")
    assert {"Walk_01", "Walk_02", "Walk_03"} <= set(text.replace(",", " ").split())
    assert "line 1" not in text
    gone = {"line": 3, "character": 0}
    assert "no command" in refused(client, command("candidates", uri=script.as_uri(), position=gone))["message"]


def test_a_sound_command_is_asked_for_its_candidates_though_another_line_has_a_mistake(client, script):
    client.edit(script.as_uri(), 2, {"text": "IDLE for 1 sec\nWLAK\nWALK for 1 sec"})
    assert lenses(client, script.as_uri())[-1] == (2, "3 candidates on Full-Body", "mlmg.candidates")
    at = [command("candidates", uri=script.as_uri(), position={"line": line, "character": 0}) for line in range(3)]
    text = client.ask("workspace/executeCommand", at[2])["text"]
    first, _, _, told = text.split("\n", 3)
    wrong = "the script has 1 mistake; line 2: no tag or motion `WLAK` in this library"
    assert first == wrong
    assert told.startswith("line 3  WALK for 1 sec")
    assert {"Walk_01", "Walk_02", "Walk_03"} <= set(told.replace(",", " ").split())
    assert "IDLE for 1 sec" in client.ask("workspace/executeCommand", at[0])["text"]
    assert refused(client, at[1])["message"] == wrong


def test_a_script_without_a_command_has_no_candidates(client, script):
    client.edit(script.as_uri(), 2, {"text": "# nothing\n"})
    assert "no command" in refused(client, command("candidates", uri=script.as_uri()))["message"]


def test_what_a_diagnostic_means_can_be_read(client):
    done = client.ask("workspace/executeCommand", command("rule", code="MS021"))
    assert "WLAK for 10 sec" in done["text"]
    assert path_of(client.wait_for("window/showDocument")["uri"]).name == "MS021.md"
    assert "MS999" in refused(client, command("rule", code="MS999"))["message"]


def test_a_command_that_is_not_as_it_should_be_is_refused(client):
    for asked in ({"command": "mlmg.dance", "arguments": []}, {"command": "mlmg.play"}, command("play", uri=3)):
        assert refused(client, asked)["code"] == -32602


def test_commands_are_told_of_at_the_beginning(start):
    told = start().initialize()["capabilities"]["executeCommandProvider"]["commands"]
    assert told == ["mlmg.play", "mlmg.explain", "mlmg.candidates", "mlmg.rule"]


def test_a_client_that_says_nothing_of_itself_is_asked_for_nothing_and_answered_all_the_same(start, script):
    client = start()
    client.initialize({})
    uri, whole = script.as_uri(), {"start": {"line": 0, "character": 0}, "end": {"line": 9, "character": 0}}
    client.open(uri, TEXT)
    client.notify("workspace/didChangeConfiguration", {"settings": {"mlmg": {"inlayHints": {"units": False}}}})
    assert client.ask("textDocument/inlayHint", {"textDocument": {"uri": uri}, "range": whole})
    assert len(lenses(client, uri)) == 4
    assert client.ask("workspace/executeCommand", command("play", uri=uri))["n_frames"]
    assert client.ask("workspace/executeCommand", command("explain", uri=uri))["text"]
    client.leave()
    assert [one for one in client.rest() if "id" in one and "method" in one] == []
