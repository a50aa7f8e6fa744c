"""Where definitions come from: the script itself, and the files that it uses, by way of others too."""

from __future__ import annotations

import posixpath
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import pytest

from mlmg_lang.definitions import gather
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.front_end import Analysis, analyse
from mlmg_lang.script_files import source_from_bytes
from mlmg_lang.source import Source


@dataclass
class Folder:
    """Files that are nowhere but here; `asked` tells which were looked for, and by whom."""

    files: Mapping[str, str | bytes]
    asked: list[tuple[str, str]] = field(default_factory=list)

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        self.asked.append((path, user))
        name = posixpath.normpath(posixpath.join(posixpath.dirname(user), path))
        if name not in self.files:
            return f"there is no {name}"
        data = self.files[name]
        return source_from_bytes(data if isinstance(data, bytes) else data.encode("utf-8"), name)


def read(files: Mapping[str, str | bytes], library: Any = None, script: str = "main.ms") -> Analysis:
    """Return the analysis of the script among some files."""
    text = files[script]
    assert isinstance(text, str)
    return analyse(Source(text, script), library, files=Folder(files))


def told(analysis: Analysis) -> list[tuple[str, str, int]]:
    """Return code, file and line of what is said."""
    found = []
    for one in analysis.diagnostics:
        assert one.span is not None
        file, _ = analysis.source.file(one.span.start)
        found.append((one.code, file.name, analysis.source.position(one.span.start)[0]))
    return found


# --- what can be used ---


@pytest.mark.parametrize("script", ['use "a.ms"\nA', 'A\nuse "a.ms"', 'use "a.ms"; A', 'A # first\n\nuse "./a.ms"'])
def test_the_definitions_of_a_used_file_can_be_used(script: str, reference: Any) -> None:
    analysis = read({"main.ms": script, "a.ms": "let A = WALK"}, reference)
    assert told(analysis) == []
    assert analysis.resolved is not None
    assert len(analysis.resolved.statements) == 1


def test_those_of_a_file_that_a_used_one_uses_can_be_used_too(reference: Any) -> None:
    files = {"main.ms": 'use "a.ms"\nB with A', "a.ms": 'use "b.ms"\nlet A = Upper-Body B', "b.ms": "let B = TALK"}
    assert told(read(files, reference)) == []


def test_a_used_file_may_use_what_the_script_defines(reference: Any) -> None:
    files = {"main.ms": 'use "a.ms"\nlet B = TALK\nWALK with A', "a.ms": "let A = Upper-Body B"}
    assert told(read(files, reference)) == []


def test_what_a_used_file_does_is_left_out(reference: Any) -> None:
    files = {"main.ms": 'use "a.ms"\nA for 1 sec', "a.ms": "let A = WALK\nNOBODY for 2 sec\nrepeat 2 { TALK }"}
    analysis = read(files, reference)
    assert told(analysis) == []
    assert analysis.resolved is not None
    assert len(analysis.resolved.statements) == 1


def test_what_a_used_file_defines_in_vain_is_not_told() -> None:
    assert told(read({"main.ms": 'use "a.ms"\nA', "a.ms": "let A = WALK\nlet B = TALK"})) == []


def test_a_path_is_from_the_folder_of_the_file_that_names_it() -> None:
    files = {
        "plays/main.ms": 'use "../moves/a.ms"\nB',
        "moves/a.ms": 'use "deep/b.ms"',
        "moves/deep/b.ms": 'use "../c.ms"',
        "moves/c.ms": "let B = WALK",
    }
    folder = Folder(files)
    analysis = analyse(Source('use "../moves/a.ms"\nB', "plays/main.ms"), files=folder)
    assert told(analysis) == []
    assert folder.asked == [
        ("../moves/a.ms", "plays/main.ms"),
        ("deep/b.ms", "moves/a.ms"),
        ("../c.ms", "moves/deep/b.ms"),
    ]


def test_a_file_that_is_used_by_several_is_read_once() -> None:
    files = {
        "main.ms": 'use "a.ms"\nuse "b.ms"\nuse "./a.ms"\nA with B with C',
        "a.ms": 'use "c.ms"\nlet A = WALK',
        "b.ms": 'use "c.ms"\nlet B = WALK',
        "c.ms": "let C = WALK",
    }
    analysis = read(files)
    assert told(analysis) == []
    assert [file.name for file in analysis.source.used] == ["a.ms", "c.ms", "b.ms"]


def test_a_use_in_a_body_is_not_followed() -> None:
    files = {"main.ms": 'repeat 2 { use "a.ms"; A }', "a.ms": "let A = WALK for 0 sec"}
    analysis = read(files)
    assert told(analysis) == [("MS015", "main.ms", 1)]
    assert analysis.source.used == ()


# --- what is wrong ---


def test_a_file_that_cannot_be_used_is_one_mistake(reference: Any) -> None:
    analysis = read({"main.ms": 'use "a.ms"\nA with Upper-Body B(WALK, C)\nend Upper-Body\nTALK'}, reference)
    (one,) = analysis.diagnostics
    assert (one.code, one.message) == ("MS058", "there is no a.ms")
    assert one.span is not None
    assert analysis.source.slice(one.span) == '"a.ms"'
    assert not analysis.definitions.complete


