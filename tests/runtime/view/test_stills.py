from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

from mlmg_runtime.view import stills
from mlmg_runtime.view.captions import Command, Story
from mlmg_runtime.view.scene import scene_from_bvh
from mlmg_runtime.view.stills import evenly_spread, moments, write_png


@pytest.fixture(autouse=True)
def small(monkeypatch):
    monkeypatch.setattr(stills, "_PICTURE", (120, 180))


def test_moments_are_spread_from_the_first_frame_to_the_last():
    assert evenly_spread(101, 5) == [0, 25, 50, 75, 100]
    assert evenly_spread(3) == [0, 1, 2]
    assert evenly_spread(1) == [0]


def story(*commands):
    return Story(tuple(Command("X", *numbers) for numbers in commands))


def test_without_a_report_moments_are_spread_over_the_part():
    assert moments(Story(), range(100, 201)) == [100 + frame for frame in evenly_spread(101)]


def test_each_command_is_shown_in_the_middle_of_its_time():
    told = story((0, 0, 90), (90, 150, 200), (200, 260, 270), (270, 280, 400), (400, 420, 440), (440, 460, 500))
    assert moments(told, range(500)) == [45, 175, 265, 340, 430, 480]


def test_a_command_that_is_left_on_arrival_is_shown_then_and_one_that_takes_no_time_is_not():
    assert {49, 75} < set(moments(story((0, 0, 0), (0, 50, 50), (50, 50, 100)), range(100)))
    assert 0 in moments(story((0, 0, 0), (0, 50, 50)), range(100))  # for it is far from the other


def test_few_commands_leave_room_for_what_is_far_from_them():
    assert moments(story((0, 0, 100)), range(101)) == sorted({50, *moments(story((0, 0, 100)), range(101))})
    chosen = moments(story((0, 0, 20), (20, 30, 600)), range(600))
    assert {10, 315} < set(chosen)
    assert len(chosen) == 6
    assert max(after - before for before, after in pairwise(chosen)) < 200
    assert moments(story((0, 0, 3)), range(3)) == [0, 1, 2]


def test_of_many_commands_eight_are_shown():
    many = story(*((100 * at, 100 * at, 100 * at + 100) for at in range(20)))
    chosen = moments(many, range(2000))
    assert len(chosen) == 8
    assert (chosen[0], chosen[-1]) == (50, 1950)
    assert all(frame % 100 == 50 for frame in chosen)


def test_only_commands_in_the_part_count():
    assert 50 not in moments(story((0, 0, 100), (100, 100, 200)), range(60, 200))
    assert 150 in moments(story((0, 0, 100), (100, 100, 200)), range(60, 200))


def pixels(path):
    with Image.open(path) as image:
        return np.asarray(image).astype(int)


def panels(path, n):
    image = pixels(path)
    assert image.shape[1] == n * 124 - 4
    return [image[:, at * 124 : at * 124 + 120] for at in range(n)]


def test_a_strip_has_a_picture_and_a_caption_for_each_moment(tmp_path, scene):
    write_png(scene, tmp_path / "strip.png", [0, 35, 59])
    for panel in panels(tmp_path / "strip.png", 3):
        assert (panel[:180].min(axis=-1) > 120).mean() > 0.02
        assert (panel[180:].min(axis=-1) > 120).mean() > 0.01


def test_the_part_that_a_graph_moves_is_coloured(tmp_path, scene):
    write_png(scene, tmp_path / "strip.png", [0, 45])
    before, during = panels(tmp_path / "strip.png", 2)
    orange = [(panel[:180, :, 0] > panel[:180, :, 2] + 60).mean() for panel in (before, during)]
    assert orange[0] == 0.0
    assert orange[1] > 0.005


def test_more_than_eight_moments_go_on_in_a_second_row(tmp_path, person):
    scene = scene_from_bvh(person(), "x")
    write_png(scene, tmp_path / "strip.png", list(range(9)))
    write_png(scene, tmp_path / "row.png", [0])
    rows, row = pixels(tmp_path / "strip.png"), pixels(tmp_path / "row.png")
    assert rows.shape == (2 * len(row), 8 * 124 - 4, 3)
    assert (rows[len(row) :, :120].min(axis=-1) > 120).any()
    assert not (rows[len(row) :, 124:].min(axis=-1) > 120).any()


def test_a_picture_that_cannot_be_written_leaves_the_old_one(tmp_path, monkeypatch, scene):
    target = tmp_path / "strip.png"
    target.write_bytes(b"old")
    monkeypatch.setattr(Image.Image, "save", lambda *_, **__: (_ for _ in ()).throw(KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        write_png(scene, target, [0])
    assert target.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [target]
