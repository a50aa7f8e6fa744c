"""mlmg build and mlmg info, on a folder of clips."""

import csv
import io
import json
import sys

import pytest

from mlmg_lang.commands import mlmg, mlmgc
from mlmg_lang.commands.console import ProgressLine


def test_building_says_on_standard_error_what_came_of_it(folder, capsys):
    assert mlmg.main(["build", "library.toml", "-o", "my.mlmg", "--jobs", "2"]) == 0
    out, err = capsys.readouterr()
    assert out == ""
    assert err.splitlines()[-1].startswith("my.mlmg: 3 clips, 270 frames, 2 graphs, ")


def test_without_an_output_the_library_is_written_beside_its_configuration(folder):
    assert mlmg.main(["build", "library.toml"]) == 0
    assert (folder / "library.mlmg").exists()


def test_building_twice_gives_the_same_bytes(built):
    assert mlmg.main(["build", "library.toml", "-o", "again.mlmg", "--jobs", "1"]) == 0
    assert (built / "my.mlmg").read_bytes() == (built / "again.mlmg").read_bytes()


def test_a_mistake_in_the_configuration_is_one_line_with_file_and_line(folder, capsys):
    (folder / "library.toml").write_text('[library]\nclips = ["*.bvh"]\nstrat = "Stand"\n', encoding="utf-8")
    assert mlmg.main(["build", "library.toml", "-o", "my.mlmg"]) == 1
    assert capsys.readouterr().err == (
        "mlmg build: error: library.toml:3: unknown key `strat`; "
        "expected one of clips, frame_rate, up, start; did you mean `start`?\n"
    )
    assert not (folder / "my.mlmg").exists()


def test_a_damaged_clip_leaves_the_old_library_as_it_is(built, capsys):
    before = (built / "my.mlmg").read_bytes()
    (built / "Step.bvh").write_text("HIERARCHY\nROOT Hips\n{\n")
    assert mlmg.main(["build", "library.toml", "-o", "my.mlmg"]) == 1
    assert "Step.bvh:" in capsys.readouterr().err
    assert (built / "my.mlmg").read_bytes() == before
    assert sorted(path.name for path in built.iterdir() if path.name.startswith(".")) == []


def test_clips_on_no_graph_are_named(folder, capsys):
    text = (folder / "library.toml").read_text(encoding="utf-8").replace('Step = ["WALK"]', "").replace("Step =", "#")
    (folder / "library.toml").write_text(text, encoding="utf-8")
    assert mlmg.main(["build", "library.toml"]) == 0
    assert "mlmg build: note: 1 clip is on no graph and left out: Step\n" in capsys.readouterr().err


def test_of_many_clips_on_no_graph_some_are_named(folder, capsys):
    for number in range(10):
        (folder / f"other_{number}.bvh").write_bytes((folder / "Step.bvh").read_bytes())
    assert mlmg.main(["build", "library.toml"]) == 0
    names = ", ".join(f"other_{number}" for number in range(6))
    assert f"note: 10 clips are on no graph and left out: {names}, 4 more\n" in capsys.readouterr().err


def test_a_graph_without_transitions_is_one_warning_that_says_what_may_help(folder, capsys):
    text = (folder / "library.toml").read_text(encoding="utf-8")
    (folder / "library.toml").write_text(text.replace("{ quantile = 0.3 }", "1e-9"), encoding="utf-8")
    assert mlmg.main(["build", "library.toml"]) == 0
    (warning,) = [line for line in capsys.readouterr().err.splitlines() if "warning" in line]
    assert warning.startswith("mlmg build: warning: Upper-Body: no motion can follow another, nor itself")
    assert "`threshold`" in warning


