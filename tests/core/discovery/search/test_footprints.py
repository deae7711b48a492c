"""Footprints of masses on shells: where a disc between the grids of a mesh weighs on them."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial import Delaunay

from trueup.core.discovery.search.footprints import _discs, _shares

GRID = np.array([(i, j) for i in range(9) for j in range(9)], dtype=float)


@pytest.mark.parametrize("middle", [(4.0, 4.0), (4.3, 3.6), (4.5, 4.5)])
@pytest.mark.parametrize("radius", [0.2, 0.7, 1.5])
def test_shares_balance_at_the_middle_and_spread_as_the_disc_does(middle, radius):
    shares = _shares(Delaunay(GRID), np.array(middle), radius)
    assert shares.sum() == pytest.approx(1.0)
    assert shares @ GRID == pytest.approx(middle, abs=0.03)
    spread = shares @ np.sum((GRID - middle) ** 2, axis=1)
    assert 0.45 * radius**2 < spread < 0.5 * radius**2 + 0.6


def test_a_disc_over_the_edge_weighs_on_what_is_there():
    shares = _shares(Delaunay(GRID), np.array([0.0, 4.0]), 1.0)
    assert shares.sum() == pytest.approx(1.0)
    assert (shares @ GRID)[0] > 0.2


def structure(dimension):
    corners = np.array([(9 * i + j, 9 * i + j + 9, 9 * i + j + 10, 9 * i + j + 1)
                        for i in range(8) for j in range(8)])  # fmt: skip
    geometry = SimpleNamespace(xyz=np.column_stack([GRID, np.zeros(len(GRID))]))
    member = SimpleNamespace(corners=corners, element=SimpleNamespace(dimension=dimension))
    return SimpleNamespace(model=SimpleNamespace(geometry=geometry), members=[member])


def test_discs_lie_about_a_place_on_shells_and_nowhere_else():
    place = np.array([4.2, 4.0, 0.0])
    discs = _discs(structure(2), place, 0.5, 0.25)
    assert len(discs) == 27
    for middle, radius, grids, shares in discs:
        assert np.linalg.norm(middle - place) < 0.45
        assert 0.5 * np.exp(-0.25) <= radius <= 0.5 * np.exp(0.25)
        assert shares.sum() == pytest.approx(1.0)
        assert len(grids) == len(shares)
    assert _discs(structure(1), place, None, 0.5) == []
    assert _discs(structure(2), place + np.array([0.0, 0.0, 9.0]), None, 0.5) == []
