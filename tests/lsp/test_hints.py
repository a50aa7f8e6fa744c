"""Small words between those of a script, with what will be played: `textDocument/inlayHint`."""

import pytest

URI = "untitled:Untitled-1"
TEXT = "IDLE for 1 sec\nlet go(who) = who for 2000 ms\ngo(WALK)\nTalk_01 for 1 sec\n"
REFRESHED = {"workspace": {"inlayHint": {"refreshSupport": True}}}
LONG = "WALK for 3 sec\nIDLE for 2000 ms\nWALK with Upper-Body TALK for 3 sec\n" * 400


def hints(client, first: int = 0, last: int = 10) -> list[tuple[int, str]]:
    place = {"start": {"line": first, "character": 0}, "end": {"line": last, "character": 0}}
    found = client.ask("textDocument/inlayHint", {"textDocument": {"uri": URI}, "range": place})
    return [(one["position"]["line"], one["label"]) for one in found]


def opened(start, text: str, capabilities=None, **params):
    client = start()
    client.initialize(capabilities, **params)
    client.open(URI, text)
    client.diagnostics(URI)
    return client


def test_what_is_taken_and_when_it_arrives_is_shown_behind_each_command_of_the_stretch(start):
    client = opened(start, TEXT)
    found = hints(client)
    assert [line for line, _ in found] == [0, 0, 1, 2, 2, 2, 3]
    assert found[:4] == [(0, "Idle_01"), (0, "at 0 sec"), (1, "= 2 sec"), (2, "who =")]
    assert "Walk_0" in found[4][1]
    assert found[5][1].lstrip("~ ").startswith("at ")
    assert hints(client, 3, 4) == found[6:]


def switched(client, kind: str, on: bool) -> None:
    settings = {"mlmg": {"inlayHints": {kind: on}}}
    client.notify("workspace/didChangeConfiguration", {"settings": settings})


@pytest.mark.parametrize(
    ("kind", "gone"), [("motions", "_0"), ("arrivals", "at "), ("units", "="), ("parameters", "who =")]
)
def test_each_kind_can_be_switched_off_and_on_again(start, kind, gone):
    client = opened(start, TEXT, initializationOptions={"inlayHints": {kind: False}})
    without = hints(client)
    switched(client, kind, True)
    found = hints(client)
    left_out = [one for one in found if one not in without]
    assert left_out
    assert all(gone in label for _, label in left_out)
    switched(client, kind, False)
    assert hints(client) == without


def test_where_the_settings_change_the_client_is_told_to_ask_again(start):
    client = opened(start, TEXT, REFRESHED)
    switched(client, "units", True)
    switched(client, "units", False)
    client.wait_for("workspace/inlayHint/refresh")
    assert (1, "= 2 sec") not in hints(client)


def test_settings_of_hints_do_not_have_the_text_analysed_again(start):
    client = opened(start, "WLAK")
    client.notify("workspace/didChangeConfiguration", {"settings": {"mlmg": {"inlayHints": {"units": False}}}})
    client.leave()
    told = [one for one in client.rest() if one.get("method") == "textDocument/publishDiagnostics"]
    assert told == []


def test_what_takes_longer_to_foresee_is_shown_when_it_is_known(start):
    client = opened(start, LONG, REFRESHED)
    first = hints(client)
    if not any("Walk_0" in label for _, label in first):
        client.wait_for("workspace/inlayHint/refresh")
        assert any("Walk_0" in label for _, label in hints(client))
    assert (1, "= 2 sec") in first


def test_while_one_writes_what_was_foreseen_stays_where_its_commands_are(start):
    client = opened(start, LONG, REFRESHED)
    if not any("Walk_0" in label for _, label in hints(client)):
        client.wait_for("workspace/inlayHint/refresh")
    before = hints(client, 4, 7)
    place = {"line": 3, "character": 0}
    client.edit(URI, 2, {"range": {"start": place, "end": place}, "text": "\n"})
    after = hints(client, 5, 8)
    assert [(line - 1, label) for line, label in after] == before


def test_a_client_that_could_not_be_told_later_waits(start):
    assert any("Walk_0" in label for _, label in hints(opened(start, LONG)))


def test_as_long_as_there_are_mistakes_commands_that_are_left_alone_are_told_of_as_before(start):
    client = opened(start, TEXT)
    before = hints(client)
    place = {"line": 3, "character": 0}
    client.edit(URI, 2, {"range": {"start": place, "end": place}, "text": "WLAK\n"})
    assert hints(client) == [(line + (line > 2), label) for line, label in before]
    end = {"line": 4, "character": 0}
    client.edit(URI, 3, {"range": {"start": place, "end": end}, "text": ""})
    assert hints(client) == before


@pytest.mark.parametrize("kind", ["motions", "units"])
def test_after_edits_and_with_other_settings_they_are_those_of_a_script_opened_anew(start, kind):
    client = opened(start, TEXT)
    hints(client)
    switched(client, kind, False)
    text = TEXT.replace("go(who) = who", "go(whom, t = 1 sec) = whom")
    client.edit(URI, 2, {"text": text})
    afresh = opened(start, text, initializationOptions={"inlayHints": {kind: False}})
    assert hints(client) == hints(afresh) != []
    assert hints(client, 2, 3) == hints(afresh, 2, 3)


def test_without_a_library_or_with_mistakes_only_what_is_written_is_spelled_out(start):
    client = start("--stdio")
    client.initialize()
    client.open(URI, TEXT)
    assert hints(client) == [(1, "= 2 sec"), (2, "who =")]
    assert hints(opened(start, TEXT + "WLAK\n")) == [(1, "= 2 sec"), (2, "who =")]
