"""`mlmg rule` as a user calls it."""

from __future__ import annotations

import json

import pytest

from mlmg_lang.commands import mlmg
from mlmg_lang.diagnostics import CODES
from mlmg_lang.rules import read_rule


def test_without_a_code_all_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["rule"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(CODES)
    assert "MS043  warning  the end of a part that does not run on its own" in lines


def test_a_code_is_told_with_its_examples(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["rule", "MS016"]) == 0
    assert (
        capsys.readouterr().out
        == """\
error[MS016]: a duration without a unit, or with an unknown one

A number has no unit of time behind it, or one that does not exist. The units are `sec`, `ms`,
`min`, `frames` and `cycles`.

Ten what? Seconds are likely, but a script that was meant in frames would be thirty times as long.

Wrong:

    WALK for 10

What is said of it:

    error[MS016]: `10` of what? The unit is missing
      --> example.ms:1:10
       |
     1 | WALK for 10
       |          ^^
       = help: for seconds, write `10 sec`

Right:

    WALK for 10 sec
"""
    )


@pytest.mark.parametrize("written", ["MS021", "ms021", "Ms021", "21", "021", "ms21", "MS21"])
def test_a_code_may_be_written_in_any_case_or_as_its_number(written: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["rule", written]) == 0
    assert capsys.readouterr().out.startswith("error[MS021]: an unknown name\n")


def test_several_codes_are_told_one_after_the_other(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["rule", "MS047", "MS012"]) == 0
    out = capsys.readouterr().out
    assert 0 == out.index("hint[MS047]: ") < out.index("\n\nerror[MS012]: ")


def test_an_unknown_code_is_answered_with_those_like_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["rule", "MS0021"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("mlmg rule: error: there is no code `MS0021`; did you mean MS0")
    assert "MS021" in err
    assert mlmg.main(["rule", "stroll"]) == 2
    assert capsys.readouterr().err == "mlmg rule: error: there is no code `stroll`; `mlmg rule` lists all\n"


@pytest.mark.parametrize("option", [["--json"], ["--format", "json"]])
def test_json_has_all_that_is_told(option: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["rule", *option, "ms021"]) == 0
    (entry,) = json.loads(capsys.readouterr().out)
    text = read_rule("MS021")
    assert entry == {
        "code": "MS021",
        "severity": "error",
        "title": CODES["MS021"].title,
        "meaning": text.meaning,
        "why": text.why,
        "wrong": "WLAK for 10 sec\n",
        "told": text.told,
        "right": "WALK for 10 sec\n",
    }


def test_json_without_a_code_has_all(capsys: pytest.CaptureFixture[str]) -> None:
    assert mlmg.main(["rule", "--json"]) == 0
    assert [entry["code"] for entry in json.loads(capsys.readouterr().out)] == list(CODES)