def test_motions_that_nothing_leads_to_are_one_warning_a_graph(folder, capsys):
    rules = '\n[[transitions]]\nforbid = [["IDLE", "WALK"], ["IDLE", "TALK"], ["WALK", "IDLE"], ["TALK", "IDLE"]]\n'
    text = (folder / "library.toml").read_text(encoding="utf-8")
    (folder / "library.toml").write_text(text + rules, encoding="utf-8")
    assert mlmg.main(["build", "library.toml"]) == 0
    (warning,) = [line for line in capsys.readouterr().err.splitlines() if "no transition leads to" in line]
    assert warning in (
        "mlmg build: warning: Full-Body: no transition leads to Stand and on from there: "
        "a script can start there, but never come there",
        "mlmg build: warning: Full-Body: no transition leads to Step, Reach and on from there: "
        "a script can start there, but never come there",
    )


def test_motions_that_are_hardly_shown_where_they_are_held_are_told_with_what_may_help(folder, capsys):
    rules = '\n[[transitions]]\ngraph = "Full-Body"\nforbid = [["IDLE", "IDLE"]]\n'
    text = (folder / "library.toml").read_text(encoding="utf-8")
    (folder / "library.toml").write_text(text + rules, encoding="utf-8")
    assert mlmg.main(["build", "library.toml", "-o", "my.mlmg"]) == 0
    (warning,) = [line for line in capsys.readouterr().err.splitlines() if "warning" in line]
    assert mlmg.main(["info", "my.mlmg", "--json"]) == 0
    held = [graph["hardly_held"] for graph in json.loads(capsys.readouterr().out)["graphs"]]
    assert [list(motions) for motions in held] == [["Stand"], []]
    share = f"{held[0]['Stand']:.0%}"
    assert warning.startswith(
        f"mlmg build: warning: Full-Body: held for long, Stand ({share}) would be shown for less "
    )
    assert "`threshold`" in warning
    assert mlmg.main(["info", "my.mlmg"]) == 0
    assert f"  hardly held: shown {share} of the time\n" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("named", "message"),
    [
        (".", ". is a folder; expected a library's configuration (TOML): did you mean library.toml?"),
        ("empty", "empty is a folder; expected a library's configuration (TOML): write one, as docs/library.md shows"),
        ("Step.bvh", "Step.bvh is a clip; expected a library's configuration (TOML), which names the clips"),
    ],
)
def test_clips_named_instead_of_a_configuration_are_told_what_is_expected(folder, capsys, named, message):
    (folder / "empty").mkdir()
    assert mlmg.main(["build", named]) == 2
    assert capsys.readouterr().err.startswith(f"mlmg build: error: {message}")


def test_a_configuration_that_is_not_there_is_wrong_usage(folder, capsys):
    assert mlmg.main(["build", "nothing.toml"]) == 2
    assert capsys.readouterr().err == "mlmg build: error: nothing.toml: No such file or directory\n"


