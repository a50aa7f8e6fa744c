"""What is asked of a definition is answered by scripts too that use it and are not open."""

import os
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from mlmg_lang.definitions.gather import NoFiles
from mlmg_lang.front_end import analyse
from mlmg_lang.source import Source
from mlmg_lsp.client import Client
from mlmg_lsp.closed import ClosedScripts, Dependents
from mlmg_lsp.libraries import Shelf
from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.scripts_below import scripts_below
from mlmg_lsp.workspace import Settings, Workspace

VERSIONED = {"workspace": {"workspaceEdit": {"documentChanges": True}}}
GEST = "let greet(who, t = 2 sec) = who with Upper-Body WAVE for t\n"
USER = 'use "../gest.ms"\n# 😀\ngreet(WALK, t = 3 sec)\n'


@pytest.fixture
def folder(tmp_path):
    """Return a folder with a file of definitions, which is open, and below it a script that uses it, which is not."""
    root = tmp_path / "root"
    (root / "scenes").mkdir(parents=True)
    (root / "mlmg.toml").write_text("", encoding="utf-8")
    (root / "gest.ms").write_text(GEST, encoding="utf-8")
    (root / "scenes" / "user.ms").write_text(USER, encoding="utf-8")
    return root


@pytest.fixture(scope="module")
def shared(start_for_all):
    """Return a client without a folder."""
    client = start_for_all()
    client.initialize(VERSIONED)
    return client


@pytest.fixture
def client(shared, folder):
    """Return a client in which the folder is the only one, and the file of definitions is open."""
    gest, at = (folder / "gest.ms").as_uri(), {"uri": folder.as_uri(), "name": "root"}
    shared.notify("workspace/didChangeWorkspaceFolders", {"event": {"added": [at], "removed": []}})
    shared.open(gest, GEST, version=7)
    yield shared
    shared.close_text(gest)
    shared.notify("workspace/didChangeWorkspaceFolders", {"event": {"added": [], "removed": [at]}})


def begun(start, folder: Path, **params):
    client = start()
    client.initialize(VERSIONED, **{"rootUri": folder.as_uri(), **params})
    client.open((folder / "gest.ms").as_uri(), GEST, version=7)
    return client


def name_of(uri: str) -> str:
    return Path(unquote(urlsplit(uri).path)).name


def renamed(client, folder: Path, new: str, character: int = 4) -> dict[str, tuple[int | None, list[tuple[int, int]]]]:
    """Return, by file, its version and the places that are edited."""
    changes = client.ask_at("rename", (folder / "gest.ms").as_uri(), 0, character, newName=new)["documentChanges"]
    return {
        name_of(one["textDocument"]["uri"]): (
            one["textDocument"]["version"],
            [tuple(edit["range"]["start"].values()) for edit in one["edits"]],
        )
        for one in changes
    }


def refused(client, folder: Path, new: str, character: int = 4) -> str:
    place = {"textDocument": {"uri": (folder / "gest.ms").as_uri()}, "position": {"line": 0, "character": character}}
    error = client.outcome(client.begin("textDocument/rename", place | {"newName": new}))["error"]
    assert error["code"] == -32803
    return str(error["message"])


def used_in(client, folder: Path, character: int = 4) -> list[tuple[str, int]]:
    asked = {"context": {"includeDeclaration": True}}
    found = client.ask_at("references", (folder / "gest.ms").as_uri(), 0, character, **asked)
    return [(name_of(one["uri"]), one["range"]["start"]["line"]) for one in found]


def test_they_are_edited_and_listed(client, folder):
    assert renamed(client, folder, "hello") == {"gest.ms": (7, [(0, 4)]), "user.ms": (None, [(2, 0)])}
    assert renamed(client, folder, "length", 15) == {"gest.ms": (7, [(0, 15), (0, 57)]), "user.ms": (None, [(2, 12)])}
    assert used_in(client, folder) == [("gest.ms", 0), ("user.ms", 2)]