def test_a_file_that_is_no_text_cannot_be_used() -> None:
    (one,) = read({"main.ms": 'use "a.ms"\nA', "a.ms": b"let A = \xff"}).diagnostics
    assert (one.code, one.help) == ("MS058", "save it as UTF-8")
    assert one.message == "`a.ms`: this file is not UTF-8: byte 0xFF cannot stand here"


@pytest.mark.parametrize(
    ("files", "place", "way"),
    [
        ({"main.ms": 'use "main.ms"'}, ("main.ms", 1), "`main.ms` -> `main.ms`"),
        ({"main.ms": 'use "a.ms"', "a.ms": '\nuse "main.ms"'}, ("a.ms", 2), "`main.ms` -> `a.ms` -> `main.ms`"),
        ({"main.ms": 'use "a.ms"', "a.ms": 'use "a.ms"'}, ("a.ms", 1), "`a.ms` -> `a.ms`"),
        (
            {"main.ms": 'use "a.ms"', "a.ms": 'use "b.ms"', "b.ms": 'use "c.ms"', "c.ms": 'use "a.ms"'},
            ("c.ms", 1),
            "`a.ms` -> `b.ms` -> `c.ms` -> `a.ms`",
        ),
    ],
)
def test_files_that_use_each_other_in_a_circle_are_told_the_way(
    files: dict[str, str], place: tuple[str, int], way: str
) -> None:
    analysis = read(files)
    assert told(analysis) == [("MS059", *place)]
    assert analysis.diagnostics[0].message == f"these files use each other in a circle: {way}"
    assert not analysis.definitions.complete


def test_a_name_that_two_files_define_is_a_mistake_in_the_second() -> None:
    files = {"main.ms": 'A\nuse "a.ms"', "a.ms": 'let A = WALK\nuse "b.ms"', "b.ms": "let B = TALK\nlet A = TALK"}
    analysis = read(files)
    assert told(analysis) == [("MS050", "b.ms", 2)]
    (note,) = analysis.diagnostics[0].notes
    assert note.span is not None
    assert analysis.source.file(note.span.start)[0].name == "a.ms"
    assert analysis.source.slice(note.span) == "A"


def test_the_scripts_own_definition_comes_first() -> None:
    files = {"main.ms": 'use "a.ms"\nA for 1 sec\nlet A = WALK', "a.ms": "let A = TALK"}
    assert told(read(files)) == [("MS050", "a.ms", 1)]


def test_names_are_the_same_in_any_form_of_their_letters() -> None:
    assert told(read({"main.ms": "caf\u00e9\nlet caf\u00e9 = WALK\nlet cafe\u0301 = TALK"})) == [
        ("MS050", "main.ms", 3)
    ]
    assert told(read({"main.ms": 'A\nlet A = WALK\nlet "A" = TALK'})) == [("MS050", "main.ms", 3)]


def test_what_is_wrong_in_a_used_file_is_told_there(reference: Any) -> None:
    files = {
        "main.ms": 'use "a.ms"\nuse "b.ms"\nA for 1 sec\nWALK with B for 1 sec',
        "a.ms": "# 走\nlet A = WALK\nlet C = WLAK\n\nlet D = A with",
        "b.ms": "let B(x) = Upper-Body TALK\nlet F = not (WALK with TALK); let G = WALK for 0 sec",
    }
    assert told(read(files, reference)) == [
        ("MS055", "main.ms", 4),
        ("MS021", "a.ms", 3),
        ("MS014", "a.ms", 5),
        ("MS034", "b.ms", 2),
        ("MS045", "b.ms", 2),
    ]


def test_a_used_file_may_not_define_what_is_a_graph(reference: Any) -> None:
    files = {"main.ms": 'use "a.ms"\nWALK', "a.ms": "let Upper-Body = WALK\nlet TALK = WALK"}
    assert told(read(files, reference)) == [("MS052", "a.ms", 1), ("MS053", "a.ms", 2)]


# --- how many ---


def test_a_script_may_use_a_hundred_files() -> None:
    uses = "\n".join(f'use "a{n}.ms"' for n in range(gather.MAX_FILES))
    files = {f"a{n}.ms": f"let A{n} = WALK" for n in range(gather.MAX_FILES + 1)}
    assert told(read({"main.ms": f"{uses}\nA99", **files})) == []
    analysis = read({"main.ms": f'{uses}\nuse "a100.ms"\nA100', **files})
    assert told(analysis) == [("MS058", "main.ms", gather.MAX_FILES + 1)]


def test_a_long_way_of_uses_ends() -> None:
    files = {f"a{n}.ms": f'use "a{n + 1}.ms"' for n in range(5_000)}
    assert told(read({"main.ms": 'use "a0.ms"', **files})) == [("MS058", f"a{gather.MAX_FILES - 1}.ms", 1)]


def test_without_files_nothing_can_be_used() -> None:
    (one,) = analyse(Source('use "a.ms"')).diagnostics
    assert one.message == "this text is not a file in a folder, from which `a.ms` could be found"


def test_a_path_that_is_no_name_is_told_once() -> None:
    assert [one.code for one in analyse(Source('use ""')).diagnostics] == ["MS004"]
    assert [one.code for one in analyse(Source('use "a\\b.ms"')).diagnostics] == ["MS004"]
    assert [one.code for one in analyse(Source('use "a.ms')).diagnostics] == ["MS002"]
