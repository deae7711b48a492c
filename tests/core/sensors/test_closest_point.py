"""Nearest points on shells, beams and solids."""

import numpy as np
import pytest

from trueup.core.data.geometry import Geometry
from trueup.core.errors import InputError
from trueup.core.sensors.closest_point import place
from trueup.core.sensors.outer_surface import LINE, POINT, QUAD, TRIA, shape_functions, surface_of


def geometry(xyz, **elements):
    xyz = np.asarray(xyz, float)
    return Geometry(np.arange(1, len(xyz) + 1), xyz, "mm", elements)


UNIT_SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
UNIT_CUBE = [*UNIT_SQUARE, *[[x, y, 1] for x, y, _ in UNIT_SQUARE]]


@pytest.mark.parametrize(
    ("point", "foot"),
    [
        ([0.3, 0.6, 0.2], [0.3, 0.6, 0.0]),
        ([-0.4, 0.5, 0.3], [0.0, 0.5, 0.0]),
        ([2.0, 3.0, -1.0], [1.0, 1.0, 0.0]),
    ],
    ids=["above the face", "beyond an edge", "beyond a corner"],
)
@pytest.mark.parametrize(
    "elements",
    [{"quad": np.array([[0, 1, 2, 3]])}, {"tria": np.array([[0, 1, 2], [0, 2, 3]])}],
    ids=["quad", "trias"],
)
def test_foot_on_a_square_is_the_closest_point(point, foot, elements):
    at = place(surface_of(geometry(UNIT_SQUARE, **elements)), [point])
    np.testing.assert_allclose(at.foot[0], foot, atol=1e-12)
    assert at.distance[0] == pytest.approx(np.linalg.norm(np.subtract(point, foot)))


def test_foot_on_a_line_is_the_perpendicular_or_the_end():
    surface = surface_of(geometry([[0, 0, 0], [10, 0, 0]], line=np.array([[0, 1]])))
    at = place(surface, [[4, 3, 0], [14, 3, 0]])
    np.testing.assert_allclose(at.foot, [[4, 0, 0], [10, 0, 0]])
    np.testing.assert_allclose(at.distance, [3, 5])
    assert set(at.kind) == {LINE}


def test_face_wins_over_the_beam_along_its_edge():
    surface = surface_of(
        geometry(UNIT_SQUARE, quad=np.array([[0, 1, 2, 3]]), line=np.array([[0, 1]]))
    )
    assert place(surface, [[0.5, 0.0, 0.1]]).kind[0] == QUAD


def test_inner_faces_of_solids_are_not_surface():
    xyz = [[x, y, z] for x, y, z in UNIT_CUBE] + [[x, y, 2] for x, y, _ in UNIT_SQUARE]
    surface = surface_of(
        geometry(xyz, hexa=np.array([[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]]))
    )
    assert len(surface.kind) == 10
    at = place(surface, [[0.4, 0.45, 1.01]])
    np.testing.assert_allclose(at.foot[0], [0.0, 0.45, 1.01], atol=1e-12)


@pytest.mark.parametrize(
    ("name", "corners", "quads", "trias"),
    [
        ("tetra", [0, 1, 3, 4], 0, 4),
        ("pyramid", [0, 1, 2, 3, 4], 1, 4),
        ("penta", [0, 1, 3, 4, 5, 7], 3, 2),
        ("hexa", range(8), 6, 0),
    ],
)
def test_faces_of_each_solid_close_it(name, corners, quads, trias):
    surface = surface_of(geometry(UNIT_CUBE, **{name: np.array([list(corners)])}))
    assert np.count_nonzero(surface.kind == QUAD) == quads
    assert np.count_nonzero(surface.kind == TRIA) == trias
    # A closed surface with outward normals: the areas as vectors add up to nothing.
    p = surface.xyz[surface.corners]
    area = 0.5 * np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
    flat = surface.kind == TRIA
    area[flat] = 0.5 * np.cross(p[flat, 1] - p[flat, 0], p[flat, 2] - p[flat, 0])
    np.testing.assert_allclose(area.sum(axis=0), 0, atol=1e-12)


