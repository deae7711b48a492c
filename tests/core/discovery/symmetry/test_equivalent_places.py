"""Planes and turns by which grids are their own images."""

import numpy as np
import pytest

from trueup.core.discovery.symmetry.equivalent_places import images_of, symmetries

NOWHERE = np.zeros((0, 3))


def plate(x, y):
    a, b = np.meshgrid(np.linspace(0.0, x, 11), np.linspace(0.0, y, 7))
    return np.column_stack([a.ravel(), b.ravel(), np.zeros(a.size)])


def size(xyz):
    return float(np.linalg.norm(np.ptp(xyz, axis=0)))


def sets(xyz, held=NOWHERE):
    found = (images_of(s, xyz, size(xyz)) for s in symmetries(xyz, size(xyz), held))
    return [rows for rows in found if len(rows)]


def test_a_plate_has_pairs_by_each_plane_and_fours_by_both():
    xyz = plate(5.0, 3.0)
    assert sorted(rows.shape[1] for rows in sets(xyz)) == [2, 2, 4]
    corners = [{0, 10, 66, 76}]
    fours = next(rows for rows in sets(xyz) if rows.shape[1] == 4)
    assert {frozenset(r) for r in fours.tolist()} >= {frozenset(c) for c in corners}


def test_a_plate_clamped_at_one_edge_has_pairs_across_it_alone():
    xyz = plate(5.0, 3.0)
    (pairs,) = sets(xyz, xyz[xyz[:, 0] == 0.0])
    assert {frozenset(p) for p in pairs.tolist()} == {
        frozenset((i + 11 * j, i + 11 * (6 - j))) for i in range(11) for j in range(3)
    }


def test_a_plate_clamped_at_opposite_edges_is_alike_both_ways():
    xyz = plate(5.0, 3.0)
    both = sets(xyz, xyz[np.isin(xyz[:, 0], (0.0, 5.0))])
    assert sorted(rows.shape[1] for rows in both) == [2, 2, 4]


def test_images_are_where_the_plane_puts_them_in_any_frame():
    rng = np.random.default_rng(5)
    Q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    middle = np.array([2.0, 0.0, 0.0])
    one = rng.uniform([0.2, -1.0, 0.0], [3.0, 1.0, 0.5], (60, 3))
    xyz = np.vstack([one, one * [-1.0, 1.0, 1.0]]) + middle
    (pairs,) = sets(xyz @ Q.T)
    there = {frozenset(p) for p in pairs.tolist()}
    assert there == {frozenset((i, i + 60)) for i in range(60)}
    assert len(pairs) == 60


@pytest.mark.parametrize("n", [3, 4])
def test_feet_in_a_ring_are_found(n):
    angle = 2.0 * np.pi * np.arange(n) / n + 0.3
    feet = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(n)])
    rings = np.concatenate(
        [feet * r + [0.0, 0.0, h] for r, h in ((1.0, 0.0), (0.6, 1.5), (0.8, 2))]
    )
    whole = {frozenset(range(k * n, (k + 1) * n)) for k in range(3)}
    assert whole in [{frozenset(r) for r in rows.tolist()} for rows in sets(rings)]


def test_what_is_its_own_image_nowhere_has_none():
    assert not sets(np.random.default_rng(1).normal(size=(80, 3)))


def test_one_place_is_no_image_of_others():
    assert sets(np.ones((1, 3))) == []