def test_info_tells_graphs_motions_tags_and_transitions(built, capsys):
    assert mlmg.main(["info", "my.mlmg"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("my.mlmg: 3 clips, 270 frames (9 s at 30 fps), 4 joints, ")
    assert "Upper-Body, below Full-Body: 2 motions, " in text
    assert "  Step      3.0 s  WALK" in text


def test_info_as_json_holds_what_the_text_says(built, capsys):
    assert mlmg.main(["info", "my.mlmg", "--json"]) == 0
    description = json.loads(capsys.readouterr().out)
    assert description["clips"] == {"Stand": 90, "Step": 90, "Reach": 90}
    full, upper = description["graphs"]
    assert (full["parent"], upper["parent"]) == (None, "Full-Body")
    assert upper["motions"] == {"Step": ["SWING"], "Reach": ["TALK"]}


def test_what_the_configuration_forbids_is_told_by_info_and_by_check(folder, capsys):
    rules = '\n[[transitions]]\nforbid = [["IDLE", "WALK"], ["IDLE", "TALK"], ["WALK", "IDLE"], ["TALK", "IDLE"]]\n'
    text = (folder / "library.toml").read_text(encoding="utf-8")
    (folder / "library.toml").write_text(text + rules, encoding="utf-8")
    (folder / "off.ms").write_text("Stand\nWALK\n", encoding="utf-8")
    assert mlmg.main(["build", "library.toml", "-o", "my.mlmg"]) == 0
    assert mlmg.main(["info", "my.mlmg", "--json"]) == 0
    assert [graph["n_forbidden"] for graph in json.loads(capsys.readouterr().out)["graphs"]] == [4, 0]
    assert mlmg.main(["info", "my.mlmg"]) == 0
    assert "\n  forbidden: 4 of the pairs of motions, to follow each other directly\n" in capsys.readouterr().out
    assert mlmg.main(["check", "off.ms", "--library", "my.mlmg"]) == 1
    assert "help: library.toml forbids going from `Stand` to `Step` on `Full-Body`" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("option", "columns"),
    [
        ("--transitions", ["src_motion", "src_frame", "dst_motion", "dst_frame", "distance", "cost"]),
        ("--oms", ["a", "b", "oms"]),
        ("--motions", ["motion", "n_frames", "seconds", "tags"]),
    ],
)
def test_tables_are_csv_on_standard_output(built, capsys, option, columns):
    assert mlmg.main(["info", "my.mlmg", option, "Upper-Body"]) == 0
    header, *rows = csv.reader(io.StringIO(capsys.readouterr().out))
    assert header == columns
    assert rows
    assert all(len(row) == len(columns) for row in rows)


RESERVED = (
    ('name = "Upper-Body"', 'name = "for"'),
    ("[tags.Upper-Body]", '[tags."for"]'),
    ('Step = ["SWING"]\nReach = ["TALK"]', '"with" = ["end", "a \\"b\\" c", "SWING"]\nReach = ["TALK"]'),
    ('Step = ["WALK"]', '"with" = ["once"]'),
)


@pytest.fixture
def reserved(folder):
    """Return the folder with a library whose graph, motion and tags are words of the language."""
    (folder / "Step.bvh").rename(folder / "with.bvh")
    text = (folder / "library.toml").read_text(encoding="utf-8")
    for usual, word in RESERVED:
        assert usual in text
        text = text.replace(usual, word)
    (folder / "library.toml").write_text(text, encoding="utf-8")
    assert mlmg.main(["build", "library.toml", "-o", "my.mlmg"]) == 0
    return folder


def test_tags_are_told_as_a_script_writes_them(reserved, capsys):
    capsys.readouterr()
    assert mlmg.main(["info", "my.mlmg", "--motions", "for"]) == 0
    rows = list(csv.reader(io.StringIO(capsys.readouterr().out)))
    assert rows[1:] == [["with", "90", "3.0", '"end" "a \\"b\\" c" SWING'], ["Reach", "90", "3.0", "TALK"]]


def test_words_of_the_language_are_names_in_quotes(reserved, capsys):
    script = '"once" for 1 sec\n"for" TALK for 1 sec\nend "for"\n"for" "a \\"b\\" c" for 1 sec\n"with"\n'
    (reserved / "words.ms").write_text(script, encoding="utf-8")
    library = ["--library", "my.mlmg"]
    capsys.readouterr()
    assert mlmg.main(["check", "words.ms", "--format", "concise", *library]) == 0
    assert capsys.readouterr().out == ""
    assert mlmg.main(["fmt", "--check", "words.ms"]) == 0
    assert mlmg.main(["explain", "words.ms", "--analyze", *library]) == 0
    assert mlmgc.main(["words.ms", *library, "-o", "words.bvh", "--report", "words.json"]) == 0
    commands = json.loads((reserved / "words.json").read_text())["commands"]
    assert [one["motions"] for one in commands][-1] == {"Full-Body": "with"}
    for option in ("--transitions", "--oms"):
        assert mlmg.main(["info", "my.mlmg", option, "for"]) == 0


@pytest.mark.parametrize("written", ["upper-body", "upper_body", "UpperBody"])
def test_a_graph_may_be_written_as_in_scripts(built, capsys, written):
    assert mlmg.main(["info", "my.mlmg", "--oms", written]) == 0
    assert capsys.readouterr().out.startswith("a,b,oms\n")


def test_a_graph_that_is_not_there_is_named_with_those_that_are(built, capsys):
    assert mlmg.main(["info", "my.mlmg", "--oms", "Legs"]) == 1
    assert capsys.readouterr().err == (
        "mlmg info: error: my.mlmg: there is no graph `Legs`; there are Full-Body, Upper-Body\n"
    )


def test_a_file_that_is_no_library_is_told_plainly(folder, capsys):
    assert mlmg.main(["info", "Stand.bvh"]) == 1
    assert "expected a file that `mlmg build` wrote" in capsys.readouterr().err


def test_an_unknown_command_is_told_with_the_nearest(capsys):
    assert mlmg.main(["biuld"]) == 2
    assert capsys.readouterr().err == "mlmg: error: no command `biuld`; did you mean `mlmg build`?\n"


def test_without_a_command_all_commands_are_listed(capsys):
    assert mlmg.main([]) == 0
    out = capsys.readouterr().out
    assert all(f"  {name} " in out for name in mlmg.SUBCOMMANDS)


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_progress_on_a_terminal_says_how_long_work_will_still_take_and_is_taken_away():
    now = iter([0.0, 10.0])
    terminal = Terminal()
    line = ProgressLine(terminal, lambda: next(now))
    line("comparing", 0, 4)
    line("comparing", 1, 4)
    assert terminal.getvalue() == "\rcomparing 0/4\rcomparing 1/4, 30 s left"
    line.clear()
    assert terminal.getvalue().endswith("\r" + " " * len("comparing 1/4, 30 s left") + "\r")


def test_progress_says_nothing_where_there_is_no_terminal():
    stream = io.StringIO()
    ProgressLine(stream)("comparing", 1, 4)
    assert stream.getvalue() == ""


@pytest.mark.parametrize("output", ["library.toml", "Step.bvh"])
def test_no_input_of_a_build_is_written_over(folder, capsys, output):
    before = (folder / output).read_bytes()
    assert mlmg.main(["build", "library.toml", "-o", output]) == 2
    assert f"{output}: this file is read" in capsys.readouterr().err
    assert (folder / output).read_bytes() == before


def test_a_folder_that_is_not_there_is_told_before_the_work(folder, capsys, monkeypatch):
    monkeypatch.setattr("mlmg_runtime.building.build.build_library", lambda *_: pytest.fail("built all the same"))
    assert mlmg.main(["build", "library.toml", "-o", "no/my.mlmg"]) == 2
    assert capsys.readouterr().err == "mlmg build: error: no/my.mlmg: No such file or directory\n"


def test_a_frame_time_in_milliseconds_is_one_clear_error(folder, capsys):
    text = (folder / "Step.bvh").read_text()
    (folder / "Step.bvh").write_text(text.replace("Frame Time: 0.033333", "Frame Time: 33.3333", 1))
    assert mlmg.main(["build", "library.toml"]) == 1
    assert "Step.bvh: a frame lasts 33.3333" in capsys.readouterr().err


def test_info_tells_how_far_the_demo_library_is(built, monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)

    def made(progress):
        progress("making", 1, 2)
        return built / "my.mlmg"

    monkeypatch.setattr("mlmg_runtime.demo.library.demo_library", made)
    assert mlmg.main(["info"]) == 0
    assert terminal.getvalue() == "\rmaking 1/2\r          \r"


def test_info_finds_the_library_as_the_other_commands_do(built, capsys, monkeypatch):
    monkeypatch.setenv("MLMG_LIBRARY", "my.mlmg")
    assert mlmg.main(["info"]) == 0
    assert capsys.readouterr().out.startswith("my.mlmg: 3 clips")
