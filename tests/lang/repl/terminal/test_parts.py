"""What the prompt shows: colours, underlines, the menu, the toolbar, and what it remembers."""

import random
from collections.abc import Callable
from pathlib import Path

import pytest
from prompt_toolkit.completion import CompleteEvent
from prompt_toolkit.document import Document

from mlmg_lang.explaining.tree import n_columns
from mlmg_lang.repl.conversation import Conversation
from mlmg_lang.repl.reply import Reply
from mlmg_lang.repl.terminal.completing import ScriptCompleter
from mlmg_lang.repl.terminal.history import history_path, library_name, uses_of
from mlmg_lang.repl.terminal.marking import MOST_CHECKED, MOST_COLOURED, ScriptLexer
from mlmg_lang.repl.terminal.toolbar import toolbar

Say = Callable[..., Reply]


@pytest.fixture
def menu(conversation: Conversation) -> Callable[[str], list[tuple[str, str]]]:
    """Return a function: what is typed -> what the menu shows, each with what it says."""

    def ask(text: str) -> list[tuple[str, str]]:
        found = ScriptCompleter(conversation.desk).get_completions(Document(text), CompleteEvent())
        return [(one.text, one.display_meta_text) for one in found]

    return ask


def test_the_menu_shows_graph_motions_seconds_and_rank(menu: Callable[[str], list[tuple[str, str]]]) -> None:
    shown = dict(menu("IDLE with Upper-Body T"))
    assert shown["TALK"] == "Upper-Body  2 motions, 22 s  1. OMS 0.19"
    assert dict(menu("W"))["WALK"].startswith("Full-Body  3 motions, 34 s  1. in ")
    assert dict(menu("I"))["Idle_01"].endswith("starts in it")


