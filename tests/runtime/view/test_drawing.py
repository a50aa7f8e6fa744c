import numpy as np

from mlmg_runtime.view.drawing import draw
from mlmg_runtime.view.studio import camera_path, studio_for


def picture(scene, frame, tints=None):
    studio = studio_for(scene, (120, 150), np.arange(scene.n_frames))
    return np.asarray(draw(scene, frame, studio, camera_path(scene)[frame], tints)).astype(int)


def test_a_picture_shows_a_bright_figure_on_a_dark_floor(scene):
    image = picture(scene, 30)
    assert image.shape == (150, 120, 3)
    bright = image.min(axis=-1) > 110
    rows, columns = np.nonzero(bright)
    assert 0.02 < bright.mean() < 0.4
    assert rows.min() < 40
    assert rows.max() > 110
    assert abs(np.median(columns) - 60) < 15


def test_a_picture_of_another_frame_is_another_picture(scene):
    assert (picture(scene, 0) != picture(scene, 59)).any()


def test_a_tint_colours_what_its_joint_moves_and_nothing_else(scene):
    plain = picture(scene, 30)
    tinted = picture(scene, 30, {scene.joint_names.index("left thigh"): (240, 60, 0)})
    changed = (plain != tinted).any(axis=-1)
    rows, _ = np.nonzero(changed)
    assert 0.002 < changed.mean() < 0.05
    assert rows.min() > 60
    assert (tinted[changed][:, 0] > tinted[changed][:, 2]).mean() > 0.9


def test_a_bare_tree_can_be_drawn_too(random_bvh):
    from mlmg_runtime.view.scene import scene_from_bvh

    assert picture(scene_from_bvh(random_bvh(2), "x"), 5).std() > 1.0
