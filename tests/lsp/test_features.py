"""What is answered about a text, in what an editor shows."""

from __future__ import annotations

import random
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from mlmg_lang.front_end import analyse
from mlmg_lang.source import Source
from mlmg_runtime import bvh
from mlmg_runtime.demo.clips import demo_clips

URI = "untitled:Untitled-1"
OPTIONS = {"tabSize": 4, "insertSpaces": True}
SNIPPETS = {"textDocument": {"completion": {"completionItem": {"snippetSupport": True}}}}
ENCODINGS = ("utf-16", "utf-8", "utf-32")
DEFINED = "# 😀\r\nlet greet(who, t = 2 sec) = who with Upper-Body WAVE for t\r\ngreet(WALK)\r\ngreet(IDLE, 3 sec)"


@pytest.fixture(scope="module")
def editor(start_for_all):
    client = start_for_all()
    client.initialize(SNIPPETS)
    return client


@pytest.fixture
def client(editor):
    yield editor
    editor.close_text(URI)


def opened(client, text: str) -> None:
    client.open(URI, text)
    client.diagnostics(URI, 1)


def applied(text: str, edits) -> str:
    """Return a text of plain characters and LF with edits in it."""
    lines = text.split("\n")
    starts = [sum(len(line) + 1 for line in lines[:at]) for at in range(len(lines) + 1)]
    for edit in sorted(edits, key=lambda one: -starts[one["range"]["start"]["line"]]):
        begin, end = (
            starts[edit["range"][side]["line"]] + edit["range"][side]["character"] for side in ("start", "end")
        )
        text = text[:begin] + edit["newText"] + text[end:]
    return text


# --- completion ---


def labels(client, line: int, character: int) -> list[str]:
    found = client.ask_at("completion", URI, line, character)
    assert [one["sortText"] for one in found["items"]] == sorted(one["sortText"] for one in found["items"])
    return [one["label"] for one in found["items"]]


def test_what_fits_what_is_playing_comes_first(client):
    opened(client, "WALK for 3 sec\n\nIDLE for 3 sec\n\n")
    assert labels(client, 1, 0)[0] == "WALK"
    assert labels(client, 3, 0)[0] == "IDLE"


def test_only_what_is_valid_is_offered_and_what_has_been_written_is_taken_the_place_of(client):
    opened(client, "😀\nWALK with Upper-Body tal for 3 sec")
    found = client.ask_at("completion", URI, 1, 24)["items"]
    assert found[0]["label"] == "TALK"
    assert found[0]["textEdit"]["range"]["start"] == {"line": 1, "character": 21}
    assert found[0]["textEdit"]["range"]["end"] == {"line": 1, "character": 24}
    assert "WALK" not in [one["label"] for one in found]


def test_in_a_block_what_is_playing_there_counts(client):
    opened(client, "IDLE for 1 sec\nrepeat 2 {\nWALK for 2 sec\n\n}\n")
    assert labels(client, 3, 0)[0] == "WALK"


def test_words_of_the_language_are_snippets_where_the_client_fills_them_in(client):
    opened(client, "rep\n")
    (repeat,) = (one for one in client.ask_at("completion", URI, 0, 3)["items"] if one["label"] == "repeat")
    assert repeat["insertTextFormat"] == 2
    assert repeat["textEdit"]["newText"].startswith("repeat ${1:2} {")


def test_a_definition_has_places_for_what_has_to_be_given_to_it(client):
    opened(
        client, 'let two(x, t, y = WALK) = x or y for t\nlet "a $}"(x) = x\nlet none(t = 2 sec) = WALK for t\n\ntwo('
    )
    found = {one["label"]: one for one in client.ask_at("completion", URI, 3, 0)["items"]}
    texts = {name: found[name]["textEdit"]["newText"] for name in ("two", "a $}", "none")}
    assert texts == {"two": "two(${1:x}, ${2:t})$0", "a $}": '"a \\$\\}"(${1:x})$0', "none": "none"}
    assert [found[name].get("insertTextFormat") for name in ("two", "none")] == [2, None]
    (called,) = (one for one in client.ask_at("completion", URI, 4, 2)["items"] if one["label"] == "two")
    assert called["textEdit"]["newText"] == "two"


