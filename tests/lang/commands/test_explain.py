"""mlmg explain: where it reads, what it writes, how it ends."""

from __future__ import annotations

import io
import json
import sys

import pytest

from mlmg_lang.commands import mlmg
from mlmg_lang.explaining.plan_json import plan_from_json

SCRIPT = "Stand for 1 sec\nWALK for 2 sec\nWALK with Upper-Body TALK for 1 sec\n"


@pytest.fixture
def scene(built):
    (built / "scene.ms").write_text(SCRIPT, encoding="utf-8")
    return built


def explained(*options: str, script: str = "scene.ms") -> int:
    return mlmg.main(["explain", script, "--library", "my.mlmg", *options])


def test_it_tells_what_a_script_will_do(scene, capsys):
    assert explained() == 0
    out = capsys.readouterr().out
    assert out.startswith("scene.ms: 3 commands from Stand on, ")
    assert "line 2  WALK for 2 sec" in out
    assert "└─ played" not in out
    assert "\x1b" not in out


def test_with_analyze_it_tells_what_happened_too(scene, capsys):
    assert explained("--analyze", "--seed", "4") == 0
    out = capsys.readouterr().out
    assert "played with seed 4: " in out
    assert "played at 1.0 s: arrived after " in out


def test_what_it_tells_of_having_played_is_what_mlmgc_plays(scene, capsys):
    from mlmg_lang.commands import mlmgc

    assert mlmgc.main(["scene.ms", "--library", "my.mlmg", "-o", "out.bvh", "--report", "out.json"]) == 0
    report = json.loads((scene / "out.json").read_text(encoding="utf-8"))
    capsys.readouterr()
    assert explained("--analyze", "--format", "json") == 0
    plan = plan_from_json(capsys.readouterr().out)
    for statement, command in zip(plan.statements, report["commands"], strict=True):
        (went,) = statement.executions
        assert went.begin_s == pytest.approx(command["begin"] / 30, abs=1e-3)
        assert went.arrived_s == pytest.approx((command["arrive"] - command["begin"]) / 30, abs=1e-3)
        assert {one.graph: one.motion for one in went.taken} == command["motions"]
    assert plan.played.seconds == pytest.approx(report["n_frames"] / 30, abs=1e-3)


@pytest.mark.parametrize(("form", "begin"), [("text", "scene.ms: 3"), ("json", "{"), ("mermaid", "flowchart TD")])
def test_each_format_goes_to_standard_output_or_a_file(form, begin, scene, capsys):
    assert explained("--format", form) == 0
    out = capsys.readouterr().out
    assert out.startswith(begin)
    assert explained("--format", form, "-o", "told") == 0
    assert (scene / "told").read_text(encoding="utf-8") == out
    assert capsys.readouterr().out == ""


def test_a_script_may_come_from_standard_input(scene, capsys, monkeypatch):
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(SCRIPT.encode())))
    assert explained(script="-") == 0
    assert capsys.readouterr().out.startswith("<stdin>: 3 commands")


def test_it_may_start_elsewhere(scene, capsys):
    assert explained("--start", "Reach") == 0
    assert "start: Reach at its first frame, as --start says" in capsys.readouterr().out


def test_it_can_plan_over_the_whole_script(scene, capsys):
    assert explained("--plan", "global", "--analyze") == 0
    out = capsys.readouterr().out
    assert "planned over the whole script: seconds on the way and costs come to " in out
    assert "command by command, played with seed 0: " in out


def test_errors_in_a_script_are_drawn_and_nothing_is_told(scene, capsys):
    (scene / "scene.ms").write_text("WLAK for 2 sec\n", encoding="utf-8")
    assert explained("-o", "told") == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "error[MS021]" in captured.err
    assert "  --> scene.ms:1:1" in captured.err
    assert not (scene / "told").exists()


def test_hints_are_drawn_and_the_script_is_explained(scene, capsys):
    (scene / "scene.ms").write_text("walk for 2 sec\n", encoding="utf-8")
    assert explained() == 0
    captured = capsys.readouterr()
    assert "hint[MS020]" in captured.err
    assert "walk: tag WALK on Full-Body" in captured.out


def test_an_empty_script_is_an_error(scene, capsys):
    (scene / "scene.ms").write_text("# nothing\n", encoding="utf-8")
    assert explained() == 1
    assert "scene.ms: there is nothing to play" in capsys.readouterr().err


def test_bytes_that_are_no_text_are_an_error(scene, capsys):
    (scene / "scene.ms").write_bytes(b"WALK \xff")
    assert explained() == 1
    assert "error[MS001]" in capsys.readouterr().err


@pytest.mark.parametrize("output", ["scene.ms", "my.mlmg"])
def test_what_is_read_is_not_overwritten(output, scene, capsys):
    before = (scene / output).read_bytes()
    assert explained("-o", output) == 2
    assert "the output needs another name" in capsys.readouterr().err
    assert (scene / output).read_bytes() == before


def test_a_file_that_cannot_be_opened_is_wrong_usage(scene, capsys):
    assert explained(script="none.ms") == 2
    assert "none.ms" in capsys.readouterr().err
    assert explained("-o", "none/told") == 2


def test_definitions_of_other_folders_need_leave(scene, capsys, tmp_path_factory):
    other = tmp_path_factory.mktemp("other")
    (other / "gestures.ms").write_text("let STROLL = WALK\n", encoding="utf-8")
    (scene / "scene.ms").write_text(f'use "{(other / "gestures.ms").as_posix()}"\nSTROLL for 1 sec\n', encoding="utf-8")
    assert explained() == 1
    assert explained("--allow-use", str(other)) == 0
    assert "STROLL: defined in " in capsys.readouterr().out


def test_without_a_library_it_takes_the_demo_library_and_says_so(folder, demo_library, capsys, monkeypatch):
    monkeypatch.setenv("MLMG_CACHE", str(demo_library.path.parent))
    (folder / "scene.ms").write_text("WALK for 1 sec\n", encoding="utf-8")
    assert mlmg.main(["explain", "scene.ms"]) == 0
    captured = capsys.readouterr()
    assert captured.err.splitlines() == [
        "mlmg explain: no library is named (--library, MLMG_LIBRARY, mlmg.toml): playing on the demo library"
    ]
    assert "demo" in captured.out


def test_colours_are_for_terminals(scene, capsys, monkeypatch):
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True, raising=False)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert explained() == 0
    assert "\x1b[1m" in capsys.readouterr().out
    assert explained("--format", "json") == 0
    assert "\x1b" not in capsys.readouterr().out
    monkeypatch.setenv("NO_COLOR", "1")
    assert explained() == 0
    assert "\x1b" not in capsys.readouterr().out
