"""What is wrong in a file that a script uses is told in that file too."""

import pytest

PUSHED = {"textDocument": {"publishDiagnostics": {"relatedInformation": True}}}
PULLING = {
    "textDocument": {"diagnostic": {}, "publishDiagnostics": {"relatedInformation": True}},
    "workspace": {"diagnostics": {"refreshSupport": True}},
}
WRONG = "let stroll = WLAK for 3 sec\n"
RIGHT = "let stroll = WALK for 3 sec\n"


@pytest.fixture
def used(tmp_path):
    path = tmp_path / "moves" / "used.ms"
    path.parent.mkdir()
    path.write_text("# 😀\n" + WRONG, encoding="utf-8")
    return path


def begun(start, capabilities):
    client = start()
    client.initialize(capabilities)
    return client


def changed(client, path, text: str) -> None:
    path.write_text(text, encoding="utf-8")
    client.notify("workspace/didChangeWatchedFiles", {"changes": [{"uri": path.as_uri(), "type": 2}]})


def codes(found) -> list[tuple[str, int]]:
    return [(one["code"], one["range"]["start"]["line"]) for one in found]


@pytest.mark.parametrize("capabilities", [PUSHED, PULLING], ids=["pushed", "pulled"])
def test_it_is_shown_there_until_it_is_mended(start, tmp_path, used, capabilities):
    client, user = begun(start, capabilities), (tmp_path / "user.ms").as_uri()
    client.open(user, '\nuse "moves/used.ms"\nstroll\n')
    (found,) = client.diagnostics(used.as_uri())
    assert (found["code"], found["range"]["start"]) == ("MS021", {"line": 1, "character": 13})
    (where,) = (one for one in found["relatedInformation"] if one["message"] == "the file is used here")
    assert (where["location"]["uri"], where["location"]["range"]["start"]) == (user, {"line": 1, "character": 4})
    changed(client, used, RIGHT)
    assert client.diagnostics(used.as_uri()) == []


@pytest.mark.parametrize("way", ["edit", "close"])
def test_it_is_taken_back_when_no_script_uses_the_file_any_more(start, tmp_path, used, way):
    client, users = begun(start, PUSHED), [(tmp_path / name).as_uri() for name in ("a.ms", "b.ms")]
    for user in users:
        client.open(user, 'use "moves/used.ms"\nstroll\n')
        assert codes(client.diagnostics(user)) == [("MS021", 0)]
    assert codes(client.diagnostics(used.as_uri())) == [("MS021", 1)]
    for user in users:
        if way == "edit":
            client.edit(user, 2, {"text": "IDLE\n"})
        else:
            client.notify("textDocument/didClose", {"textDocument": {"uri": user}})
    while client.diagnostics(used.as_uri()):
        pass


def test_in_an_open_file_it_is_shown_once_with_what_only_its_user_can_know(start, tmp_path, used):
    client, user = begun(start, PUSHED), (tmp_path / "user.ms").as_uri()
    client.open(used.as_uri(), WRONG)
    assert ("MS021", 0) in codes(client.diagnostics(used.as_uri()))
    client.open(user, 'use "moves/used.ms"\nlet stroll = IDLE\nstroll\n')
    client.diagnostics(user)
    found = codes(client.diagnostics(used.as_uri()))
    assert found.count(("MS021", 0)) == 1
    assert ("MS050", 0) in found
    client.edit(used.as_uri(), 2, {"text": "let amble = WALK for 3 sec\n"})
    while {"MS021", "MS050"} & {code for code, _ in codes(client.diagnostics(used.as_uri()))}:
        pass


def test_the_use_that_leads_to_the_file_is_underlined_be_it_by_way_of_another(start, tmp_path, used):
    (used.parent / "more.ms").write_text('use "used.ms"\n', encoding="utf-8")
    (tmp_path / "fine.ms").write_text("let fine = WALK\n", encoding="utf-8")
    client, user = begun(start, PUSHED), (tmp_path / "user.ms").as_uri()
    client.open(user, 'use "fine.ms"\nuse "moves/more.ms"\nstroll\nfine\n')
    assert ("MS021", 1) in codes(client.diagnostics(user))
    assert codes(client.diagnostics(used.as_uri())) == [("MS021", 1)]