def test_the_name_of_an_argument_is_offered_with_its_sign(client):
    opened(client, "let two(x, t) = x for t\ntwo(")
    found = {one["label"]: one for one in client.ask_at("completion", URI, 1, 4)["items"]}
    assert found["t = "]["textEdit"]["newText"] == "t = "


def test_a_name_that_lacks_what_joins_it_takes_the_place_of_its_words_which_it_is_compared_with(client):
    opened(client, "WALK with Upper Bo for 2 sec")
    found = client.ask_at("completion", URI, 0, 18)
    (item,) = found["items"]
    assert (item["label"], item["filterText"], item["textEdit"]["newText"]) == (
        "Upper-Body",
        "Upper Body",
        "Upper-Body",
    )
    assert item["textEdit"]["range"]["start"]["character"] == 10
    assert item["textEdit"]["range"]["end"]["character"] == 18
    assert found["isIncomplete"]


def test_scripts_beside_are_offered_to_be_used(client, tmp_path):
    for name in ("gest.ms", "more.ms", "main.ms", "clip.bvh"):
        (tmp_path / name).write_text("", encoding="utf-8")
    uri = (tmp_path / "main.ms").as_uri()
    both = ['"gest.ms"', '"more.ms"']
    for text, offered in (('use "', both), ('use "ge"', both[:1]), ("use ", both)):
        client.open(uri, text)
        client.diagnostics(uri, 1)
        items = client.ask_at("completion", uri, 0, min(len(text), 7))["items"]
        assert [one["textEdit"]["newText"] for one in items] == offered
        client.close_text(uri)


def test_one_motion_is_one_motion(client):
    opened(client, "")
    details = [one["detail"] for one in client.ask_at("completion", URI, 0, 0)["items"]]
    assert any(detail.endswith(", 1 motion") for detail in details)
    assert not any("1 motions" in detail for detail in details)


def test_a_client_that_indents_is_told_to_leave_the_line_of_a_name_as_it_is(start, client):
    item = {"snippetSupport": True, "insertTextModeSupport": {"valueSet": [1, 2]}}
    indenting = start()
    indenting.initialize({"textDocument": {"completion": {"completionItem": item}}})
    for one, modes in ((indenting, (1, 2)), (client, (None, None))):
        opened(one, "re")
        assert [found.get("insertTextMode") for found in offered(one, "IDLE", "repeat")] == list(modes)


def offered(client, *names: str):
    found = {one["label"]: one for one in client.ask_at("completion", URI, 0, 0)["items"]}
    return [found[name] for name in names]


def test_there_is_more_to_read_of_what_is_chosen(client):
    opened(client, "")
    found = {one["label"]: one for one in client.ask_at("completion", URI, 0, 0)["items"]}
    assert "Walk_01, " in client.ask("completionItem/resolve", found["WALK"])["documentation"]
    assert "frames" in client.ask("completionItem/resolve", found["Walk_01"])["documentation"]
    assert "joints: " in client.ask("completionItem/resolve", found["Upper-Body"])["documentation"]


def resolved(client, line: int, character: int) -> dict[str, str]:
    """Return what there is to read of all that is offered at a place, by label."""
    items = client.ask_at("completion", URI, line, character)["items"]
    return {one["label"]: client.ask("completionItem/resolve", one).get("documentation", "") for one in items}


def test_of_a_definition_and_what_it_takes_there_is_to_read_what_hovering_says(client):
    defined = "let stroll = WALK or IDLE\nlet lazy = stroll and WALK\nlet two(x, t = 2 sec) = x or WALK for t\n"
    opened(client, f"{defined}\ntwo(\nlet three(x) = x or WALK")
    said = resolved(client, 3, 0)
    for line, name in enumerate(("stroll", "lazy", "two")):
        hovered, _, _ = client.ask_at("hover", URI, line, 5)["contents"]["value"].partition("\n\nwarning: ")
        assert said[name] == f"{hovered}\n\ndefined in line {line + 1}"
        assert f"let {name}" in said[name]
    assert "on Full-Body: Walk_01" in said["lazy"].replace("`", "")
    arguments = resolved(client, 4, 4)
    assert "without it, `2 sec`" in arguments["t = "]
    assert "defined in line 3" in arguments["t = "]
    assert "parameter `x` of `three`" in resolved(client, 5, 15)["x"]


