import base64
import json
import re
from importlib.resources import files

import numpy as np
import pytest

from mlmg_runtime.view import html
from mlmg_runtime.view.html import page_of, write_html
from mlmg_runtime.view.scene import scene_from_bvh


@pytest.fixture(scope="module")
def page(scene):
    return page_of([scene])


def data_of(page):
    return json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', page, re.DOTALL)[1])


def decoded(scene):
    """Return the positions as the player works them out, shape (n_frames, n_points, 3)."""
    path = np.frombuffer(base64.b64decode(scene["path"]), "<f4").reshape(-1, 1, 3)
    steps = np.frombuffer(base64.b64decode(scene["offsets"]), "<i2").reshape(scene["nFrames"], scene["nPoints"], 3)
    return path + scene["quantum"] * steps


def test_a_page_asks_for_nothing_from_anywhere(page):
    assert not re.findall(r"(?:https?:)?//[a-z0-9-]+\.[a-z]", page)
    assert not re.search(r"<link(?![^>]*href=\"data:)|<script[^>]*\bsrc\b|@import|url\(|fetch\(|XMLHttpRequest", page)


def test_positions_come_back_to_a_tenth_of_a_millimetre(scene, page):
    positions = decoded(data_of(page)["scenes"][0])
    assert np.abs(positions - scene.positions).max() < 1e-4


def test_a_long_way_from_the_origin_costs_no_accuracy(person):
    bvh = person()
    frames = bvh.frames.copy()
    frames[:, 0] += 20000.0
    scene = scene_from_bvh(type(bvh)(bvh.joints, bvh.frame_time_s, frames), "far away")
    assert np.abs(decoded(data_of(page_of([scene]))["scenes"][0]) - scene.positions).max() < 1e-4


def test_a_frame_takes_twelve_bytes_and_six_for_each_point(scene, page):
    data = data_of(page)["scenes"][0]
    n_bytes = sum(len(base64.b64decode(data[key])) for key in ("path", "offsets"))
    assert n_bytes == scene.n_frames * (12 + 6 * scene.positions.shape[1])


def test_as_many_frames_as_a_page_can_hold_are_told_before_they_are_drawn(scene, person):
    points, joints = scene.positions.shape[1], person().joints
    assert html.most_frames(joints) * (12 + 6 * points) <= html.MOST_BYTES
    assert (html.most_frames(joints) + 1) * (12 + 6 * points) > html.MOST_BYTES


def test_capsules_come_back_as_balls_and_pairs(scene, page):
    data = data_of(page)["scenes"][0]
    assert len(data["capsules"]) == len(scene.capsules)
    for (first, second, joint), capsule in zip(data["capsules"], scene.capsules, strict=True):
        assert joint == capsule.joint
        for at, ball in ((first, capsule.first), (second, capsule.second)):
            assert data["balls"][at] == pytest.approx([ball.a, ball.b, ball.share, ball.radius], abs=1e-5)


def test_the_story_is_in_the_page(scene, page):
    data = data_of(page)["scenes"][0]
    assert [command["text"] for command in data["commands"]] == ["Idle_01", "WALK for 1 sec", "Sub TALK </script>"]
    full, upper = data["tracks"]
    assert full["joints"] == []
    assert upper["joints"] == sorted(scene.joints_of_graphs["Upper-Body"])
    assert full["runs"] == [[0, 60]]
    assert upper["runs"] == [[30, 58]]
    assert [stretch["kind"] for stretch in full["stretches"]] == ["clip", "transition", "clip"]


def test_text_from_outside_cannot_break_out_of_its_place(person):
    scene = scene_from_bvh(person(), '<img src=x onerror=alert(1)> & "co" @DATA@')
    page = page_of([scene])
    assert "<img" not in page
    assert "<title>&lt;img src=x onerror=alert(1)&gt; &amp; &quot;co&quot; @DATA@</title>" in page
    assert data_of(page)["scenes"][0]["name"] == scene.name


def test_several_motions_are_in_one_page(scene, person):
    data = data_of(page_of([scene, scene_from_bvh(person(n_frames=9), "short")]))
    assert [(one["name"], one["nFrames"]) for one in data["scenes"]] == [("stroll", 60), ("short", 9)]


def test_every_file_of_the_player_is_in_the_page(page):
    for file in files("mlmg_runtime.view").joinpath("player").iterdir():
        if file.name.endswith((".js", ".css")):
            assert file.read_text(encoding="utf-8") in page, file.name


def test_a_page_is_written_as_utf_8(tmp_path, person):
    write_html([scene_from_bvh(person(), "走路")], tmp_path / "x.html")
    assert "<title>走路</title>" in (tmp_path / "x.html").read_text(encoding="utf-8")
