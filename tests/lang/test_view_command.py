"""`mlmg view`, from its arguments to its files."""

import io
import json
import re
import sys
import webbrowser
from types import SimpleNamespace

import pytest

from mlmg_lang.commands.mlmg import main
from mlmg_runtime.view import html, lettering, movie, stills

BVH = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Spine
  {
    OFFSET 0 50 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 40 0
    }
  }
}
MOTION
Frames: 12
Frame Time: 0.0333333
"""
REPORT = {
    "n_frames": 12,
    "commands": [{"text": "WALK for 1 sec", "begin": 0, "arrive": 0, "end": 12}],
    "tracks": {"Full-Body": [{"kind": "clip", "begin": 0, "end": 12, "motion": "Walk_01"}]},
}


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Stand in a folder with a motion in it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(movie, "SIZE", (80, 60))
    frames = "".join(f"0 90 {frame} 0 {frame} 0 {5 * frame} 0 0\n" for frame in range(12))
    (tmp_path / "stroll.bvh").write_text(BVH + frames)
    return tmp_path


def view(*words):
    return main(["view", *words])


def data_of(page):
    text = page.read_text(encoding="utf-8")
    return json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', text, re.DOTALL)[1])


def kind(path):
    return path.read_bytes()[:4]


def test_the_ending_says_what_is_written(folder, capsys):
    assert [view("stroll.bvh", "-o", f"x{ending}") for ending in (".html", ".png", ".GIF")] == [0, 0, 0]
    assert [kind(folder / name) for name in ("x.html", "x.png", "x.GIF")] == [b"<!do", b"\x89PNG", b"GIF8"]
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("frame_time_s", ["1e-300", "1e308"])
@pytest.mark.parametrize("ending", [".html", ".png", ".gif"])
def test_a_frame_time_that_nobody_means_is_one_line(folder, capsys, frame_time_s, ending):
    text = (folder / "stroll.bvh").read_text()
    (folder / "odd.bvh").write_text(re.sub("Frame Time: .*", f"Frame Time: {frame_time_s}", text))
    assert view("odd.bvh", "-o", f"x{ending}") == 1
    assert "odd.bvh: expected a frame time from 1e-05 to 1000 s, found 1e" in capsys.readouterr().err


def test_a_name_that_is_no_text_is_shown_with_question_marks(folder):
    (folder / "str\udcff.bvh").write_bytes((folder / "stroll.bvh").read_bytes())
    assert view("str\udcff.bvh", "-o", "x.html") == 0
    assert "<title>str?" in (folder / "x.html").read_text(encoding="utf-8")


def test_an_unknown_ending_is_an_error_that_lists_the_known(folder, capsys):
    assert view("stroll.bvh", "-o", "x.mp4") == 2
    assert capsys.readouterr().err == (
        "mlmg view: error: x.mp4: expected a name that ends in .html, .png or .gif, found .mp4\n"
    )
    assert not (folder / "x.mp4").exists()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["stroll.bvh", "stroll.bvh", "-o", "x.png"], "x.png: a .png shows one motion, found 2; .html shows several"),
        (["stroll.bvh", "-o", "x.html", "--frames", "1,2"], "the player shows the frames between two: --frames 90:240"),
        (["stroll.bvh", "-o", "x.png", "--fps", "5"], "--fps is for the player and for .gif; "),
        (["stroll.bvh", "-o", "x.gif", "--frames", "1,2"], "a .gif shows the frames between two: --frames 90:240"),
        (["stroll.bvh", "-o", "x.png", "--frames", "3,12"], "frame 12: stroll has the frames 0 to 11"),
        (["stroll.bvh", "-o", "x.gif", "--frames", "7:7"], "no frame is chosen: stroll has the frames 0 to 11"),
        (["a.bvh", "b.bvh", "--report", "r.json"], "expected a --report for each of 2 motions, found 1"),
        (["-", "-"], "standard input holds one motion; - stands there twice"),
        (["nothing.bvh"], "nothing.bvh: No such file or directory"),
        (["stroll.bvh", "-o", "no/such/folder.html"], "no/such/folder.html: No such file or directory"),
    ],
)
def test_wrong_usage_is_one_line_and_code_2(folder, capsys, words, message):
    assert view(*words) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"mlmg view: error: {message}")
    assert error.count("\n") == 1


@pytest.mark.parametrize("frames", ["a", "1-5", "1:2:3", "-3", ""])
def test_frames_that_are_none_are_explained(folder, capsys, frames):
    with pytest.raises(SystemExit) as ended:
        view("stroll.bvh", "-o", "x.png", f"--frames={frames}")
    assert ended.value.code == 2
    assert f"found '{frames}'" in capsys.readouterr().err


def test_a_file_that_is_no_motion_is_code_1(folder, capsys):
    (folder / "x.bvh").write_text("hello\n")
    assert view("x.bvh", "-o", "x.html") == 1
    assert capsys.readouterr().err.startswith("mlmg view: error: x.bvh:1: expected HIERARCHY, found")
    assert not (folder / "x.html").exists()


def test_a_motion_without_frames_is_code_1(folder, capsys):
    (folder / "empty.bvh").write_text(BVH.replace("Frames: 12", "Frames: 0"))
    assert view("empty.bvh", "-o", "x.html") == 1
    assert "empty.bvh" in capsys.readouterr().err


def test_a_report_captions_the_player(folder):
    (folder / "r.json").write_text(json.dumps(REPORT))
    assert view("stroll.bvh", "--report", "r.json", "-o", "x.html") == 0
    assert "WALK for 1 sec" in (folder / "x.html").read_text(encoding="utf-8")


def test_the_report_of_another_motion_is_code_1(folder, capsys):
    (folder / "r.json").write_text(json.dumps({**REPORT, "n_frames": 13}))
    assert view("stroll.bvh", "--report", "r.json", "-o", "x.html") == 1
    assert capsys.readouterr().err == (
        "mlmg view: error: r.json: expected the report of a motion of 12 frames, found one of 13\n"
    )


def test_a_report_beside_the_motion_is_used_and_named(folder, capsys):
    (folder / "stroll.json").write_text(json.dumps(REPORT))
    assert view("stroll.bvh", "-o", "x.html") == 0
    assert "WALK for 1 sec" in (folder / "x.html").read_text(encoding="utf-8")
    assert capsys.readouterr().err == "mlmg view: stroll.json: what plays when is taken from this report\n"


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (json.dumps({"name": "package"}), ""),
        ("not JSON", ""),
        (
            json.dumps({**REPORT, "n_frames": 13}),
            "mlmg view: stroll.json: expected the report of a motion of 12 frames, found one of 13; it is not used\n",
        ),
    ],
)
def test_other_json_beside_the_motion_does_no_harm(folder, capsys, content, said):
    (folder / "stroll.json").write_text(content)
    assert view("stroll.bvh", "-o", "x.html") == 0
    assert capsys.readouterr().err == said


def test_a_part_of_a_motion_is_shown_with_its_own_numbers(folder):
    (folder / "stroll.json").write_text(json.dumps(REPORT))
    assert view("stroll.bvh", "-o", "x.html", "--frames", "3:0.3s", "--fps", "16") == 0
    (scene,) = data_of(folder / "x.html")["scenes"]
    assert (scene["firstFrame"], scene["frameStep"], scene["nFrames"]) == (3, 2, 3)
    assert scene["commands"] == [{"text": "WALK for 1 sec", "begin": 0, "arrive": 0, "end": 3}]
    assert scene["frameTime"] == pytest.approx(2 / 30, abs=1e-6)


def test_a_motion_too_long_for_a_page_is_shown_in_fewer_frames_and_says_so(folder, capsys, monkeypatch):
    monkeypatch.setattr(html, "most_frames", lambda joints: 10)
    assert view("stroll.bvh", "-o", "x.html") == 0
    assert data_of(folder / "x.html")["scenes"][0]["nFrames"] == 6
    assert capsys.readouterr().err == "mlmg view: stroll: 6 of its 12 frames are shown, 15 a second\n"
    assert view("stroll.bvh", "stroll.bvh", "-o", "x.html") == 0
    assert [scene["nFrames"] for scene in data_of(folder / "x.html")["scenes"]] == [4, 4]


def test_a_motion_far_too_long_for_a_page_is_refused_with_what_to_write_instead(folder, capsys, monkeypatch):
    monkeypatch.setattr(html, "most_frames", lambda joints: 3)
    assert view("stroll.bvh", "-o", "x.html") == 2
    assert "--frames 0:3 shows a part, --fps 7.5 all of it" in capsys.readouterr().err
    assert not (folder / "x.html").exists()
    for words in (["--frames", "0:3"], ["--fps", "7.5"]):
        assert view("stroll.bvh", "-o", "x.html", *words) == 0
        assert data_of(folder / "x.html")["scenes"][0]["nFrames"] == 3


def test_the_moments_of_a_picture_are_those_of_the_commands(folder, monkeypatch):
    seen = []
    monkeypatch.setattr(stills, "write_png", lambda scene, path, frames, progress: seen.append(frames))
    commands = [{"text": "A", "begin": 0, "arrive": 2, "end": 5}, {"text": "B", "begin": 5, "arrive": 9, "end": 12}]
    (folder / "stroll.json").write_text(json.dumps({**REPORT, "commands": commands}))
    assert view("stroll.bvh", "-o", "x.png") == 0
    assert {3, 10} < set(seen[0])


def test_a_gif_has_as_many_pictures_a_second_as_it_is_told(folder):
    from PIL import Image

    for fps, n_pictures in (("5", 2), ("10", 4), ("100", 12)):
        assert view("stroll.bvh", "-o", "x.gif", "--fps", fps) == 0
        with Image.open(folder / "x.gif") as image:
            assert image.n_frames == n_pictures


@pytest.mark.parametrize(("output", "stages"), [("x.gif", "reading choosing drawing"), ("x.png", "reading drawing")])
def test_on_a_terminal_it_is_told_how_far_the_work_is(folder, monkeypatch, output, stages):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    assert view("stroll.bvh", "-o", output) == 0
    told = [line.split(" ")[0] for line in terminal.getvalue().split("\r") if line.strip()]
    assert list(dict.fromkeys(told)) == stages.split()
    assert terminal.getvalue().endswith(" \r")


def test_frames_choose_the_moments_of_a_picture(folder):
    from PIL import Image

    widths = []
    for frames in ("3", "3,5,7", "4:8"):
        assert view("stroll.bvh", "-o", "x.png", "--frames", frames) == 0
        with Image.open(folder / "x.png") as image:
            widths.append(image.width)
    assert widths == [250, 3 * 254 - 4, 4 * 254 - 4]


@pytest.mark.parametrize("output", ["x.png", "x.gif"])
def test_letters_that_no_font_has_are_told_in_one_line(folder, capsys, monkeypatch, output):
    monkeypatch.setattr(lettering, "letters_without_font", lambda texts: "走路" if "走路" in set(texts) else "")
    assert view("stroll.bvh", "-o", output) == 0
    assert capsys.readouterr().err == ""
    commands = [{**REPORT["commands"][0], "text": "走路"}]
    (folder / "r.json").write_text(json.dumps({**REPORT, "commands": commands}))
    assert view("stroll.bvh", "-o", output, "--report", "r.json") == 0
    assert capsys.readouterr().err == (
        "mlmg view: no font was found that has 走路: spelt out as in \\u8d70; install one, such as Noto Sans (CJK)\n"
    )


def test_a_gif_that_is_cut_says_how_to_see_the_rest(folder, capsys, monkeypatch):
    monkeypatch.setattr(movie, "LONGEST_S", 0.2)
    assert view("stroll.bvh", "-o", "x.gif", "--frames", "2:") == 0
    assert capsys.readouterr().err == (
        "mlmg view: x.gif: the first 0.2 s of 0.33 s are shown; --frames 8:12 shows the rest\n"
    )


def test_pictures_without_pillow_say_what_to_install(folder, capsys, monkeypatch):
    monkeypatch.setattr("mlmg_runtime.view.pillow.find_spec", lambda name: None)
    assert view("stroll.bvh", "-o", "x.png") == 1
    assert capsys.readouterr().err == 'mlmg view: error: PNG and GIF need Pillow: pip install "mlmg[view]"\n'
    assert view("stroll.bvh", "-o", "x.html") == 0


@pytest.fixture
def opened(monkeypatch):
    """Return the addresses that the browser was asked to open."""
    addresses = []
    monkeypatch.setattr(webbrowser, "open", lambda address: not addresses.append(address))
    return addresses


def test_without_an_output_the_player_opens_in_the_browser(folder, capsys, opened, monkeypatch):
    monkeypatch.setenv("DISPLAY", ":0")
    assert view("stroll.bvh") == 0
    page = capsys.readouterr().out.strip()
    assert opened == [f"file://{page}"]
    assert page.endswith("/stroll.html")


def test_no_open_prints_where_the_player_is(folder, capsys, opened, monkeypatch):
    monkeypatch.setenv("DISPLAY", ":0")
    assert view("stroll.bvh", "--no-open") == 0
    captured = capsys.readouterr()
    assert captured.out.endswith("stroll.html\n")
    assert (opened, captured.err) == ([], "")


@pytest.mark.skipif(sys.platform in ("darwin", "win32"), reason="there is always a screen")
def test_without_a_screen_no_text_browser_is_started(folder, capsys, opened, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert view("stroll.bvh") == 0
    assert opened == []
    assert "open the file above" in capsys.readouterr().err


def test_a_motion_can_come_through_a_pipe(folder, monkeypatch):
    content = (folder / "stroll.bvh").read_bytes()
    monkeypatch.setattr(sys, "stdin", SimpleNamespace(buffer=io.BytesIO(content)))
    assert view("-", "-o", "x.html") == 0
    assert "standard input" in (folder / "x.html").read_text(encoding="utf-8")


def test_files_of_one_name_are_told_apart_by_their_paths(folder):
    (folder / "new").mkdir()
    (folder / "new/stroll.bvh").write_bytes((folder / "stroll.bvh").read_bytes())
    assert view("stroll.bvh", "new/stroll.bvh", "-o", "x.html") == 0
    assert "<title>stroll.bvh, new/stroll.bvh</title>" in (folder / "x.html").read_text(encoding="utf-8")


def test_the_report_says_which_way_is_up_unless_one_is_told(folder):
    (folder / "z.json").write_text(json.dumps({**REPORT, "up": "z"}))
    (folder / "plain.json").write_text(json.dumps(REPORT))
    assert view("stroll.bvh", "--report", "z.json", "-o", "said.html") == 0
    assert view("stroll.bvh", "--report", "plain.json", "--up", "z", "-o", "told.html") == 0
    assert view("stroll.bvh", "--report", "z.json", "--up", "y", "-o", "against.html") == 0
    said, told, against = ((folder / f"{name}.html").read_bytes() for name in ("said", "told", "against"))
    assert said == told != against