def test_of_words_and_units_there_is_to_read_what_they_say(client):
    opened(client, "WALK \nWALK for 2 ")
    assert resolved(client, 0, 5)["once"] == "`once`: once, from its beginning to its end"
    assert resolved(client, 1, 11)["cycles"].startswith("`cycles`: passes of the topmost motion")


def test_it_is_said_in_which_file_a_definition_stands(client, tmp_path):
    (tmp_path / "gest.ms").write_text("\nlet stroll = WALK\n", encoding="utf-8")
    uri = (tmp_path / "main.ms").as_uri()
    client.open(uri, 'use "gest.ms"\n\n')
    client.diagnostics(uri, 1)
    found = {one["label"]: one for one in client.ask_at("completion", uri, 1, 0)["items"]}
    assert client.ask("completionItem/resolve", found["stroll"])["documentation"].endswith("line 2 of `gest.ms`")
    client.close_text(uri)


def test_behind_a_quote_labels_have_quotes_too_for_what_is_written_is_compared_with_them(client):
    opened(client, '"wal for 2 sec')
    first = client.ask_at("completion", URI, 0, 4)["items"][0]
    assert (first["label"], first["textEdit"]["newText"]) == ('"WALK"', '"WALK"')
    assert first["textEdit"]["range"]["end"]["character"] == 4


def test_without_a_library_words_and_own_definitions_are_offered(start):
    client = start("--stdio")
    client.initialize()
    opened(client, "let stroll = WALK\n\n")
    assert {"stroll", "repeat", "wait"} <= set(labels(client, 1, 0))
    cases = (
        ("stroll ", ["with", "for", "once", "and", "or"]),
        ("FOO w", ["with"]),
        ("FOO with ", ["stroll", "Sub", "not"]),
        ("FOO with Arm TALK with ", ["stroll", "Sub", "not"]),
    )
    for version, (written, offered) in enumerate(cases, 2):
        client.edit(URI, version, {"text": f"let stroll = WALK\n{written}"})
        assert labels(client, 1, len(written)) == offered


def test_in_an_empty_text_there_is_nothing_to_tell_and_nothing_to_do(client):
    opened(client, "")
    nowhere = {"start": {"line": 0, "character": 0}, "end": {"line": 0, "character": 0}}
    asked = {"textDocument": {"uri": URI}}
    assert client.ask_at("hover", URI, 0, 0) is None
    assert client.ask("textDocument/codeAction", asked | {"range": nowhere, "context": {"diagnostics": []}}) == []
    assert client.ask("textDocument/formatting", asked | {"options": OPTIONS}) == []
    refused = client.outcome(
        client.begin("textDocument/rename", asked | {"position": nowhere["start"], "newName": "x"})
    )
    assert "error" in refused


# --- formatting ---


UGLY = "WALK   for 3 sec\nIDLE for  2 sec\n\n\n\n#x\nrepeat 2 {\nIDLE for 1 sec\n}\n"


def test_a_text_is_brought_into_canonical_form_line_by_line(client):
    opened(client, UGLY)
    edits = client.ask("textDocument/formatting", {"textDocument": {"uri": URI}, "options": OPTIONS})
    formatted = applied(UGLY, edits)
    assert formatted == "WALK for 3 sec\nIDLE for 2 sec\n\n#x\nrepeat 2 {\n    IDLE for 1 sec\n}\n"
    assert len(edits) > 2


def test_of_a_selection_only_its_lines_are_formatted(client):
    opened(client, UGLY)
    place = {"start": {"line": 1, "character": 0}, "end": {"line": 2, "character": 0}}
    asked = {"textDocument": {"uri": URI}, "range": place, "options": OPTIONS}
    edits = client.ask("textDocument/rangeFormatting", asked)
    assert applied(UGLY, edits) == UGLY.replace("for  2", "for 2")