def test_without_a_folder_that_of_the_script_is_looked_in(start, folder):
    client = begun(start, folder, rootUri=None)
    assert set(renamed(client, folder, "hello")) == {"gest.ms", "user.ms"}


def test_those_are_found_that_use_it_by_way_of_others_and_as_they_are_now(client, folder):
    (folder / "more.ms").write_text('use "gest.ms"\nlet more = greet(IDLE)\n', encoding="utf-8")
    (folder / "far.ms").write_text('use "more.ms"\ngreet(WALK)\nmore\n', encoding="utf-8")
    expected = [("gest.ms", 0), ("far.ms", 1), ("more.ms", 1), ("user.ms", 2)]
    assert sorted(used_in(client, folder)) == sorted(expected)
    (folder / "scenes" / "user.ms").write_text("IDLE\n", encoding="utf-8")
    (folder / "far.ms").write_text("IDLE\n\n", encoding="utf-8")
    assert used_in(client, folder) == [("gest.ms", 0), ("more.ms", 1)]


def test_what_an_open_script_between_them_says_is_taken_as_it_is_there(start, folder):
    client = begun(start, folder)
    client.open((folder / "more.ms").as_uri(), 'use "gest.ms"\n')
    client.diagnostics((folder / "more.ms").as_uri())
    (folder / "more.ms").write_text("", encoding="utf-8")
    (folder / "far.ms").write_text('use "more.ms"\ngreet(WALK)\n', encoding="utf-8")
    assert ("far.ms", 1) in used_in(client, folder)


def test_a_script_that_has_a_definition_of_its_own_or_is_out_of_the_way_is_left_alone(client, folder):
    own = "let greet(who) = who\ngreet(WALK)\n"
    for name in ("own.ms", ".venv/in.ms", "node_modules/in.ms", "plain.txt"):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(own if name == "own.ms" else USER, encoding="utf-8")
    assert set(renamed(client, folder, "hello")) == {"gest.ms", "user.ms"}


def test_a_file_is_edited_once_whatever_leads_to_it(client, folder):
    (folder / "circle").symlink_to(folder, target_is_directory=True)
    (folder / "scenes" / "alias.ms").symlink_to(folder / "scenes" / "user.ms")
    (folder / "nowhere.ms").symlink_to(folder / "nowhere.ms")
    found = renamed(client, folder, "hello")
    assert len(found) == 2
    assert found["gest.ms"] == (7, [(0, 4)])


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (b'use "gest.ms"\nIDLE\nlet hello = IDLE\nhello\n', "taken.ms: there is a definition `hello` already"),
        (b'use "gest.ms"\nhello for 1 sec\n', "taken.ms: `hello` means something else in line 2 already"),
        (b'use "gest.ms"\ngreet for for\n', "`greet` stands in line 2 of {folder}/taken.ms, which cannot be read"),
        (b'use "gest.ms"\ngreet(WALK) # \xff\n', "taken.ms cannot be read: this file is not UTF-8: byte 0xFF"),
    ],
)
def test_what_cannot_be_edited_there_is_refused_in_words(client, folder, text, why):
    (folder / "taken.ms").write_bytes(text)
    assert why.format(folder=folder) in refused(client, folder, "hello")


def test_a_parameter_is_refused_where_its_definition_stands_in_what_cannot_be_read(client, folder):
    (folder / "broken.ms").write_text('use "gest.ms"\ngreet(WALK, t = = 2)\n', encoding="utf-8")
    assert "`greet` stands in line 2" in refused(client, folder, "length", 15)


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="here all can be read")
def test_a_script_that_may_not_be_read_is_told_of(client, folder):
    (folder / "secret.ms").write_text(USER, encoding="utf-8")
    (folder / "secret.ms").chmod(0)
    assert "secret.ms may use this too, and cannot be read: Permission denied" in refused(client, folder, "hello")


