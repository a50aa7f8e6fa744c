"""mlmgc: from a script to a BVH and a report; and what it says when it cannot."""

import io
import json
import subprocess
import sys

import numpy as np
import pytest

import mlmg_lang
from mlmg_lang.commands import mlmgc
from mlmg_runtime import bvh

SCRIPT = "Stand for 1 sec\nWALK for 2 sec\n"


@pytest.fixture
def scene(built):
    (built / "scene.ms").write_text(SCRIPT, encoding="utf-8")
    return built


def compiled(*options: str) -> int:
    return mlmgc.main(["scene.ms", "--library", "my.mlmg", *options])


def test_a_script_becomes_a_bvh_and_a_report(scene, capsys):
    assert compiled("-o", "out.bvh", "--report", "out.json") == 0
    report = json.loads((scene / "out.json").read_text(encoding="utf-8"))
    motion = bvh.read(scene / "out.bvh")
    assert motion.frames.shape[0] == report["n_frames"]
    assert motion.joints == bvh.read(scene / "Stand.bvh").joints
    assert report["library"] == "my.mlmg"
    walk = report["commands"][1]
    assert (walk["text"], walk["span"]) == ("WALK for 2 sec", [2, 1, 2, 15])
    assert walk["end"] - walk["arrive"] == 60
    assert capsys.readouterr().out == ""


def test_the_same_inputs_give_the_same_bytes(scene):
    assert compiled("-o", "a.bvh", "--report", "a.json") == compiled("-o", "b.bvh", "--report", "b.json") == 0
    assert (scene / "a.bvh").read_bytes() == (scene / "b.bvh").read_bytes()
    assert (scene / "a.json").read_bytes() == (scene / "b.json").read_bytes()


def test_dashes_are_standard_input_and_output(scene, capsysbinary, monkeypatch):
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(SCRIPT.encode())))
    assert mlmgc.main(["-", "--library", "my.mlmg", "-o", "-"]) == 0
    out = capsysbinary.readouterr().out
    assert compiled("-o", "out.bvh") == 0
    assert out == (scene / "out.bvh").read_bytes()


def test_another_frame_rate_is_the_same_motion_in_other_steps(scene):
    assert compiled("-o", "30.bvh", "--report", "30.json") == 0
    assert compiled("-o", "60.bvh", "--report", "60.json", "--fps", "60") == 0
    slow, fast = bvh.read(scene / "30.bvh"), bvh.read(scene / "60.bvh")
    assert fast.frame_time_s == pytest.approx(1 / 60, abs=1e-6)
    np.testing.assert_allclose(fast.frames[::2][:, :3], slow.frames[:, :3], atol=1e-5)
    reports = [json.loads((scene / f"{rate}.json").read_text()) for rate in (30, 60)]
    assert reports[1]["commands"][1]["arrive"] == 2 * reports[0]["commands"][1]["arrive"]
    assert reports[1]["tracks"]["Full-Body"][0]["speed"] == 0.5


def test_linear_blending_differs_from_c1_in_transitions_alone(scene):
    assert compiled("-o", "c1.bvh", "--report", "r.json") == compiled("-o", "linear.bvh", "--blend", "linear") == 0
    tracks = json.loads((scene / "r.json").read_text())["tracks"]["Full-Body"]
    first = next(entry for entry in tracks if entry["kind"] == "transition")
    c1, linear = bvh.read(scene / "c1.bvh").frames, bvh.read(scene / "linear.bvh").frames
    np.testing.assert_array_equal(c1[: first["begin"]], linear[: first["begin"]])
    assert np.abs(c1 - linear)[first["begin"] : first["end"]].max() > 0.01


def test_without_foot_locking_only_transitions_differ(scene, demo_library):
    (scene / "scene.ms").write_text("Walk_01 for 1 sec\nIdle_02\n")
    library = ["--library", str(demo_library.path)]
    assert mlmgc.main(["scene.ms", "-o", "locked.bvh", "--report", "r.json", *library]) == 0
    assert mlmgc.main(["scene.ms", "-o", "free.bvh", "--no-feet", *library]) == 0
    plan, _ = mlmg_lang.compile("Walk_01 for 1 sec\nIdle_02\n", demo_library)
    bvh.write(mlmg_lang.play(plan, demo_library, feet=False).bvh, "played.bvh")
    assert (scene / "free.bvh").read_bytes() == (scene / "played.bvh").read_bytes()
    locked, free = bvh.read(scene / "locked.bvh").frames, bvh.read(scene / "free.bvh").frames
    tracks = json.loads((scene / "r.json").read_text())["tracks"]["Full-Body"]
    is_blended = np.zeros(len(locked), dtype=bool)
    for entry in tracks:
        is_blended[entry["begin"] : entry["end"]] = entry["kind"] != "clip"
    np.testing.assert_array_equal(locked[~is_blended], free[~is_blended])
    assert np.abs(locked - free)[is_blended].max() > 0.01