def test_a_line_is_formatted_when_it_is_finished(client):
    opened(client, UGLY)
    edits = client.ask_at("onTypeFormatting", URI, 1, 0, ch="\n", options=OPTIONS)
    assert applied(UGLY, edits) == UGLY.replace("WALK   for", "WALK for")


def test_line_ends_stay_what_they_are(client):
    opened(client, "WALK for 3 sec\r\nIDLE  for 2 sec\r\n")
    (edit,) = client.ask("textDocument/formatting", {"textDocument": {"uri": URI}, "options": OPTIONS})
    assert edit["newText"] == "IDLE for 2 sec\r\n"
    assert edit["range"]["start"]["line"] == 1


# --- names ---


def test_a_name_is_told_of_with_what_the_library_knows(client):
    opened(client, DEFINED)
    hover = client.ask_at("hover", URI, 3, 7)
    assert "IDLE" in hover["contents"]["value"]
    assert hover["range"] == {"start": {"line": 3, "character": 6}, "end": {"line": 3, "character": 10}}
    assert client.ask_at("hover", URI, 0, 0) is None


def test_a_name_leads_to_its_definition_and_to_where_it_is_used(client):
    opened(client, DEFINED)
    (place,) = client.ask_at("definition", URI, 2, 1)
    assert (place["uri"], place["range"]["start"]) == (URI, {"line": 1, "character": 4})
    used = client.ask_at("references", URI, 2, 1, context={"includeDeclaration": False})
    assert [one["range"]["start"]["line"] for one in used] == [2, 3]
    assert [one["kind"] for one in client.ask_at("documentHighlight", URI, 2, 1)] == [3, 2, 2]


def test_a_tag_leads_to_the_lines_of_the_configuration_that_give_it(start, tmp_path, demo_library):
    library, configuration = tmp_path / "my.mlmg", tmp_path / "my.toml"
    library.write_bytes(demo_library.path.read_bytes())
    configuration.write_text('# 😀\n[tags.Full-Body]\nWalk_01 = ["WALK"]\n', encoding="utf-8")
    client = start("--library", str(library))
    client.initialize()
    opened(client, "WALK\n")
    (place,) = client.ask_at("definition", URI, 0, 1)
    assert (place["uri"], place["range"]["start"]["line"]) == (configuration.as_uri(), 2)


def test_a_tag_and_a_motion_lead_to_the_files_that_the_library_was_built_from(start, tmp_path):
    library, configuration = tmp_path / "built" / "library.mlmg", tmp_path / "library.toml"
    library.parent.mkdir()
    (library.parent / "library.toml").write_text('[tags.Full-Body]\nWalk_01 = ["WALK"]\n', encoding="utf-8")
    clips = demo_clips()
    for name in ("Idle_01", "Walk_01"):
        bvh.write(clips[name], tmp_path / f"{name}.bvh")
    tags = '[tags.Full-Body]\nIdle_01 = ["IDLE"]\nWalk_01 = ["WALK"]\n'
    configuration.write_text(f'[library]\nclips = ["*.bvh"]\n[[graph]]\nname = "Full-Body"\n{tags}', encoding="utf-8")
    program = [sys.executable, "-m", "mlmg_lang.commands.mlmg", "build", "library.toml", "-o", str(library)]
    subprocess.run(program, cwd=tmp_path, check=True, capture_output=True)
    client = start("--library", str(library))
    client.initialize()
    opened(client, "WALK\nWalk_01\n")
    (place,) = client.ask_at("definition", URI, 0, 1)
    assert (place["uri"], place["range"]["start"]["line"]) == (configuration.as_uri(), 6)
    (place,) = client.ask_at("definition", URI, 1, 1)
    assert place["uri"] == (tmp_path / "Walk_01.bvh").as_uri()


