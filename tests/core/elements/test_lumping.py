"""Lumped mass of second-order elements."""

import numpy as np
import pytest

from trueup.core.elements.middle_nodes import to_middle_nodes
from trueup.core.elements.surfaces.curved_shell import TRIA6
from trueup.core.elements.volumes.hexa import HEXA20
from trueup.core.elements.volumes.penta import PENTA15
from trueup.core.elements.volumes.pointed import PYRAMID13, TETRA10
from trueup.core.elements.volumes.solid import solid_mass

CORNERS = {
    20: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
    15: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]],
    13: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1]],
    10: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
}


def _placed(solid, rng, bend):
    corner = np.array(CORNERS[solid.nodes], float) * [3.0, 1.0, 0.5]
    corner = corner + 0.1 * rng.uniform(-1, 1, corner.shape)
    middle = np.array([0.5 * (corner[i] + corner[j]) for i, j in solid.edges])
    return np.concatenate([corner, middle + bend * rng.uniform(-1, 1, middle.shape)])


def _diagonal(solid, xyz):
    return np.diag(solid_mass(solid, xyz[None], np.ones(1), False)[0])[::3]


def test_straight_tetrahedron():
    """Opposite edges share 1/5 - d**2 / (10 sum d**2) each, d from middle to middle."""
    xyz = _placed(TETRA10, np.random.default_rng(1), 0.0)
    m = _diagonal(TETRA10, xyz)
    middle = xyz[4:]
    opposite = [(0, 5), (1, 3), (2, 4)]
    d = np.array([np.sum((middle[i] - middle[j]) ** 2) for i, j in opposite])
    expected = 0.2 - 0.1 * d / d.sum()
    for (i, j), share in zip(opposite, expected, strict=True):
        assert m[4 + i] / m.sum() == pytest.approx(share, rel=1e-9)
        assert m[4 + j] / m.sum() == pytest.approx(share, rel=1e-9)


@pytest.mark.parametrize("solid", [HEXA20, PENTA15, PYRAMID13, TETRA10], ids=lambda s: str(s.nodes))
@pytest.mark.parametrize("bend", [0.0, 0.05])
def test_mass_and_centre_of_gravity_stay(solid, bend):
    xyz = _placed(solid, np.random.default_rng(solid.nodes), bend)
    m = _diagonal(solid, xyz)
    M = solid_mass(solid, xyz[None], np.ones(1), True)[0][::3, ::3]
    assert m.sum() == pytest.approx(M.sum(), rel=1e-12)
    np.testing.assert_allclose(m @ xyz, M.sum(axis=0) @ xyz, rtol=1e-10, atol=1e-12)
    assert not m[: solid.nodes - len(solid.edges)].any()
    assert (m >= 0.0).all()


def test_flat_triangle():
    corner = np.array([[0.0, 0, 0], [3.0, 0, 0], [0.0, 1.0, 0]])
    xyz = np.concatenate([corner, [0.5 * (corner[i] + corner[j]) for i, j in TRIA6.edges]])
    m = np.diag(TRIA6.mass(xyz[None], np.array([2.0]), False)[0])[::6]
    assert m.sum() == pytest.approx(3.0)
    np.testing.assert_allclose(m @ xyz / 3.0, corner.mean(axis=0), atol=1e-12)


def test_an_element_without_mass_gets_none_and_leaves_the_others_theirs():
    square = np.array([[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]], dtype=float)
    xyz = np.concatenate([square, 0.5 * (square + np.roll(square, -1, axis=0))])
    share = np.array([[-1.0 / 12.0] * 4 + [1.0 / 3.0] * 4])
    both = to_middle_nodes(np.vstack([share, 0.0 * share]), np.stack([xyz, xyz]))
    np.testing.assert_allclose(both, [[0.0] * 4 + [0.25] * 4, [0.0] * 8], atol=1e-12)