def test_a_used_file_that_has_changed_meanwhile_is_not_edited_where_it_no_longer_says_so(start, folder):
    client = start()
    client.initialize(VERSIONED, rootUri=folder.as_uri())
    user = (folder / "scenes" / "user.ms").as_uri()
    client.open(user, USER)
    client.diagnostics(user)
    place = {"textDocument": {"uri": user}, "position": {"line": 2, "character": 0}, "newName": "hello"}
    assert len(client.ask("textDocument/rename", place)["documentChanges"]) == 2
    (folder / "gest.ms").write_text(f"# one more line\n{GEST}", encoding="utf-8")
    error = client.outcome(client.begin("textDocument/rename", place))["error"]
    assert error["message"].startswith(f"{folder / 'gest.ms'} has changed since the open scripts that use it")
    client.notify("workspace/didChangeWatchedFiles", {"changes": [{"uri": (folder / "gest.ms").as_uri(), "type": 2}]})
    changes = client.ask("textDocument/rename", place)["documentChanges"]
    lines = {name_of(one["textDocument"]["uri"]): one["edits"][0]["range"]["start"]["line"] for one in changes}
    assert lines == {"gest.ms": 1, "user.ms": 2}


def test_a_file_may_be_open_by_way_of_a_link(start, folder):
    (folder.parent / "link").symlink_to(folder, target_is_directory=True)
    client = start()
    client.initialize(VERSIONED, rootUri=folder.as_uri())
    client.open((folder.parent / "link" / "gest.ms").as_uri(), GEST)
    assert set(renamed(client, folder.parent / "link", "hello")) == {"gest.ms", "user.ms"}


def test_what_is_too_large_to_be_read_is_told_of(client, folder):
    (folder / "large.ms").write_text('use "gest.ms"\n' + "# x\n" * 250_000, encoding="utf-8")
    assert set(renamed(client, folder, "hello")) == {"gest.ms", "user.ms"}
    told = client.wait_for("window/showMessage")["message"]
    assert told == f"Not all scripts were looked at. Left out: {folder / 'large.ms'}: larger than 1,000,000 bytes."


def test_scripts_are_looked_for_within_bounds(tmp_path):
    from mlmg_lsp.scripts_below import Bounds, scripts_below

    for name in ("a.ms", "b.txt", "deep/c.ms", "deep/.hidden/d.ms", "deep/e.ms"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("12345", encoding="utf-8")
    all_of_it = scripts_below([tmp_path, tmp_path / "deep", tmp_path / "no such"])
    assert [Path(one.path).name for one in all_of_it.scripts] == ["a.ms", "c.ms", "e.ms"]
    assert (all_of_it.too_large, all_of_it.is_all) == ((), True)
    for bounds in (Bounds(n_scripts=2), Bounds(n_entries=5)):
        some = scripts_below([tmp_path], bounds)
        assert ([Path(one.path).name for one in some.scripts], some.is_all) == (["a.ms", "c.ms"], False)
    large = scripts_below([tmp_path], Bounds(n_scripts=3, n_bytes=4))
    assert (large.too_large, large.is_all) == (large.scripts, True)


def test_a_script_that_is_gone_when_it_is_looked_into_uses_nothing(tmp_path):
    script = tmp_path / "gone.ms"
    script.write_text('use "gest.ms"\n', encoding="utf-8")
    (found,) = scripts_below([tmp_path]).scripts
    script.unlink()
    gest = tmp_path / "gest.ms"
    asked = Snapshot(gest.as_uri(), 1, analyse(Source(GEST, str(gest))), None, Client())
    closed = ClosedScripts(lambda _: NoFiles())
    assert closed._look(found).wrong == ""
    assert closed.users(str(gest), [tmp_path], asked) == Dependents()


def test_for_a_file_right_below_the_root_of_a_file_system_nothing_is_searched(tmp_path):
    workspace = Workspace(Settings(), Shelf())
    top = Path(tmp_path.anchor)
    assert workspace.folders_around(top / "a.ms") == ()
    assert workspace.folders_around(tmp_path / "a.ms") == (tmp_path,)