def test_a_definition_is_renamed_wherever_it_is_used_and_a_motion_is_not(client):
    opened(client, DEFINED)
    assert client.ask_at("prepareRename", URI, 2, 1)["placeholder"] == "greet"
    edits = client.ask_at("rename", URI, 2, 1, newName="hello")["changes"][URI]
    assert [(one["range"]["start"]["line"], one["newText"]) for one in edits] == [(n, "hello") for n in (1, 2, 3)]
    place = {"textDocument": {"uri": URI}, "position": {"line": 2, "character": 7}}
    refused = client.outcome(client.begin("textDocument/rename", place | {"newName": "x"}))
    assert "`WALK` is a tag of the library" in refused["error"]["message"]
    unasked = client.outcome(client.begin("textDocument/prepareRename", place))
    assert [one["error"]["code"] for one in (refused, unasked)] == [-32803, -32803]


def test_names_are_renamed_in_the_files_that_a_script_uses_too(start, tmp_path):
    client = start()
    client.initialize({"workspace": {"workspaceEdit": {"documentChanges": True}}})
    used, user = tmp_path / "used 😀.ms", (tmp_path / "user.ms").as_uri()
    used.write_text("# 走\nlet stroll = WALK for 3 sec\n", encoding="utf-8")
    client.open(user, 'use "used 😀.ms"\nstroll\n', version=5)
    assert client.diagnostics(user) == []
    (link,) = client.ask("textDocument/documentLink", {"textDocument": {"uri": user}})
    assert link["target"] == used.as_uri()
    changes = client.ask_at("rename", user, 1, 2, newName="amble")["documentChanges"]
    assert {one["textDocument"]["uri"]: one["textDocument"]["version"] for one in changes} == {
        user: 5,
        used.as_uri(): None,
    }
    assert {one["edits"][0]["range"]["start"]["line"] for one in changes} == {1}


def test_what_a_definition_takes_is_shown_while_it_is_used(client):
    opened(client, DEFINED)
    shown = client.ask_at("signatureHelp", URI, 3, 12)
    assert shown["signatures"][0]["label"] == "greet(who, t = 2 sec)"
    assert shown["activeParameter"] == shown["signatures"][0]["activeParameter"] == 1


@pytest.mark.parametrize(("unmarked", "active"), [(True, None), (False, 2)])
def test_that_nothing_is_left_to_be_given_is_told_as_the_client_can_take_it(start, unmarked, active):
    client = start()
    support = {"signatureInformation": {"noActiveParameterSupport": unmarked}}
    client.initialize({"textDocument": {"signatureHelp": support}})
    opened(client, "let greet(who, t = 2 sec) = who for t\ngreet(IDLE, 3 sec, \n")
    shown = client.ask_at("signatureHelp", URI, 1, 19)
    assert (shown["activeParameter"], shown["signatures"][0]["activeParameter"]) == (active, active)


def test_what_a_text_consists_of_is_told(client):
    opened(client, DEFINED + "\r\nrepeat 2 {\r\nIDLE for 1\r\n}\r\n")
    asked = {"textDocument": {"uri": URI}}
    outline = client.ask("textDocument/documentSymbol", asked)
    assert outline[0]["name"].startswith("greet")
    (fold,) = client.ask("textDocument/foldingRange", asked)
    assert (fold["startLine"], fold["endLine"]) == (4, 6)
    (ranges,) = client.ask("textDocument/selectionRange", asked | {"positions": [{"line": 2, "character": 7}]})
    assert ranges["range"] == {"start": {"line": 2, "character": 6}, "end": {"line": 2, "character": 10}}
    place = {"start": {"line": 2, "character": 0}, "end": {"line": 3, "character": 0}}
    assert [one["label"] for one in client.ask("textDocument/inlayHint", asked | {"range": place})] == ["who ="]


@pytest.mark.parametrize(("lines", "last"), [(True, 1), (False, 2)])
def test_what_closes_a_block_stays_where_the_editor_folds_whole_lines(start, lines, last):
    client = start()
    client.initialize({"textDocument": {"foldingRange": {"lineFoldingOnly": lines}}})
    opened(client, "repeat 2 {\n  IDLE for 1 sec\n}\n")
    (fold,) = client.ask("textDocument/foldingRange", {"textDocument": {"uri": URI}})
    assert (fold["startLine"], fold["endLine"]) == (0, last)


