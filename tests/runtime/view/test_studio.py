import numpy as np

from mlmg_runtime.view.scene import scene_from_bvh
from mlmg_runtime.view.studio import Studio, camera_path, studio_for


def test_the_axes_of_a_camera_are_orthonormal():
    axes = Studio((10, 10), 0.7, pitch_rad=0.3).axes
    assert np.allclose(axes @ axes.T, np.eye(3))
    assert np.isclose(np.linalg.det(axes), 1.0)


def test_the_middle_ray_goes_to_the_target():
    studio = Studio((11, 11), 0.7)
    target = np.array([1.0, 2.0, 3.0])
    eye = studio.eye(target)
    assert np.allclose(eye + studio.distance_m * studio.rays[5, 5], target, atol=1e-5)


def test_fine_rays_share_out_each_pixel():
    studio = Studio((8, 6), 0.0, oversampling=3)
    assert studio.fine_rays.shape == (18, 24, 3)
    means = studio.fine_rays.reshape(6, 3, 8, 3, 3).mean(axis=(1, 3))
    assert np.allclose(means, studio.rays, atol=1e-3)


def test_the_camera_follows_smoothly(scene):
    path = camera_path(scene)
    assert path.shape == (scene.n_frames, 3)
    assert np.allclose(path[20:40, 2], scene.positions[20:40, scene.root, 2], atol=1e-5)
    assert np.ptp(path[:, 1]) == 0.0


def test_the_camera_of_a_single_frame_looks_at_it(person):
    scene = scene_from_bvh(person(n_frames=1), "x")
    assert np.allclose(camera_path(scene)[0, [0, 2]], scene.positions[0, scene.root, [0, 2]])


def test_every_point_fits_into_the_picture(scene):
    for size in ((250, 360), (640, 480), (100, 900)):
        studio = studio_for(scene, size, np.arange(scene.n_frames))
        seen = (scene.positions - camera_path(scene)[:, None] - studio.distance_m * studio.axes[2]) @ studio.axes.T
        across, upright = (studio.focal * np.abs(seen[..., :2] / seen[..., 2:])).max(axis=(0, 1))
        assert across <= size[0] / 2
        assert upright <= size[1] / 2


def test_the_camera_stands_ahead_of_the_figure(scene):
    studio = studio_for(scene, (100, 100), np.arange(3))
    assert studio.axes[2] @ [np.sin(scene.heading_rad), 0.0, np.cos(scene.heading_rad)] > 0.7
