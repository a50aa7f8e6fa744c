"""Each line has one reply: what was played, what is wrong, or what a command with a dot tells."""

import json
import shlex
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import mlmg_lang
from mlmg_lang.commands import mlmgc
from mlmg_lang.repl.conversation import Conversation
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.dot_commands import DOT_COMMANDS, Takes
from mlmg_lang.repl.reply import Reply
from mlmg_lang.repl.terminal.toolbar import toolbar
from mlmg_lang.session.session import Session
from mlmg_runtime import bvh
from mlmg_runtime.library import Library, open_library

Say = Callable[..., Reply]


def test_a_command_is_answered_with_what_each_part_plays_and_when_it_arrived(say: Say) -> None:
    reply = say("WALK with Upper-Body TALK for 2 sec")
    assert reply.ok
    lines = reply.text.splitlines()
    assert lines[0].startswith("  Full-Body  Walk_")
    assert any(line.startswith("  Upper-Body  Talk_01 after ") for line in lines)
    assert any(" -> Talk_01:" in line and "cost" in line for line in lines)
    assert lines[-1].endswith(" s of motion")
    (statement,) = reply.data["statements"]
    assert set(statement["motions"]) == {"Full-Body", "Upper-Body"}
    assert statement["begin"] == 0.0
    assert statement["end"] == pytest.approx(statement["arrive"] + 2.0, abs=2e-3)
    assert {"graph", "kind", "begin", "from", "to", "cost"} == set(statement["transitions"][0])


def test_a_part_has_arrived_with_its_last_transition_into_the_motion_not_with_a_loop_in_it(say: Say) -> None:
    reply = say("Walk_01 with Upper-Body Talk_01 with Left-Hand Wave_01")
    told = {line.split()[0]: float(line.split()[3]) for line in reply.text.splitlines() if " after " in line}
    moves = reply.data["statements"][0]["transitions"]
    for graph, seconds in told.items():
        into = [move for move in moves if move["graph"] == graph and move["from"][0] != move["to"][0]]
        assert seconds == pytest.approx(into[-1]["begin"] + 20 / 30, abs=0.06)


def test_mistakes_are_drawn_as_mlmg_check_draws_them(say: Say) -> None:
    reply = say("WLAK for 3 sec")
    assert not reply.ok
    assert "error[MS021]: no tag or motion `WLAK` in this library" in reply.text
    assert " 1 | WLAK for 3 sec\n   | ^^^^\n" in reply.text
    assert reply.data["diagnostics"][0]["code"] == "MS021"


def test_what_plays_on_as_it_was_says_so_and_a_part_that_is_ended_goes_with_the_body_again(say: Say) -> None:
    assert "Full-Body  Idle_01, as it was" in say("Idle_01 for 1 sec").text
    reply = say("WALK with Upper-Body TALK", "end Upper-Body")
    assert "Upper-Body  goes with the body again after " in reply.text


def test_of_a_long_loop_the_first_statements_are_told(say: Say) -> None:
    reply = say("repeat 40 { wait 1 frames }")
    assert "... and 28 more" in reply.text
    assert len(reply.data["statements"]) == 40


EVIL = "\x1b[2J \x1b]0;so\x07 \x01\x1bc\x02 \x9b2J"


