import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_runtime.view.solid import cut, solid
from mlmg_runtime.view.studio import Studio

numbers = st.floats(-0.5, 0.5)


def rays(n=40, width=0.4):
    x, y = np.meshgrid(np.linspace(-width, width, n), np.linspace(-width, width, n))
    ways = np.stack((x, y, np.full_like(x, -1.0)), axis=-1)
    return (ways / np.linalg.norm(ways, axis=-1, keepdims=True)).astype(np.float32)


NEVER = 99.0


def slow_cut(way, ends, radii):
    """Return where a ray first meets one of very many balls on the way from one end to the other."""
    share = np.linspace(0.0, 1.0, 1001)
    centres = ends[0] + share[:, None] * (ends[1] - ends[0])
    radius = radii[0] + share * (radii[1] - radii[0])
    along = centres @ way
    inside = along**2 - np.sum(centres**2, axis=-1) + radius**2
    return np.where(inside > 0.0, along - np.sqrt(np.maximum(inside, 0.0)), NEVER).min()


@given(
    a=st.tuples(numbers, numbers, st.floats(-3.0, -2.0)),
    b=st.tuples(numbers, numbers, st.floats(-3.0, -2.0)),
    radii=st.tuples(st.floats(0.02, 0.2), st.floats(0.02, 0.2)),
)
def test_a_capsule_is_cut_where_the_nearest_of_many_balls_is(a, b, radii):
    ends, radii = np.array([a, b]), np.array(radii)
    ways = rays(6)
    found = np.nan_to_num(cut(ways, ends, radii)[0], posinf=NEVER)
    thin, thick = (
        np.array([[slow_cut(way, ends, share * radii) for way in row] for row in ways.astype(float)])
        for share in (0.99, 1.01)
    )
    # A ray that a body a little thicker or thinner would stop elsewhere grazes its edge.
    clear = thin - thick < 0.02
    assert clear.mean() > 0.5
    assert ((thick - 1e-3 <= found) & (found <= thin + 1e-3))[clear].all()


def test_normals_are_unit_vectors_towards_the_eye():
    ways = rays()
    found, normal = cut(ways, np.array([[-0.3, 0.0, -3.0], [0.3, 0.1, -2.8]]), np.array([0.2, 0.1]))
    shown = np.isfinite(found)
    assert shown.sum() > 50
    assert np.allclose(np.linalg.norm(normal[shown], axis=-1), 1.0, atol=1e-4)
    assert (np.sum(normal[shown] * ways[shown], axis=-1) < 0.05).all()


def test_a_ball_inside_the_other_is_the_other_alone():
    centre = np.array([0.0, 0.0, -3.0])
    found, _ = cut(rays(), np.array([centre, (0.05, 0.0, -3.0)]), np.array([0.3, 0.1]))
    alone, _ = cut(rays(), np.array([centre, centre]), np.array([0.3, 0.3]))
    assert np.array_equal(found, alone)


@pytest.fixture
def studio():
    return Studio((80, 60), 0.0, pitch_rad=0.0, distance_m=4.0)


def shot(studio, centres, radii, colours):
    target = np.array([0.0, 1.0, 0.0])
    return solid(studio, studio.eye(target), np.array(centres), np.array(radii), np.array(colours, dtype=np.float32))


def test_a_ball_covers_a_disc_of_the_right_size(studio):
    body = shot(studio, [[[0.0, 1.0, 0.0]] * 2], [[0.3, 0.3]], [[200, 200, 200]])
    radius = studio.focal * 0.3 / np.sqrt(4.0**2 - 0.3**2)
    assert body.cover.sum() == pytest.approx(np.pi * radius**2, rel=0.03)
    rows, columns = np.indices(body.cover.shape)
    assert np.average(columns + body.left, weights=body.cover) == pytest.approx(39.5, abs=0.1)
    assert np.average(rows + body.top, weights=body.cover) == pytest.approx(29.5, abs=0.1)


def test_what_is_nearer_hides_what_is_behind(studio):
    centres = [[[0.0, 1.0, 0.0]] * 2, [[0.0, 1.0, 1.0]] * 2]
    body = shot(studio, centres, [[0.3, 0.3], [0.1, 0.1]], [[200, 0, 0], [0, 200, 0]])
    red, green, _ = body.colour[30 - body.top, 40 - body.left]
    assert green > 2 * red
    red, green, _ = body.colour[30 - body.top, 40 - body.left + 9]
    assert red > 2 * green


def test_the_side_to_the_light_is_brighter(studio):
    body = shot(studio, [[[0.0, 1.0, 0.0]] * 2], [[0.4, 0.4]], [[200, 200, 200]])
    lit = np.where(body.cover > 0.99, body.colour[..., 0], np.nan)
    height, width = lit.shape
    assert np.nanmean(lit[: height // 2, : width // 2]) > 1.3 * np.nanmean(lit[height // 2 :, width // 2 :])


def test_what_is_behind_the_camera_or_beside_the_picture_is_not_drawn(studio):
    body = shot(studio, [[[0.0, 1.0, 9.0]] * 2, [[30.0, 1.0, 0.0]] * 2], [[0.3, 0.3]] * 2, [[200, 200, 200]] * 2)
    assert body.cover.sum() == 0.0