def test_each_word_is_coloured_by_what_it_is(client):
    opened(client, "# 😀\nlet x = WALK\nx for 3 sec\n")
    data = client.ask("textDocument/semanticTokens/full", {"textDocument": {"uri": URI}})["data"]
    rows = [tuple(data[at : at + 5]) for at in range(0, len(data), 5)]
    assert rows[0][:3] == (0, 0, 4)
    assert rows[2] == (0, 4, 1, 4, 1)
    place = {"start": {"line": 2, "character": 0}, "end": {"line": 3, "character": 0}}
    asked = {"textDocument": {"uri": URI}, "range": place}
    assert client.ask("textDocument/semanticTokens/range", asked)["data"][:3] == [2, 0, 1]


def test_commands_can_be_rewritten_and_warnings_silenced_from_the_menu(client):
    opened(client, "let x = WALK\nx for 2 sec\nIDLE\nWALK\n")
    place = {"start": {"line": 1, "character": 0}, "end": {"line": 1, "character": 0}}
    asked = {"textDocument": {"uri": URI}, "range": place}
    kinds = client.ask("textDocument/codeAction", asked | {"context": {"diagnostics": [], "only": ["refactor"]}})
    assert "refactor.inline" in [one["kind"] for one in kinds]
    place = {"start": {"line": 2, "character": 0}, "end": {"line": 2, "character": 0}}
    found = client.ask("textDocument/codeAction", asked | {"range": place, "context": {"diagnostics": []}})
    assert "Ignore `MS047` here" in [one["title"] for one in found]


# --- edits ---

BITS = (
    *("WALK for 3 sec\n", "WLAK", "let x = WALK\n", "x\n", "repeat 2 {\n", "}\n", "with Upper-Body TALK", "( ", ")"),
    *("\r", "\n", "\r\n", "😀", "走路", "\t", "\u2028", "\x0c", "\x85", "# c ", '"', " "),
)


def edit_of(draw: random.Random, text: str) -> tuple[int, int, str]:
    """Return an edit: something is typed, taken out or pasted, or all line ends become others."""
    start = draw.randint(0, len(text))
    match draw.randrange(10):
        case 0 | 1 | 2 | 3 | 4:
            return start, start, draw.choice(BITS)
        case 5 | 6 | 7:
            return start, min(len(text), start + draw.randint(1, 12)), draw.choice(("", draw.choice(BITS)))
        case 8:
            return start, start, "".join(draw.choices(BITS, k=6))
    plain = text.replace("\r\n", "\n").replace("\r", "\n")
    flipped = plain.replace("\n", draw.choice(("\n", "\r\n", "\r")))
    return 0, len(text), flipped[:1500]