@pytest.mark.parametrize(
    "line",
    [
        f"WALK {EVIL}",
        f"IDLE # {EVIL}",
        f'let "{EVIL}" = WALK',
        f'"{EVIL}"; IDLE',
        *(f".{one.name} {EVIL}" for one in DOT_COMMANDS),
        f".load {EVIL}.ms",
        f".save {EVIL}.ms",
        f".{EVIL}",
        f'.candidates "{EVIL}"',
    ],
)
def test_nothing_that_is_written_reaches_the_terminal_as_more_than_text(
    line: str, conversation: Conversation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    conversation.say(f'let "{EVIL}" = WALK')
    for said in (line, f'"{EVIL}" for 1 sec; IDLE # {EVIL}', ".timeline", ".undo", ".redo", ".seed 2", ".library"):
        text = conversation.say(said).text
        assert all(piece.isprintable() for piece in text.split("\n")), (said, text)


# --- commands with a dot ---


@pytest.mark.parametrize("name", [one.name for one in DOT_COMMANDS])
def test_every_command_has_help(name: str, say: Say) -> None:
    reply = say(f".help {name}")
    assert reply.ok
    assert reply.text.startswith(f".{name}")
    assert f".{name}" in say(".help").text


@pytest.mark.parametrize(
    ("line", "told"),
    [
        (".sav x.bvh", "did you mean `.save`?"),
        (".motions Uper-Body", "did you mean `Upper-Body`?"),
        (".oms Wlak_01", "did you mean `Walk_01`"),
        (".oms", "name a motion"),
        (".seed x", "expected a whole number"),
        (".start", "name the motion"),
        (".start Nobody", "there is no motion `Nobody`"),
        (".save", "nds in .bvh or .ms"),
        (".save x.fbx", "ends in .bvh or .ms"),
        (".save x.bvh", "nothing has been played"),
        (".view", "nothing has been played"),
        (".load", "name a script"),
        (".load missing.ms", "missing.ms: No such file"),
        (".library missing.mlmg", "missing.mlmg: No such file"),
        (".set colour red", "expected `blend"),
        (".set fps 0", "expected frames a second"),
        (".time maybe", "expected `.time on`"),
        (".undo", "nothing to take back"),
        (".redo", "nothing to play again"),
        (".candidates", "name a command"),
        (".explain", "name a command"),
        (".", "there is no command"),
        (".undo x", "expected a whole number from 1 on, as in `.undo 3`, found `x`"),
        (".redo 0", "expected a whole number from 1 on, as in `.redo 3`, found `0`"),
        *(
            (f"{one.usage} now", f"`{one.usage}` takes no words after it, found `now`")
            for one in DOT_COMMANDS
            if one.takes is Takes.NOTHING
        ),
    ],
)
def test_what_cannot_be_done_is_one_line_that_says_what_to_do(
    line: str, told: str, say: Say, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    reply = say(line)
    assert not reply.ok
    assert reply.text.startswith("error: ")
    assert reply.text.count("\n") == 1
    assert told in reply.text


@pytest.mark.parametrize(
    ("line", "meant"),
    [
        ("help", ".help"),
        ("?", ".help"),
        ("HELP save", ".help save"),
        ("exit", ".quit"),
        ("quit", ".quit"),
        ("exit()", ".quit"),
        ("quit;", ".quit"),
        (":q", ".quit"),
        ("undo", ".undo"),
        ("undo 3", ".undo 3"),
        ("save a.ms", ".save a.ms"),
        ("explain WALK for 2 sec", ".explain WALK for 2 sec"),
    ],
)
def test_words_of_other_programs_are_told_with_the_command_that_is_meant(line: str, meant: str, say: Say) -> None:
    reply = say(line)
    assert not reply.ok
    assert reply.text == f"error: write `{meant}`: commands that play nothing begin with a dot\n"


def test_a_word_that_means_something_is_no_command(say: Say) -> None:
    assert say("let exit = WALK", "exit").ok
    assert "MS021" in say("undo with Upper-Body TALK").text
    assert "error[" in say("state of mind").text


def test_graphs_motions_and_tags_tell_what_the_library_has(say: Say) -> None:
    assert [row["graph"] for row in say(".graphs").data["graphs"]] == ["Full-Body", "Upper-Body", "Left-Hand"]
    assert "Wave_01" in say(".motions left-hand").text
    assert say(".tags").data["tags"]["WALK"] == ["Walk_01", "Walk_02", "Walk_03"]


def test_oms_tells_the_most_alike_first_on_each_graph(say: Say) -> None:
    data = say(".oms walk01").data["oms"]
    assert list(data) == ["Full-Body", "Upper-Body", "Left-Hand"]
    assert all(rows == sorted(rows, key=lambda row: row["oms"]) for rows in data.values())


def test_state_and_timeline_tell_where_it_stands(say: Say) -> None:
    state = say("WALK for 2 sec", "WALK with Upper-Body TALK", ".state")
    assert set(state.data["playing"]) == {"Full-Body", "Upper-Body"}
    assert state.data["unsaved"]
    assert [row["text"] for row in say(".timeline").data["timeline"]] == ["WALK for 2 sec", "WALK with Upper-Body TALK"]


def test_candidates_are_what_each_would_cost_and_the_one_that_is_then_taken(say: Say) -> None:
    say("WALK for 2 sec")
    layers = say(".candidates IDLE with Upper-Body TALK").data["layers"]
    assert [layer["graph"] for layer in layers] == ["Full-Body", "Upper-Body"]
    assert layers[0]["left_out"][0]["motion"] == "Idle_02"
    taken = {layer["graph"]: one for layer in layers for one in layer["candidates"] if one["taken"]}
    soonest = min(one["seconds"] for one in layers[0]["candidates"])
    assert taken["Full-Body"]["seconds"] == soonest
    (done,) = say("IDLE with Upper-Body TALK").data["statements"]
    assert done["motions"] == {graph: one["motion"] for graph, one in taken.items()}
    assert done["arrive"] - done["begin"] == pytest.approx(taken["Upper-Body"]["seconds"], abs=2e-3)


def test_candidates_of_a_name_alone_are_told_without_its_quotes(demo_library: Library) -> None:
    root = demo_library.root
    numbers = {motion: f"14_{at:02}" for at, motion in enumerate(root.motions)}
    numbered = replace(root, tags={motion: (*root.tags[motion], number) for motion, number in numbers.items()})
    library = replace(demo_library, by_name={**demo_library.by_name, root.name: numbered})
    conversation = Conversation(Desk(Session(library), lambda *_: ""))
    for line in (".candidates 14_02", '.candidates "14_02"', '.candidates "14_02" once'):
        (layer,) = conversation.say(line).data["layers"]
        assert [one["motion"] for one in layer["candidates"]] == [root.motions[2]]
    assert "plan" in conversation.say(".explain 14_02").data


def test_asking_plays_nothing(say: Say, conversation: Conversation) -> None:
    say("WALK for 2 sec")
    turns = conversation.desk.session.turns
    for line in (".candidates IDLE", ".explain IDLE with Upper-Body TALK", ".candidates WLAK", ".state", ".timeline"):
        say(line)
    assert conversation.desk.session.turns == turns


def test_what_is_saved_as_motion_has_what_was_played(say: Say, conversation: Conversation, tmp_path: Path) -> None:
    say("WALK for 2 sec", f".save {tmp_path / 'a b.bvh'}")
    assert len(bvh.read(tmp_path / "a b.bvh").frames) == round(conversation.desk.session.n_seconds * 30)
    assert not conversation.desk.unsaved
    say("IDLE")
    assert conversation.desk.unsaved
    say(".undo")
    assert not conversation.desk.unsaved


def test_a_saved_script_says_how_to_play_it_and_plays_the_same(say: Say, tmp_path: Path, demo_library: Library) -> None:
    say(".seed 5", "Walk_01", "choose { IDLE for 1 sec | TALK for 1 sec }", "WALK for 2 sec")
    say(f".save {tmp_path / 'walk.ms'}", f".save {tmp_path / 'walk.bvh'}")
    text = (tmp_path / "walk.ms").read_text(encoding="utf-8")
    first = text.splitlines()[0]
    assert first.startswith("# mlmgc walk.ms -o walk.bvh --library ")
    assert first.endswith("--start Walk_01 --seed 5")
    plan, _ = mlmg_lang.compile(text, demo_library, "Walk_01")
    assert plan is not None
    again = mlmg_lang.play(plan, demo_library, 5)
    assert len(again.bvh.frames) == len(bvh.read(tmp_path / "walk.bvh").frames)


def test_a_script_that_is_saved_loaded_and_saved_again_tells_once_how_to_play_it(say: Say, tmp_path: Path) -> None:
    say("WALK for 1 sec", f".save {tmp_path / 'a.ms'}")
    say(f".load {tmp_path / 'a.ms'}", f".save {tmp_path / 'b.ms'}")
    assert (tmp_path / "b.ms").read_text(encoding="utf-8").count("# mlmgc") == 1


def test_a_script_is_loaded_as_one_entry(say: Say, conversation: Conversation, tmp_path: Path) -> None:
    (tmp_path / "a.ms").write_text("WALK for 1 sec\nWALK\n  with Upper-Body TALK\n", encoding="utf-8")
    assert say(f".load {tmp_path / 'a.ms'}").ok
    assert len(conversation.desk.session.turns) == 1
    (tmp_path / "b.ms").write_bytes(b"\xff")
    assert "UTF-8" in say(f".load {tmp_path / 'b.ms'}").text


@pytest.fixture
def scripts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with a script that uses a file beside it, next to the current folder."""
    folder = tmp_path / "my scripts"
    folder.mkdir()
    (folder / "lib.ms").write_text("let A = WALK\n", encoding="utf-8")
    (folder / "a.ms").write_text('use "lib.ms"\nA for 1 sec\n', encoding="utf-8")
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    return folder


def test_a_script_that_is_loaded_finds_what_it_uses_from_its_own_folder(say: Say, scripts: Path) -> None:
    assert say('.load "../my scripts/a.ms"').ok
    assert say("let B = A", "B for 1 sec").ok
    assert len(say(".seed 4", ".timeline").data["timeline"]) == 2
    (scripts / "b.ms").write_text("let C = NOBODY\n", encoding="utf-8")
    assert "--> ../my scripts/b.ms:1:9\n" in say(".load ../my scripts/b.ms").text


@pytest.fixture
def own_library(conversation: Conversation, scripts: Path, demo_library: Library) -> Path:
    """Return the library that the conversation is about: a file in the current folder."""
    shutil.copy(demo_library.path, "my.mlmg")
    conversation.desk.replace_session(Session(open_library(Path("my.mlmg"))), ".library my.mlmg")
    return Path("my.mlmg")


@pytest.mark.usefixtures("own_library")
def test_a_script_is_saved_so_that_its_first_line_plays_it_where_it_is_saved(
    say: Say, scripts: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    say(".load ../my scripts/a.ms", ".start Walk_02", "IDLE", ".set blend linear", ".set fps 24", ".set feet off")
    frames = bvh.read(Path(say(".save all.bvh").data["file"])).frames
    assert say(".save ../my scripts/it's.ms").data["as_entered"]
    assert not say(".save c.ms").data["as_entered"]
    for path in (scripts / "it's.ms", Path.cwd() / "c.ms"):
        monkeypatch.chdir(path.parent)
        hash_sign, program, *words = shlex.split(path.read_text(encoding="utf-8").splitlines()[0])
        assert (hash_sign, program, mlmgc.main(words)) == ("#", "mlmgc", 0)
        np.testing.assert_array_equal(bvh.read(path.with_suffix(".bvh")).frames, frames)


def test_a_script_that_would_use_another_file_of_that_name_has_the_motions_that_were_taken(
    say: Say, scripts: Path
) -> None:
    Path("lib.ms").write_text("let A = TALK\n", encoding="utf-8")
    assert say(f".load {scripts / 'a.ms'}").ok
    assert not say(".save c.ms").data["as_entered"]
    assert "Full-Body Walk_" in Path("c.ms").read_text(encoding="utf-8")


def test_a_script_on_the_demo_library_says_so(say: Say, tmp_path: Path) -> None:
    say("WALK", f".save {tmp_path / 'a.ms'}")
    assert " --library demo " in (tmp_path / "a.ms").read_text(encoding="utf-8")


def test_no_file_that_is_read_is_written_over(say: Say, own_library: Path, scripts: Path) -> None:
    Path("link.bvh").symlink_to(own_library)
    say(".load ../my scripts/a.ms")
    before = {path: path.read_bytes() for path in (own_library, scripts / "a.ms", scripts / "lib.ms")}
    for name in ("link.bvh", "../my scripts/a.ms", "../my scripts/lib.ms"):
        assert say(f".save {name}").text.endswith("this file is read; the output needs another name\n")
    assert {path: path.read_bytes() for path in before} == before
    assert say(".undo", "WALK", ".save! ../my scripts/a.ms").ok


@pytest.mark.parametrize("name", ["mine.ms", "mine.bvh"])
def test_a_file_that_was_there_before_is_replaced_only_if_that_is_said(name: str, say: Say, scripts: Path) -> None:
    mine = scripts / name
    mine.write_text("# by hand\n", encoding="utf-8")
    reply = say("WALK", f".save {mine}")
    assert not reply.ok
    assert reply.text == f"error: {mine} is there already; `.save! {mine}` replaces it\n"
    assert reply.question is not None
    assert mine.read_text(encoding="utf-8") == "# by hand\n"
    assert say(f".save! {mine}").ok
    assert say("IDLE", f".save {mine}").ok
    mine.write_text("# by hand, again\n", encoding="utf-8")
    assert not say(f".save {mine}").ok
    assert mine.read_text(encoding="utf-8") == "# by hand, again\n"


def test_a_script_that_was_loaded_and_taken_back_is_not_lost(say: Say, scripts: Path) -> None:
    before = (scripts / "a.ms").read_bytes()
    assert not say(".load ../my scripts/a.ms", ".undo", "WALK", ".save ../my scripts/a.ms").ok
    assert (scripts / "a.ms").read_bytes() == before


@pytest.mark.parametrize("command", [".save", ".load", ".library"])
@pytest.mark.parametrize("path", ["~nobody-of-that-name/a.ms", "a\0b.ms"])
def test_what_no_file_can_be_called_is_refused(command: str, path: str, say: Say) -> None:
    say("WALK")
    assert say(f"{command} {path}").text.startswith("error: `")


def test_a_path_may_begin_with_the_user_s_folder(say: Say, scripts: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(scripts.parent))
    assert say(".load ~/my scripts/a.ms", ".save ~/here/x.bvh").ok
    assert Path("x.bvh").is_file()


def test_set_changes_how_motion_is_written(say: Say, tmp_path: Path) -> None:
    say("WALK for 1 sec", ".set fps 60", ".set blend linear", f".save {tmp_path / 'a.bvh'}")
    assert bvh.read(tmp_path / "a.bvh").frame_time_s == pytest.approx(1 / 60)
    assert say(".set").data == {"blend": "linear", "fps": 60.0, "feet": "on", "keys": "emacs"}
    assert say(".set fps library").data["fps"] == "library"


def test_view_shows_the_motion_so_far_with_its_report(say: Say, shown: list[tuple[Path, Path]]) -> None:
    assert say("WALK for 1 sec", ".view").text == "shown\n"
    ((motion, report),) = shown
    assert json.loads(report.read_text(encoding="utf-8"))["n_frames"] == len(bvh.read(motion).frames)


def test_time_says_how_long_a_line_took(say: Say) -> None:
    assert "took " in say(".time on", "WALK").text
    assert "took " not in say(".time off", "WALK").text


def test_another_start_and_other_draws_play_all_anew(say: Say, conversation: Conversation) -> None:
    say("WALK for 1 sec", ".start talk01")
    assert conversation.desk.session.starts_in == "Talk_01"
    say(".seed 3")
    assert (conversation.desk.session.starts_in, conversation.desk.session.seed) == ("Talk_01", 3)


@pytest.mark.parametrize("line", [".start talk01", ".seed 3", ".library"])
def test_what_plays_all_anew_can_be_taken_back_and_played_again(
    line: str, say: Say, conversation: Conversation, tmp_path: Path
) -> None:
    desk = conversation.desk
    say("WALK for 1 sec", f".save {tmp_path / 'a.bvh'}")
    old = desk.session
    say(line)
    new = desk.session
    assert new is not old
    assert say("IDLE", ".undo").data["text"] == "IDLE"
    assert say(".undo").data["text"] == line
    assert desk.session is old
    assert not desk.unsaved
    assert say(".redo").data["text"] == line
    assert desk.session is new
    assert say(".redo").data["text"] == "IDLE"
    assert not say(".undo", ".undo", ".undo", ".undo").ok
    assert desk.session is old


def test_as_many_entries_are_taken_back_and_played_again_as_is_said(say: Say, conversation: Conversation) -> None:
    say("WALK for 1 sec", "IDLE for 1 sec", ".start talk01", "TALK for 1 sec")
    reply = say(".undo 3")
    assert reply.data["texts"] == ["TALK for 1 sec", ".start talk01", "IDLE for 1 sec"]
    assert reply.text.count("took back: ") == 3
    assert [turn.text for turn in conversation.desk.session.turns] == ["WALK for 1 sec"]
    assert say(".redo 2").data["texts"] == ["IDLE for 1 sec", ".start talk01"]
    fewer = say(".redo 7")
    assert fewer.data["texts"] == ["TALK for 1 sec"]
    assert "there were only 1, not 7\n" in fewer.text
    assert len(say(".undo 99").data["texts"]) == 4
    assert conversation.desk.session.n_seconds == 0.0


def test_an_entry_after_a_start_was_taken_back_drops_it(say: Say, conversation: Conversation) -> None:
    say(".start talk01", ".undo", "WALK")
    assert not say(".redo").ok
    assert conversation.desk.session.starts_in == "Idle_01"
    assert say(".undo", ".redo").data["text"] == "WALK"


def test_a_library_that_changed_is_noticed_once_and_read_again_when_asked(
    conversation: Conversation, say: Say, tmp_path: Path, demo_library: Library
) -> None:
    path = tmp_path / "my.mlmg"
    shutil.copy(demo_library.path, path)
    conversation.desk.replace_session(Session(open_library(path)), ".library my.mlmg")
    say("WALK for 1 sec")
    assert not conversation.desk.library_changed
    shutil.copy(demo_library.path, tmp_path / "new.mlmg")
    assert not conversation.desk.has_to_tell_of_change()
    (tmp_path / "new.mlmg").replace(path)
    assert conversation.desk.library_changed
    assert [conversation.desk.has_to_tell_of_change() for _ in range(2)] == [True, False]
    assert toolbar(conversation.desk, 80).startswith(" my (changed)  ")
    reply = say(".library")
    assert reply.ok
    assert "played anew" in reply.text
    assert not conversation.desk.library_changed
    assert len(conversation.desk.session.turns) == 1
    say(".undo")
    assert conversation.desk.library_changed


def test_a_library_that_cannot_be_read_any_more_leaves_the_session_as_it_was(
    conversation: Conversation, say: Say, tmp_path: Path, demo_library: Library
) -> None:
    path = tmp_path / "my.mlmg"
    shutil.copy(demo_library.path, path)
    conversation.desk.replace_session(Session(open_library(path)), ".library my.mlmg")
    say("WALK for 1 sec")
    path.write_bytes(b"no library")
    assert not say(".library").ok
    assert say("WALK for 1 sec").ok


def test_white_space_may_stand_before_a_dot(say: Say) -> None:
    assert say("  .quit").leaves


def test_definitions_alone_are_not_asked_about(say: Say, conversation: Conversation) -> None:
    say("let A = WALK")
    assert not conversation.desk.unsaved


def test_quit_leaves(say: Say) -> None:
    assert say(".quit").leaves
