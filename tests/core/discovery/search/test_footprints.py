"""Footprints of masses on shells: where a disc between the grids of a mesh weighs on them."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial import Delaunay

from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.effects.effect_laws import MassLaw
from trueup.core.discovery.search.footprints import (
    FootLaw,
    at_the_edge,
    shares,
    surroundings,
    surroundings_of_each,
)

GRID = np.array([(i, j) for i in range(9) for j in range(9)], dtype=float)


@pytest.mark.parametrize("middle", [(4.0, 4.0), (4.3, 3.6), (4.5, 4.5)])
@pytest.mark.parametrize("radius", [0.2, 0.7, 1.5])
def test_shares_balance_at_the_middle_and_spread_as_the_disc_does(middle, radius):
    own = shares(Delaunay(GRID), np.array(middle), radius)
    assert own.sum() == pytest.approx(1.0)
    assert own @ GRID == pytest.approx(middle, abs=0.03)
    spread = own @ np.sum((GRID - middle) ** 2, axis=1)
    assert 0.45 * radius**2 < spread < 0.5 * radius**2 + 0.6


def test_a_disc_over_the_edge_weighs_on_what_is_there():
    own = shares(Delaunay(GRID), np.array([0.0, 4.0]), 1.0)
    assert own.sum() == pytest.approx(1.0)
    assert (own @ GRID)[0] > 0.2


@pytest.mark.parametrize(
    ("middle", "edge"), [((0.5, -0.5), False), ((0.5, -1.1), True), ((-1.2, 0.0), True)]
)
def test_a_middle_that_went_as_far_as_it_may_is_at_the_edge(middle, edge):
    laws = (MassLaw(), FootLaw(()))
    searcher = SimpleNamespace(
        problem=SimpleNamespace(catalogue=[SimpleNamespace(law=law) for law in laws])
    )
    suspects = (Suspect(0, 3, (5.0,)), Suspect(1, 0, (-7.0, *middle, 0.2)))
    assert at_the_edge(searcher, SimpleNamespace(suspects=suspects)) is edge


def structure(dimension):
    corners = np.array([(9 * i + j, 9 * i + j + 9, 9 * i + j + 10, 9 * i + j + 1)
                        for i in range(8) for j in range(8)])  # fmt: skip
    geometry = SimpleNamespace(xyz=np.column_stack([GRID, np.zeros(len(GRID))]))
    member = SimpleNamespace(corners=corners, element=SimpleNamespace(dimension=dimension))
    return SimpleNamespace(model=SimpleNamespace(geometry=geometry), members=[member])


@pytest.mark.parametrize("place", [(4.2, 4.0, 0.0), (1.0, 7.5, 0.0)])
def test_what_a_grid_bears_does_not_hang_on_the_order_of_grids_nor_on_the_axes(place):
    order = np.random.default_rng(3).permutation(len(GRID))
    turn = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    one, other = structure(2), structure(2)
    stretched = one.model.geometry.xyz * [2.0, 1.0, 1.0]
    one.model.geometry.xyz = stretched
    other.model.geometry.xyz = stretched[order] @ turn.T
    other.members[0].corners = np.argsort(order)[other.members[0].corners]
    spot, theta = np.array(place) * [2.0, 1.0, 1.0], np.array([0.3, -0.6, 0.1])
    a, b = surroundings(one, spot), surroundings(other, spot @ turn.T)
    both = [np.zeros(len(GRID)), np.zeros(len(GRID))]
    both[0][a.grids] = a.shares(theta)
    both[1][order[b.grids]] = b.shares(theta)
    np.testing.assert_allclose(both[1], both[0], atol=1e-12)


def test_places_on_shells_have_surroundings_and_others_none():
    place = np.array([4.2, 4.0, 0.0])
    around = surroundings(structure(2), place)
    assert around.mesh == pytest.approx(1.0)
    own = around.shares(np.array([0.5, 0.0, 0.0]))
    assert own.sum() == pytest.approx(1.0)
    assert np.linalg.norm(own @ around.xyz - place) == pytest.approx(0.5, abs=0.05)
    assert surroundings(structure(1), place) is None
    assert surroundings(structure(2), place + np.array([0.0, 0.0, 9.0])) is None


@pytest.mark.parametrize("theta", [(-1.0, 0.0, 0.0, -0.4), (0.5, 0.3, -0.6, 0.2)])
def test_a_mass_keeps_its_size_as_its_disc_moves_and_grows(theta):
    around = surroundings(structure(2), np.array([4.2, 4.0, 0.0]))
    theta, rows = np.array([theta]), np.zeros(1, int)
    law = FootLaw((around,))
    value, slope = law.value(theta, rows)[0], law.slope(theta, rows)[0]
    assert value.reshape(-1, 3).sum(axis=0) == pytest.approx(np.exp(theta[0, 0]))
    assert slope[0] == pytest.approx(value)
    assert slope[1:].sum(axis=1) == pytest.approx(0.0, abs=1e-9)
    moved = slope[1:, ::3] @ around.laid(around.xyz) / np.exp(theta[0, 0])
    assert moved[:2] == pytest.approx(np.eye(2), abs=0.1)
    assert moved[2] == pytest.approx(0.0, abs=0.1)


def test_a_disc_holds_the_points_within_its_radius_about_its_middle():
    around = surroundings(structure(2), np.array([4.2, 4.0, 0.0]))
    theta = np.array([0.4, -0.3, np.log(1.3)])
    middle = np.linalg.lstsq(around.axes, around.mesh * theta[:2], rcond=None)[0] + around.place
    away = np.linalg.norm(around.xyz - middle, axis=1)
    assert 0 < np.count_nonzero(away < 1.3) < len(away)
    assert np.array_equal(around.within(theta, around.xyz), away < 1.3)


def test_discs_of_twins_are_each_others_images():
    places, mirror = np.array([[2.2, 4.0, 0.0], [5.8, 4.0, 0.0]]), np.diag([-1.0, 1.0, 1.0])
    twins = SimpleNamespace(single=SimpleNamespace(xyz=places), copies=((0, 1),),
                            maps=np.stack([np.eye(3), mirror]))  # fmt: skip
    around = surroundings_of_each(structure(2), twins, 0)
    value = FootLaw(around).value(np.array([[-1.0, 0.4, 0.7, 0.2]]), np.zeros(1, int))[0]
    one, other = (v[::3][: len(a.grids)] for v, a in zip(np.split(value, 2), around, strict=True))
    assert one.sum() == pytest.approx(np.exp(-1.0)) == pytest.approx(other.sum())
    middle, image = (m @ a.xyz / m.sum() for m, a in zip((one, other), around, strict=True))
    assert np.linalg.norm(middle - places[0]) == pytest.approx(np.hypot(0.4, 0.7), abs=0.1)
    assert image == pytest.approx(middle @ mirror + [8.0, 0.0, 0.0], abs=0.05)