def test_start_is_where_the_character_begins(scene):
    (scene / "scene.ms").write_text("WALK for 1 sec\n")
    assert compiled("-o", "out.bvh", "--report", "out.json", "--start", "Reach") == 0
    tracks = json.loads((scene / "out.json").read_text())["tracks"]["Full-Body"]
    first = tracks[0]
    assert first.get("motion", first.get("from", [""])[0]) == "Reach"


def test_a_mistake_is_drawn_and_nothing_is_written(scene, capsys):
    (scene / "scene.ms").write_text("WLAK for 2 sec\n")
    (scene / "out.bvh").write_text("what was here")
    assert compiled("-o", "out.bvh") == 1
    err = capsys.readouterr().err
    assert "scene.ms:1:1" in err
    assert "^^^^" in err
    assert "`WALK`" in err
    assert (scene / "out.bvh").read_text() == "what was here"


def test_an_empty_script_says_what_a_script_is(scene, capsys):
    (scene / "scene.ms").write_text("# only a comment\n")
    assert compiled("-o", "out.bvh") == 1
    assert "nothing to play" in capsys.readouterr().err
    assert not (scene / "out.bvh").exists()


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["none.ms", "--library", "my.mlmg", "-o", "o.bvh"], 2, "none.ms: No such file or directory"),
        (["scene.ms", "--library", "none.mlmg", "-o", "o.bvh"], 2, "none.mlmg: No such file or directory"),
        (["scene.ms", "--library", "my.mlmg", "-o", "no/o.bvh"], 2, "no/o.bvh: No such file or directory"),
        (["scene.ms", "--library", "Stand.bvh", "-o", "o.bvh"], 1, "Stand.bvh: "),
        (["scene.ms", "--library", "my.mlmg", "-o", "-", "--report", "-"], 2, "standard output"),
        (["scene.ms", "--library", "my.mlmg", "-o", "o.fbx"], 2, "o.fbx: a motion is written as BVH; expected a name"),
    ],
)
def test_what_cannot_be_opened_or_is_wrong_is_one_line(scene, capsys, arguments, code, message):
    assert mlmgc.main(arguments) == code
    err = capsys.readouterr().err
    assert message in err
    assert err.count("\n") == 1


@pytest.mark.parametrize("name", ["out", "out.BVH", "走路 1.bvh"])
def test_a_name_that_promises_no_other_format_is_written_to(scene, name):
    assert compiled("-o", name) == 0
    assert bvh.read(scene / name).n_channels == 15


def test_a_script_that_is_no_text_is_one_diagnostic(scene, capsys):
    (scene / "scene.ms").write_bytes(b"WALK \xff\xfe for 1 sec\n")
    assert compiled("-o", "out.bvh") == 1
    assert "UTF-8" in capsys.readouterr().err


def test_the_setting_beside_a_script_names_its_library(scene, tmp_path_factory, monkeypatch):
    (scene / "mlmg.toml").write_text('library = "my.mlmg"\n')
    monkeypatch.chdir(tmp_path_factory.mktemp("elsewhere"))
    assert mlmgc.main([str(scene / "scene.ms"), "-o", str(scene / "out.bvh")]) == 0


def test_without_a_library_the_demo_library_plays_and_says_so_in_one_line(folder, demo_library, monkeypatch, capsys):
    monkeypatch.setenv("MLMG_CACHE", str(demo_library.path.parent))
    (folder / "scene.ms").write_text("Idle_01 for 1 sec\n")
    assert mlmgc.main(["scene.ms", "-o", "out.bvh"]) == 0
    assert capsys.readouterr().err.splitlines() == [
        "mlmgc: no library is named (--library, MLMG_LIBRARY, mlmg.toml): playing on the demo library",
        "out.bvh: 30 frames, 1.0 s, 0.0 s of them on the way between motions",
    ]