@pytest.mark.parametrize("method", ["references", "rename"])
def test_what_is_asked_of_all_scripts_waits_for_those_that_are_read(start, tmp_path, used, method):
    used.write_text(RIGHT, encoding="utf-8")
    client, user = begun(start, PUSHED), (tmp_path / "user.ms").as_uri()
    client.open(used.as_uri(), RIGHT)
    client.diagnostics(used.as_uri())
    client.open(user, 'use "moves/used.ms"\n' + "stroll\n" * 600)
    asked = {"textDocument": {"uri": used.as_uri()}, "position": {"line": 0, "character": 5}, "newName": "amble"}
    asked["context"] = {"includeDeclaration": True}

    def n_found() -> int:
        found = client.ask(f"textDocument/{method}", asked)
        return len(found) if method == "references" else sum(map(len, found["changes"].values()))

    assert n_found() == 601
    start_of_text = {"line": 0, "character": 0}
    client.edit(used.as_uri(), 2, {"range": {"start": start_of_text, "end": start_of_text}, "text": " "})
    assert n_found() == 601


def test_a_used_file_that_is_opened_with_another_text_counts_as_it_stands_there(start, tmp_path, used):
    used.write_text(RIGHT, encoding="utf-8")
    client, user = begun(start, PUSHED), (tmp_path / "user.ms").as_uri()
    client.open(user, 'use "moves/used.ms"\nstroll\n')
    assert client.diagnostics(user) == []
    client.open(used.as_uri(), f"# 1\n# 2\n{RIGHT}")
    assert client.diagnostics(user) == []
    (place,) = client.ask_at("definition", user, 1, 1)
    assert (place["uri"], place["range"]["start"]["line"]) == (used.as_uri(), 2)
    client.notify("textDocument/didClose", {"textDocument": {"uri": used.as_uri()}})
    assert client.diagnostics(user) == []
    client.open(used.as_uri(), "let amble = WALK\n")
    assert [one["code"] for one in client.diagnostics(user) if one["severity"] == 1] == ["MS021"]


def test_a_text_without_a_file_uses_those_of_the_first_folder_of_the_editor(start, tmp_path, used):
    used.write_text(RIGHT, encoding="utf-8")
    (tmp_path / "untitled.ms").write_text("let amble = WALK\n", encoding="utf-8")
    client = start()
    client.initialize(PUSHED, rootUri=used.parent.as_uri())
    client.open("untitled:Untitled-1", 'use "used.ms"\nstroll\n')
    assert client.diagnostics("untitled:Untitled-1") == []
    (place,) = client.ask_at("definition", "untitled:Untitled-1", 1, 1)
    assert place["uri"] == used.as_uri()
    (link,) = client.ask("textDocument/documentLink", {"textDocument": {"uri": "untitled:Untitled-1"}})
    assert link["target"] == used.as_uri()
    client.open("untitled:Untitled-2", 'use "../untitled.ms"\namble\n')
    (wrong,) = client.diagnostics("untitled:Untitled-2")
    assert "lies outside of the script's own folders" in wrong["message"]


def test_a_used_file_that_is_opened_as_it_is_changes_nothing(start, tmp_path, used):
    used.write_text(RIGHT, encoding="utf-8")
    client, user = begun(start, PUSHED), (tmp_path / "user.ms").as_uri()
    client.open(user, 'use "moves/used.ms"\nstroll\n')
    client.diagnostics(user)
    client.open(used.as_uri(), RIGHT)
    client.diagnostics(used.as_uri())
    client.ask_at("hover", user, 1, 1)
    client.ask("shutdown")
    client.notify("exit")
    told = [one["params"]["uri"] for one in client.rest() if one.get("method") == "textDocument/publishDiagnostics"]
    assert user not in told


@pytest.mark.parametrize("way", ["opened", "saved", "closed", "changed"])
def test_a_file_that_was_missing_is_found_as_soon_as_the_client_has_to_do_with_it(start, tmp_path, used, way):
    used.write_bytes(b"let stroll = WALK # \xff\n")
    client, user = begun(start, PUSHED), (tmp_path / "user.ms").as_uri()
    client.open(user, 'use "moves/used.ms"\nstroll\n')
    assert [one["code"] for one in client.diagnostics(user)] == ["MS058"]
    if way == "closed":
        client.open(used.as_uri(), RIGHT)
        client.diagnostics(user)
    used.write_text(RIGHT, encoding="utf-8")
    document = {"textDocument": {"uri": used.as_uri()}}
    match way:
        case "opened":
            client.open(used.as_uri(), RIGHT)
        case "saved":
            client.notify("textDocument/didSave", {"textDocument": {"uri": user}})
        case "closed":
            client.notify("textDocument/didClose", document)
        case "changed":
            changed(client, used, RIGHT)
    while found := client.diagnostics(user):
        assert [one["code"] for one in found] == ["MS058"]
