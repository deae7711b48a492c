"""Twin masses on a string that is off everywhere, told by errors that the test itself tells."""

from dataclasses import replace

import numpy as np
import pytest
from tests.core.discovery.strings import K, N, hidden, searcher

from trueup.core.discovery.effects.candidates import factors_of, with_twins
from trueup.core.discovery.likelihood.estimated_noise import WIDE, by_noise, estimated
from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.search.model_selection import judge
from trueup.core.discovery.search.robust_search import robust


def off_everywhere(truth, size, seed):
    """K with a random error of relative `size` in modal coordinates, M as it is."""
    k, m = truth
    values, vectors = np.linalg.eigh(K)
    E = np.random.default_rng(seed).normal(size=(N, N))
    root = vectors * np.sqrt(values)
    return k + size * root @ (0.5 * (E + E.T)) @ root.T, m


def two_alike(s):
    singles = s.problem.catalogue[0]
    catalogue = (*s.problem.catalogue, *with_twins(singles, singles.xyz, s.size)[1:])
    problem = replace(
        s.problem, catalogue=catalogue, factors=factors_of(catalogue, s.problem.basis)
    )
    return replace(s, problem=problem, coarse=(*s.coarse, np.zeros(0, np.int64)))


@pytest.mark.parametrize("seed", range(3))
def test_twin_masses_are_found_though_every_mode_is_off(seed):
    truth = off_everywhere(hidden(masses=[(5, 4.0), (26, 4.0)]), 0.04, seed)
    s, found = robust(two_alike(searcher(truth)))
    best = found.levels[judge(s, found).accepted]
    (pair,) = best.suspects
    c = s.problem.catalogue[pair.kind]
    places = c.copies[pair.row]
    assert max(abs(a - b) for a, b in zip(sorted(places), (5, 26), strict=True)) <= 1
    assert np.exp(pair.theta[0]) == pytest.approx(4.0, rel=0.3)


def test_the_errors_are_estimated_from_what_a_right_model_leaves():
    rng = np.random.default_rng(2)
    s = searcher(hidden(), scatter=(0.03, 0.01), seed=8)
    problem = by_noise(s.problem, WIDE)
    noise = estimated(problem, evaluate(problem, np.zeros(2), ()))
    assert noise.frequency == pytest.approx(0.03, rel=0.4)
    far = problem.whole.frequencies_hz * np.where(rng.permutation(12) < 2, 1.4, 1.0)
    strayed = replace(problem, whole=replace(problem.whole, frequencies_hz=far))
    again = estimated(strayed, evaluate(strayed, np.zeros(2), ()))
    assert again.frequency == pytest.approx(noise.frequency, rel=0.6)
