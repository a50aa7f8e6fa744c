"""A script as people write them, after slips that people make: each is told once, and mended where that is certain."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest

from mlmg_lang.definitions.gather import Files
from mlmg_lang.diagnostics import Diagnostic, Severity
from mlmg_lang.fixing import fix_all
from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.source import Source

GESTURES = """\
let GREETING = Upper-Body WAVE_HAND
let EXPLAIN(x) = x with Upper-Body (TALK and not IDLE)
"""
VISIT = """\
use "gestures.ms"

# A visit.
let STROLL = WALK and not Walk_03
let CHAT(legs, t = 2 sec) = legs with Upper-Body TALK for t
let REST = IDLE and not Music and not Idle_02

REST for 1 sec
STROLL for 3 sec
GREETING for 1 sec

repeat 2 {
  CHAT(REST)
  STROLL for 2 sec
  repeat 3 {
    SWING_HAND for 1 sec
    EXPLAIN(WALK) for 2 sec
  }
  REST for 1 sec
}

choose {
  3: STROLL for 2 sec
     TALK for 1 sec
| 1: CHAT(STROLL, t = 3 sec)
|    Music for 2 sec
}

WALK with Upper-Body (TALK
    and not IDLE)
  for 4 sec

let LEAVE = STROLL
repeat 2 {
  CHAT(legs = STROLL)
  GREETING for 1 sec
}

