from __future__ import annotations

from pathlib import Path

import pytest

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.rendering import render_github
from mlmg_lang.source import Source, Span


def test_a_diagnostic_is_a_command_with_its_place_and_its_help() -> None:
    one = Diagnostic("MS021", "no tag or motion `WLAK` in this library", Span(5, 9), "there is `WALK`")
    assert render_github([(Source("IDLE\nWLAK for 10 sec", "stroll.ms"), [one])]) == (
        "::error file=stroll.ms,line=2,endLine=2,col=1,endColumn=5,title=MS021%3A an unknown name"
        "::no tag or motion `WLAK` in this library%0Ahelp: there is `WALK`\n"
    )


@pytest.mark.parametrize(("code", "command"), [("MS021", "error"), ("MS043", "warning"), ("MS047", "notice")])
def test_a_severity_is_what_github_calls_it(code: str, command: str) -> None:
    assert render_github([(Source("A"), [Diagnostic(code, "m", Span(0, 1))])]).startswith(f"::{command} ")


def test_a_place_over_lines_has_no_columns_which_github_would_refuse() -> None:
    told = render_github([(Source("A\nB", "a.ms"), [Diagnostic("MS032", "m", Span(0, 3))])])
    assert told.startswith("::error file=a.ms,line=1,endLine=2,title=")


def test_without_a_place_the_file_alone_is_named() -> None:
    assert render_github([(Source("A", "a.ms"), [Diagnostic("MS044", "m", None)])]).startswith(
        "::error file=a.ms,title="
    )


def test_what_would_end_a_property_or_a_command_is_escaped() -> None:
    source = Source("A", "a,b:c%.ms")
    told = render_github([(source, [Diagnostic("MS021", "100 % `::`, so", Span(0, 1))])])
    assert told.startswith("::error file=a%2Cb%3Ac%25.ms,line=")
    assert told.endswith("::100 %25 `::`, so\n")


def test_files_are_named_from_the_current_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "scripts").mkdir()
    monkeypatch.chdir(tmp_path / "scripts")
    names = [str(tmp_path / "scripts" / "a.ms"), str(tmp_path / "b.ms"), "x/../c.ms", "<stdin>"]
    told = render_github([(Source("A", name), [Diagnostic("MS021", "m", Span(0, 1))]) for name in names])
    files = [line.split("file=")[1].split(",")[0] for line in told.splitlines()]
    assert files == ["a.ms", (tmp_path / "b.ms").as_posix(), "c.ms", "<stdin>"]