def position(text: str, offset: int, encoding: str) -> dict[str, int]:
    """Return where an offset is, worked out in the plainest way."""
    lines = text[:offset].replace("\r\n", "\n").replace("\r", "\n").split("\n")
    if offset and text[offset - 1 : offset + 1] == "\r\n":
        lines = text[: offset - 1].replace("\r\n", "\n").replace("\r", "\n").split("\n")
    size = {"utf-8": 1, "utf-16": 2, "utf-32": 4}[encoding]
    name = encoding if size == 1 else f"{encoding}-le"
    return {"line": len(lines) - 1, "character": len(lines[-1].encode(name)) // size}


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_after_any_edits_diagnostics_are_those_of_a_fresh_analysis(start, demo_library, encoding, request):
    client = start()
    client.initialize({"general": {"positionEncodings": [encoding]}})
    draw, text = random.Random(encoding), "IDLE\r\nWALK for 2 sec\n"
    client.open(URI, text, version=0)
    client.diagnostics(URI, 0)
    for version in range(1, -(-request.config.getoption("--edits") // len(ENCODINGS)) + 1):
        begin, end, new = edit_of(draw, text)
        while 0 < begin < len(text) and text[begin - 1 : begin + 1] == "\r\n":
            begin -= 1
        while 0 < end < len(text) and text[end - 1 : end + 1] == "\r\n":
            end += 1
        place = {"start": position(text, begin, encoding), "end": position(text, end, encoding)}
        text = text[:begin] + new + text[end:]
        client.edit(URI, version, {"range": place, "text": new})
        told = [
            (one["code"], one["range"]["start"], one["range"]["end"], one["message"].partition("\n")[0])
            for one in client.diagnostics(URI, version)
        ]
        fresh = analyse(Source(text), demo_library).diagnostics
        assert told == [
            (
                one.code,
                position(text, one.span.start, encoding),
                position(text, one.span.end, encoding),
                one.message.partition("\n")[0],
            )
            for one in fresh
            if one.span is not None
        ], (version, text)


# --- what a mistake means ---


def test_hovering_over_a_mistake_tells_what_it_means(client):
    opened(client, "IDLE for 1 sec\nWLAK for 1 sec\n")
    hover = client.ask_at("hover", URI, 1, 2)
    said = hover["contents"]["value"]
    assert said.startswith("error: no tag or motion `WLAK` in this library\n\nhelp: ")
    assert "MS021 No graph" in said
    assert hover["range"]["start"] == {"line": 1, "character": 0}


def test_hovering_over_what_only_has_a_warning_tells_first_what_it_is(client):
    opened(client, "let greet = WALK\nIDLE\n")
    said = client.ask_at("hover", URI, 0, 5)["contents"]["value"]
    assert said.startswith("let greet = WALK\n")
    assert "warning: `greet` is defined" in said


def test_a_definition_is_not_taken_out_that_an_open_script_may_need(client, tmp_path):
    text, (uri, user) = (
        "let greet = WALK\ngreet for 1 sec\n",
        [(tmp_path / one).as_uri() for one in ("greet.ms", "user.ms")],
    )
    (tmp_path / "greet.ms").write_text(text, encoding="utf-8")
    place = {"start": {"line": 0, "character": 5}, "end": {"line": 0, "character": 5}}
    asked = {"textDocument": {"uri": uri}, "range": place, "context": {"diagnostics": [], "only": ["refactor.inline"]}}
    client.open(uri, text)
    (alone,) = client.ask("textDocument/codeAction", asked)
    client.open(user, 'use "greet.ms"\ngreet\n')
    client.diagnostics(user)
    (used,) = client.ask("textDocument/codeAction", asked)
    assert alone["title"] == f"{used['title']}, and take it out"
    assert [len(one["edit"]["changes"][uri]) for one in (alone, used)] == [2, 1]
    for one in (uri, user):
        client.close_text(one)


def test_a_mistake_can_be_explained_by_a_command_of_the_menu(client):
    opened(client, "WLAK for 1 sec\nWLAK\n")
    place = {"start": {"line": 0, "character": 0}, "end": {"line": 1, "character": 2}}
    asked = {"textDocument": {"uri": URI}, "range": place, "context": {"diagnostics": []}}
    found = client.ask("textDocument/codeAction", asked)
    (explain,) = (one for one in found if one["title"].startswith("Explain `MS021`"))
    assert len(explain["diagnostics"]) == 2
    assert "kind" not in explain
    assert "WLAK" in client.ask("workspace/executeCommand", explain["command"])["text"]
    mending = client.ask("textDocument/codeAction", asked | {"context": {"diagnostics": [], "only": ["quickfix"]}})
    assert explain["title"] not in [one["title"] for one in mending]


@pytest.mark.parametrize("shown", [True, False])
def test_a_mistake_links_to_the_text_that_explains_it_where_the_editor_shows_links(start, shown):
    client = start()
    client.initialize({"textDocument": {"publishDiagnostics": {"codeDescriptionSupport": shown}}})
    client.open(URI, "WLAK")
    (found,) = client.diagnostics(URI)
    assert ("codeDescription" in found) == shown
    if shown:
        page = Path(unquote(urlsplit(found["codeDescription"]["href"]).path))
        assert "has a motion or tag of this name" in page.read_text(encoding="utf-8")
