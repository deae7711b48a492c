"""The same effect at places that are each other's images."""

from dataclasses import replace

import numpy as np
from tests.core.discovery.strings import N, hidden, searcher

from trueup.core.discovery.effects.candidates import factors_of, places_of, with_twins

NOWHERE = np.zeros((0, 3))


def test_beads_as_far_from_either_wall_are_a_set_of_one_magnitude():
    problem = searcher(hidden()).problem
    single, pairs = with_twins(problem.catalogue[0], problem.catalogue[0].xyz, 1.0, NOWHERE)
    assert {tuple(sorted(c)) for c in pairs.copies} == {
        (i, N - 1 - i) for i in range(N // 2) if N - 1 - 2 * i > 0.05 * (N + 1)
    }
    assert pairs.many(0) == 2
    assert [c is single for c, _ in places_of(pairs, 0)] == [True, True]
    assert {row for _, row in places_of(pairs, 0)} == set(pairs.copies[0])
    own, both = factors_of((single, pairs), problem.basis)
    rows = np.array([3, 1])
    assert np.allclose(both[rows], pairs.factors(problem.basis)[rows])
    i, j = pairs.copies[3]
    expected = np.zeros((N, N))
    expected[i, i] = expected[j, j] = 1.0
    rows_of_one = pairs.acting(3).toarray()
    assert np.allclose(rows_of_one.T @ rows_of_one, expected)
    assert own[rows].shape == (2, 1, N)


def test_images_are_those_of_the_whole_structure_one_end_held():
    """Points that move, without the held bead, have another middle."""
    single = searcher(hidden()).problem.catalogue[0]
    moving = replace(
        single,
        xyz=single.xyz[1:],
        root=single.root[1:],
        where=single.where[1:],
    )
    _, pairs = with_twins(moving, single.xyz, 1.0, NOWHERE)
    assert all(i + j + 2 == N - 1 for i, j in pairs.copies)