def test_hexa_and_penta_that_share_a_face_hide_it():
    xyz = [*UNIT_CUBE, [2, 0.5, 0], [2, 0.5, 1]]
    surface = surface_of(
        geometry(xyz, hexa=np.array([range(8)]), penta=np.array([[1, 8, 2, 5, 9, 6]]))
    )
    assert len(surface.kind) == 6 + 5 - 2


def test_foot_on_a_warped_quad_is_on_the_bilinear_surface_and_nearest():
    xyz = np.array([[0, 0, 0], [2, 0, 0.5], [2.2, 1.5, -0.3], [0.1, 1.2, 0.6]])
    surface = surface_of(geometry(xyz, quad=np.array([[0, 1, 2, 3]])))
    points = np.random.default_rng(1).uniform([-1, -1, -1], [3, 3, 2], (60, 3))
    at = place(surface, points, reach=10.0)
    s, t = (g.ravel() for g in np.meshgrid(*[np.linspace(0, 1, 401)] * 2))
    dense = shape_functions(np.full(len(s), QUAD), s, t)[0] @ xyz
    best = np.linalg.norm(points[:, None] - dense, axis=2).min(axis=1)
    assert np.all(at.distance <= best + 1e-12)
    np.testing.assert_allclose(at.distance, best, atol=1e-4)
    np.testing.assert_allclose(shape_functions(at.kind, at.s, at.t)[0] @ xyz, at.foot, atol=1e-12)


def test_search_finds_a_long_element_whose_grids_are_far_away():
    fine = np.array([[x, 2.0, 0] for x in np.linspace(-1, 1, 41)])
    xyz = np.vstack([[[-100, 0, 0], [100, 0, 0]], fine])
    lines = np.array([[0, 1], *[[i, i + 1] for i in range(2, 42)]])
    at = place(surface_of(geometry(xyz, line=lines)), [[0.3, 0.5, 0.0]])
    np.testing.assert_allclose(at.foot[0], [0.3, 0, 0], atol=1e-12)


def test_point_beyond_reach_still_gets_a_facet_with_its_true_distance():
    surface = surface_of(geometry(UNIT_SQUARE, quad=np.array([[0, 1, 2, 3]])))
    at = place(surface, [[0.5, 0.5, 1e6]], reach=0.1)
    assert at.distance[0] == pytest.approx(1e6)


def test_geometry_without_elements_is_a_cloud_of_points():
    surface = surface_of(geometry(UNIT_SQUARE))
    at = place(surface, [[0.9, 0.2, 0.0]])
    assert at.kind[0] == POINT
    assert at.corners[0, 0] == 1


def test_grids_far_off_that_belong_to_no_element_do_not_count():
    surface = surface_of(geometry([*UNIT_SQUARE, [500, 0, 0]], quad=np.array([[0, 1, 2, 3]])))
    assert surface.size == pytest.approx(np.sqrt(2))
    assert surface.nearest_grid(np.array([[499.0, 0, 0]]))[0][0] in (1, 2)


def test_elements_on_grids_that_cannot_be_used_are_left_out():
    usable = np.array([True, True, True, False])
    surface = surface_of(
        geometry(UNIT_SQUARE, quad=np.array([[0, 1, 2, 3]]), line=np.array([[0, 1]])), usable
    )
    assert list(surface.kind) == [LINE]
    with pytest.raises(InputError, match="no grid with displacements"):
        surface_of(geometry(UNIT_SQUARE), np.zeros(4, bool))


def test_samples_lie_on_the_surface_and_cover_it_evenly():
    n = 20
    x = np.linspace(0, 1, n + 1) ** 2  # uneven mesh
    xyz = [[a, b, 0] for a in x for b in np.linspace(0, 1, n + 1)]
    k = np.arange(n * (n + 1)).reshape(n, n + 1)[:, :-1].ravel()
    surface = surface_of(geometry(xyz, quad=np.stack([k, k + n + 1, k + n + 2, k + 1], axis=1)))
    points, facets = surface.samples(4000)
    assert points.shape == (4000, 3)
    assert place(surface, points).distance.max() < 1e-12
    share = np.histogram2d(points[:, 0], points[:, 1], bins=5, range=[[0, 1]] * 2)[0] / 4000
    np.testing.assert_allclose(share, 1 / 25, rtol=0.25)
    assert len(facets) == 4000
