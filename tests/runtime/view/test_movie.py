import numpy as np
import pytest
from PIL import Image

from mlmg_runtime.view import movie
from mlmg_runtime.view.movie import write_gif
from mlmg_runtime.view.scene import scene_from_bvh


@pytest.fixture(autouse=True)
def small(monkeypatch):
    monkeypatch.setattr(movie, "SIZE", (160, 120))


def frames_of(path):
    shots, durations = [], []
    with Image.open(path) as image:
        for index in range(image.n_frames):
            image.seek(index)
            shots.append(np.asarray(image.convert("RGB")).astype(int))
            durations.append(image.info["duration"])
        assert image.info["loop"] == 0
    return shots, durations


def test_a_movie_has_fifteen_pictures_a_second_and_lasts_as_long_as_the_motion(tmp_path, scene):
    told = []
    assert write_gif(scene, tmp_path / "x.gif", progress=lambda *told_now: told.append(told_now)) == range(60)
    shots, durations = frames_of(tmp_path / "x.gif")
    assert len(shots) == 30
    assert sum(durations) == 2000
    assert shots[0].shape == (120, 160, 3)
    assert told[-1] == ("drawing", 30, 30)


def test_pictures_show_a_figure_that_moves(tmp_path, scene):
    write_gif(scene, tmp_path / "x.gif", range(20, 50))
    shots, _ = frames_of(tmp_path / "x.gif")
    assert len(shots) == 15
    assert (shots[0] != shots[-1]).any(axis=-1).mean() > 0.01
    # The camera follows: the figure stays in the middle, the floor moves.
    assert all((shot[26:94, 60:100].min(axis=-1) > 110).mean() > 0.1 for shot in shots)


def test_accents_keep_their_colours(tmp_path, scene):
    write_gif(scene, tmp_path / "x.gif", range(44, 48))
    shots, _ = frames_of(tmp_path / "x.gif")
    assert (shots[0][..., 0] > shots[0][..., 2] + 90).mean() > 0.003


def test_a_long_movie_is_cut_and_says_what_it_shows(tmp_path, monkeypatch, scene):
    monkeypatch.setattr(movie, "LONGEST_S", 0.5)
    assert write_gif(scene, tmp_path / "x.gif", range(10, 60)) == range(10, 25)


def test_a_motion_of_fewer_frames_than_pictures_shows_each_once(tmp_path, person):
    from dataclasses import replace

    slow = scene_from_bvh(replace(person(n_frames=5), frame_time_s=0.2), "x")
    write_gif(slow, tmp_path / "x.gif")
    shots, durations = frames_of(tmp_path / "x.gif")
    assert len(shots) == 5
    assert sum(durations) == 1000