def test_commands_with_a_dot_are_completed_with_what_they_take(
    menu: Callable[[str], list[tuple[str, str]]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert menu(".ca")[0][0] == ".candidates"
    assert [text for text, _ in menu(".motions ")] == ["Full-Body", "Upper-Body", "Left-Hand"]
    assert [text for text, _ in menu(".oms wave")] == ["Wave_01"]
    assert "TALK" in [text for text, _ in menu(".candidates WALK with Upper-Body T")]
    assert [text for text, _ in menu(".set keys ")] == ["keys emacs", "keys vi"]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "walk.ms").touch()
    (tmp_path / "walk.txt").touch()
    (tmp_path / "scripts").mkdir()
    assert [text for text, _ in menu(".load ")] == ["scripts/", "walk.ms"]


def test_the_menu_follows_what_is_played(menu: Callable[[str], list[tuple[str, str]]], say: Say) -> None:
    say("Idle_01")
    assert dict(menu("I"))["Idle_01"].endswith("plays")
    assert "Upper-Body" in [text for text, _ in menu("Up")]
    say("Idle_02")
    assert "Upper-Body" not in [text for text, _ in menu("Up")]


def pieces(conversation: Conversation, text: str, at: int | None = None) -> list[tuple[str, str]]:
    """Return the pieces of the first line, each with its style."""
    document = Document(text, len(text) if at is None else at)
    return [(style, part) for style, part, *_ in ScriptLexer(conversation.desk).lex_document(document)(0)]


def test_tokens_are_coloured_and_all_letters_are_there(conversation: Conversation) -> None:
    found = pieces(conversation, "WALK with Upper-Body TALK for 3 sec # so")
    assert ("class:word", "with") in found
    assert ("class:graph", "Upper-Body") in found
    assert ("class:unit", "sec") in found
    draw = random.Random(1)
    letters = ["WALK", " ", "with", "(", ")", "{", "}", '"', "\n", "走", "😀", "for", "3", "sec", "#", ";", "let", "="]
    for _ in range(300):
        text = "".join(draw.choices(letters, k=draw.randrange(12)))
        document = Document(text, draw.randrange(len(text) + 1))
        lines = ScriptLexer(conversation.desk).lex_document(document)
        assert ["".join(piece[1] for piece in lines(n)) for n in range(len(document.lines))] == document.lines


def test_what_is_wrong_is_underlined_while_it_is_typed_but_not_the_word_at_the_cursor(
    conversation: Conversation,
) -> None:
    assert ("class:name class:error", "WLAK") in pieces(conversation, "WLAK for 3 sec")
    assert ("class:name", "WLAK") in pieces(conversation, "WLAK")
    assert ("class:name class:error", "WLAK") in pieces(conversation, "WLAK; WALK", 10)


@pytest.mark.parametrize(
    "text",
    [
        *("WALK with Upper-Body ", "WALK with ", "WALK for ", "WALK for 3 ", "wait ", "repeat ", "repeat 3 ", "let A "),
        *("repeat 3 { WALK for 1 sec; ", "choose { WALK | ", "(WALK and IDLE ", "end ", "repeat 3 {\n", "let A = "),
    ],
)
def test_what_may_still_be_finished_is_not_underlined_but_is_if_more_stands_behind_it(
    text: str, conversation: Conversation
) -> None:
    def errors(text: str, at: int) -> bool:
        lines = ScriptLexer(conversation.desk).lex_document(Document(text, at))
        return any("class:error" in piece[0] for n in range(text.count("\n") + 1) for piece in lines(n))

    assert not errors(text, len(text))
    assert errors(f"{text}\nWALK for", len(text)) or "{" in text
    assert errors(f"WLAK; {text}", len(text) + 6)


def test_what_is_wrong_is_underlined_in_the_line_where_it_is(conversation: Conversation) -> None:
    text = "repeat 2 {\n  WLAK for 1 sec\n}\nWALK"
    lines = ScriptLexer(conversation.desk).lex_document(Document(text, len(text)))
    marked = [[part for style, part, *_ in lines(n) if "class:error" in style] for n in range(4)]
    assert marked == [[], ["WLAK"], [], []]


@pytest.mark.parametrize(("n", "coloured"), [(MOST_CHECKED, True), (MOST_COLOURED, False)])
def test_a_very_long_text_is_coloured_or_only_shown_but_not_checked(
    n: int, coloured: bool, conversation: Conversation, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = "WLAK for 1 sec\n" * (n // 15 + 1)
    monkeypatch.setattr(conversation.desk.session.__class__, "analyse", lambda *_: pytest.fail("checked"))
    lines = ScriptLexer(conversation.desk).lex_document(Document(text, len(text)))
    assert "".join(piece[1] for piece in lines(3)) == "WLAK for 1 sec"
    assert (len(lines(3)) > 1) == coloured


def test_the_toolbar_tells_library_motions_seconds_and_what_is_not_saved(conversation: Conversation, say: Say) -> None:
    assert toolbar(conversation.desk, 80) == " demo  Full-Body Idle_01:0  0.0 s"
    say("WALK with Upper-Body TALK for 1 sec")
    told = toolbar(conversation.desk, 100)
    assert told.startswith(" demo  Full-Body Walk_")
    assert "Upper-Body Talk_01:" in told
    assert told.endswith(" s  unsaved")
    for width in range(5, 100):
        assert n_columns(toolbar(conversation.desk, width)) <= max(width, 20)
    assert "unsaved" in toolbar(conversation.desk, 30)


def test_history_is_kept_by_library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MLMG_HISTORY", str(tmp_path))
    one, other = history_path(tmp_path / "a" / "my.mlmg"), history_path(tmp_path / "b" / "my.mlmg")
    assert one != other
    assert one.parent == tmp_path
    assert library_name(tmp_path / "my.mlmg") == "my"


def test_names_are_counted_as_they_were_used() -> None:
    assert uses_of(["WALK for 3 sec", 'WALK with "hand on hip"'])["WALK"] == 2
    assert uses_of(['"hand on hip"'])["hand on hip"] == 1