def test_two_processes_that_build_the_demo_library_at_once_do_no_harm(folder, tmp_path):
    (folder / "scene.ms").write_text("Idle_01 for 1 sec\n")
    environment = {"MLMG_CACHE": str(tmp_path / "cache"), "PATH": ""}
    command = [sys.executable, "-m", "mlmg_lang.commands.mlmgc", "scene.ms", "-o"]
    both = [subprocess.Popen([*command, f"{n}.bvh"], env=environment, stderr=subprocess.PIPE) for n in (1, 2)]
    assert [process.wait() for process in both] == [0, 0], [process.stderr.read() for process in both]
    for process in both:
        process.stderr.close()
    assert (folder / "1.bvh").read_bytes() == (folder / "2.bvh").read_bytes()
    assert len(list((tmp_path / "cache").iterdir())) == 1


def test_the_report_names_the_joints_of_a_part_that_runs(scene):
    (scene / "scene.ms").write_text("Step for 1 sec\nUpper-Body TALK for 1 sec\n")
    assert compiled("-o", "out.bvh", "--report", "out.json") == 0
    report = json.loads((scene / "out.json").read_text())
    assert report["joints"] == {"Upper-Body": ["Spine", "Head"]}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["-o", "scene.ms"], "scene.ms: this file is read"),
        (["-o", "./my.mlmg"], "my.mlmg: this file is read"),
        (["-o", "out.bvh", "--report", "scene.ms"], "scene.ms: this file is read"),
        (["-o", "out.bvh", "--report", "out.bvh"], "out.bvh: two outputs cannot be one file"),
    ],
)
def test_no_file_that_is_read_is_written_over(scene, capsys, options, message):
    before = {path.name: path.read_bytes() for path in scene.iterdir()}
    assert compiled(*options) == 2
    assert message in capsys.readouterr().err
    assert {path.name: path.read_bytes() for path in scene.iterdir()} == before


def test_an_output_that_cannot_be_written_is_told_before_anything_is(scene, capsys):
    assert compiled("-o", "out.bvh", "--report", "no/report.json") == 2
    assert "no/report.json: No such file or directory" in capsys.readouterr().err
    assert not (scene / "out.bvh").exists()


@pytest.mark.parametrize("rate", ["abc", "1e-9", "0.99", "10001", "nan", "inf"])
def test_a_rate_that_no_motion_has_is_wrong_usage(scene, capsys, rate):
    with pytest.raises(SystemExit) as left:
        compiled("-o", "out.bvh", "--fps", rate)
    assert left.value.code == 2
    assert f"expected a number of frames a second from 1 to 10000, found '{rate}'" in capsys.readouterr().err


def test_a_cache_that_cannot_be_used_is_one_line_that_names_it_and_its_variable(folder, monkeypatch, capsys):
    (folder / "scene.ms").write_text("Idle_01 for 1 sec\n")
    monkeypatch.setenv("MLMG_CACHE", "scene.ms")
    assert mlmgc.main(["scene.ms", "-o", "out.bvh"]) == 2
    assert capsys.readouterr().err == (
        "mlmgc: error: scene.ms: Not a directory; the demo library is kept here because MLMG_CACHE says so\n"
    )


def test_motions_are_chosen_over_the_whole_script_where_that_is_asked_for(scene):
    assert compiled("-o", "a.bvh", "--report", "a.json") == 0
    assert compiled("-o", "b.bvh", "--report", "b.json", "--plan", "global") == 0
    plans = [json.loads((scene / name).read_text(encoding="utf-8"))["plan"] for name in ("a.json", "b.json")]
    assert plans == ["greedy", "global"]


def test_what_is_not_planned_over_the_whole_script_is_played_and_said(scene, capsys):
    (scene / "scene.ms").write_text("Stand for 1 sec\nrepeat 501 { WALK }\n")
    assert compiled("-o", "b.bvh", "--report", "b.json", "--plan", "global") == 0
    assert (
        "mlmgc: note: motions are chosen command by command: all rounds and branches counted, it has more than 500"
        in capsys.readouterr().err
    )
    assert json.loads((scene / "b.json").read_text(encoding="utf-8"))["plan"] == "greedy"