STROLL for 2 sec
GREETING for 1 sec
end Upper-Body
wait 2 sec
LEAVE
"""
MENDED = {
    "a block in a block without its end": ("    EXPLAIN(WALK) for 2 sec\n  }\n", "    EXPLAIN(WALK) for 2 sec\n"),
    "a block around a block without its end": ("  REST for 1 sec\n}\n", "  REST for 1 sec\n"),
    "the last block without its end": ("  GREETING for 1 sec\n}\n", "  GREETING for 1 sec\n"),
    "a choice without its end": ("|    Music for 2 sec\n}\n", "|    Music for 2 sec\n"),
    "one } too many in a block": ("  REST for 1 sec\n}", "  }\n  REST for 1 sec\n}"),
    "one } too many at the end": ("LEAVE\n", "LEAVE\n}\n"),
    "one ) too many": ("EXPLAIN(WALK) for", "EXPLAIN(WALK)) for"),
    "( closed by }": ("(legs = STROLL)", "(legs = STROLL}"),
    "} in parentheses": ("EXPLAIN(WALK)", "EXPLAIN(WALK })"),
    "{ closed by )": ("  GREETING for 1 sec\n}", "  GREETING for 1 sec\n)"),
    "( in place of {": ("repeat 3 {", "repeat 3 ("),
    "no { behind repeat": ("repeat 3 {", "repeat 3"),
    "no { behind choose": ("choose {", "choose"),
    "two {": ("repeat 3 {", "repeat 3 {{"),
    "{ behind a command": ("  STROLL for 2 sec\n", "  STROLL for 2 sec {\n"),
    "{ on a line of its own": ("repeat 3 {", "repeat 3\n  {"),
    "{ before the number": ("repeat 3 {", "repeat { 3"),
    "{ before choose": ("choose {", "{ choose"),
    "CHOOSE": ("choose {", "CHOOSE {"),
    "[ ]": ("EXPLAIN(WALK)", "EXPLAIN[WALK]"),
    "or in place of |": ("| 1:", "or 1:"),
    "a negative weight": ("3:", "-3:"),
    "a definition with another name": ("let STROLL =", "let AMBLE ="),
    "a definition misspelt": ("let STROLL =", "let STORLL ="),
    "a definition with parameters, with another name": ("let CHAT(", "let SPEAK("),
    "a parameter with another name": ("let CHAT(legs,", "let CHAT(body,"),
    "a duration with another name": ("t = 2 sec)", "time = 2 sec)"),
    "a use misspelt": ("REST for 1 sec\n}", "RSET for 1 sec\n}"),
    "use misspelt": ('use "', 'ues "'),
    "USE": ('use "', 'USE "'),
    "import": ('use "', 'import "'),
    "the file without its quote": ('"gestures.ms"', '"gestures.ms'),
    "the file in printed quotes": ('"gestures.ms"', '"gestures.ms\u201d'),
    "a name without its quote": ("STROLL for 3 sec", '"STROLL for 3 sec'),
    "no =": ("let REST = ", "let REST "),
    "def": ("let REST", "def REST"),
    "loop": ("repeat 3 {", "loop 3 {"),
    "no comma between parameters": ("(legs, t", "(legs t"),
    "a word before a parameter": ("(legs, t", "(legs, the t"),
}
TOLD = {
    "one } too many in a choice": ("     TALK for 1 sec\n|", "     TALK for 1 sec }\n|"),
    "a definition without a name": ("let STROLL =", "let ="),
    "a definition with parameters without a name": ("let CHAT(", "let ("),
    "{ in a definition": ("let CHAT(", "let CHAT {("),
    "{ behind a definition": ("= legs with Upper-Body TALK for t", "= legs with Upper-Body TALK for t {"),
    "; in a definition": ("let CHAT(", "let CHAT ;("),
    "a definition that lacks a motion": ("not Music and not Idle_02", "not"),
    "words behind choose": ("choose {", "choose one {"),
    "a loop with a condition": (
        "  repeat 3 {\n    SWING_HAND for 1 sec\n    EXPLAIN(WALK) for 2 sec\n  }",
        "  do {\n    SWING_HAND for 1 sec\n  } while",
    ),
    "a loop with a condition in one line": ("REST for 1 sec\nSTROLL", "do { REST } until STROLL\nSTROLL"),
}


class Folder:
    """The one file that the script uses."""

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        return (Source(GESTURES, path), ()) if path == "gestures.ms" else f"there is no file `{path}`"


def errors(text: str, library: Any, files: Files | None = None) -> list[Diagnostic]:
    found = analyse(Source(text), library, None, files or Folder()).diagnostics
    return [one for one in found if one.severity is Severity.ERROR]


def slipped(slip: tuple[str, str]) -> str:
    right, wrong = slip
    assert right in VISIT
    return VISIT.replace(right, wrong, 1)


def test_the_script_is_right(libraries: Mapping[str, Any]) -> None:
    assert errors(VISIT, libraries["reference"]) == []


@pytest.mark.parametrize(
    "text",
    [
        "repeat 1{sec}",
        "let F(a, b) = a with b\nA ;(F(A, B))\nrepeat 2 { A }(F(a = A, b = B)) for 1 sec",
        "repeat 2 {\n  A } B\nchoose { 3:A|B }",
        "choose { repeat 2 { A } | 2: choose { B } }",
    ],
)
def test_what_only_looks_like_a_slip_is_right(text: str) -> None:
    assert errors(text, None) == []


@pytest.mark.parametrize("name", [*MENDED, *TOLD])
def test_a_slip_is_told_once(name: str, libraries: Mapping[str, Any]) -> None:
    (one,) = errors(slipped((MENDED | TOLD)[name]), libraries["reference"])
    assert one.span is not None


@pytest.mark.parametrize("name", MENDED)
def test_the_edit_that_is_offered_mends_a_slip(name: str, libraries: Mapping[str, Any]) -> None:
    library, source = libraries["reference"], Source(slipped(MENDED[name]))

    def diagnose(text: Source) -> tuple[Source, tuple[Diagnostic, ...]]:
        analysis = analyse(text, library, None, Folder())
        return analysis.source, analysis.diagnostics

    _, told = diagnose(source)
    assert fix_all(source, told, diagnose, unsafe=True).n_fixed == 1
    assert errors(fix_all(source, told, diagnose, unsafe=True).source.text, library) == []


@pytest.mark.parametrize("name", [*MENDED, *TOLD])
def test_a_slip_is_told_the_same_as_it_is_made(name: str, libraries: Mapping[str, Any]) -> None:
    """Without the file, whose use would have all analysed afresh."""
    library, (right, wrong) = libraries["reference"], (MENDED | TOLD)[name]
    text = VISIT.replace('use "gestures.ms"\n', GESTURES)
    before, after = Source(text), Source(text.replace(right, wrong, 1))
    again = analyse_again(analyse(before, library, None, Folder()), after)
    assert again.diagnostics == analyse(after, library, None, Folder()).diagnostics
    assert analyse_again(again, before).diagnostics == analyse(before, library, None, Folder()).diagnostics
