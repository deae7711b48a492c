"""A mass on a spring of its own: closed forms, the first-order misfit, and finding it."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as la
from tests.core.discovery.strings import K, M, N, hidden, searcher

from trueup.core.discovery.effects.candidates import Suspect, changed, magnitudes
from trueup.core.discovery.effects.effect_laws import Law, TunedLaw
from trueup.core.discovery.likelihood.map_fit import _normal_equations, evaluate, fit
from trueup.core.discovery.search.coarse_scan import promising
from trueup.core.discovery.search.exact_scan import _attached, scan
from trueup.core.discovery.search.model_selection import chosen, price
from trueup.core.discovery.search.strategy import searched

RIGID = TunedLaw(np.zeros((1, 1)), 0.0)
FIRST = np.zeros(1, np.int64)
STRING_HZ = np.sqrt(la.eigh(K, M, eigvals_only=True)) / (2.0 * np.pi)


@pytest.mark.parametrize("mu", [0.01, 0.1, 0.5])
@pytest.mark.parametrize("tuning", [0.7, 1.0, 1.3])
def test_one_mass_with_an_absorber_has_den_hartogs_two_frequencies(mu, tuning):
    """(ω/Ω)⁴ − (1 + f²(1+μ)) (ω/Ω)² + f² = 0, Den Hartog, Mechanical Vibrations, 3.2."""
    big, omega = 3.0, 40.0
    theta = np.log([[mu * big, tuning * omega / (2.0 * np.pi)]])
    values, _ = _attached(
        np.array([omega**2]),
        np.array([[[1.0 / np.sqrt(big)]]]),
        RIGID.value(theta, FIRST),
        1.0 / RIGID.flexibility(theta, FIRST),
    )
    expected = np.roots([1.0, -(1.0 + tuning**2 * (1.0 + mu)), tuning**2])
    np.testing.assert_allclose(values[0] / omega**2, np.sort(expected), rtol=1e-12)


def test_flexibility_that_a_basis_lacks_is_in_line_with_its_spring():
    theta, lost = np.log([[0.2, 5.0]]), 3e-3
    law = RIGID.on_basis(FIRST, np.array([[lost]]), np.zeros(0), 0.0)
    spring = 0.2 * (2.0 * np.pi * 5.0) ** 2
    assert law.flexibility(theta, FIRST)[0, 0] == pytest.approx(1.0 / spring + lost)


class Mine(Law):
    """The law of an absorber as one might write it outside of the package."""

    on = "A"

    def __init__(self, theirs: TunedLaw):
        self.theirs = theirs

    def value(self, theta, rows):
        return self.theirs.value(theta, rows)

    def slope(self, theta, rows):
        return self.theirs.slope(theta, rows)

    def flexibility(self, theta, rows):
        return self.theirs.flexibility(theta, rows)

    def flexibility_slope(self, theta):
        return self.theirs.flexibility_slope(theta)

    def on_basis(self, *where):
        return Mine(self.theirs.on_basis(*where))


def test_a_law_of_ones_own_is_searched_and_fitted_likewise():
    s = searcher(hidden(absorbers=[(11, 0.8, 3.0)]), scatter=(0.0, 0.0))
    *others, absorber = s.problem.catalogue
    mine = replace(s.problem, catalogue=(*others, replace(absorber, law=Mine(absorber.law))))
    trials, start = np.log([[0.7, 3.1]]), (Suspect(2, 11, (np.log(0.7), np.log(3.1))),)
    told = []
    for p in (s.problem, mine):
        null, every = evaluate(p, np.zeros(2), ()), np.arange(N)
        found = fit(p, np.zeros(2), start, (0,), 8)
        told.append([scan(p, null, 2, every, trials), promising(p, null, 2, every, trials)])
        told[-1] += [found.objective, magnitudes(found.suspects)]
    for theirs, ours in zip(*told, strict=True):
        np.testing.assert_array_equal(theirs, ours)


def test_slopes_of_its_mass_and_spring_are_differences():
    law, theta, h = TunedLaw(np.array([[2e-3]]), 0.0), np.log([[0.3, 7.0]]), 1e-6
    for q in range(2):
        step = h * np.eye(2)[[q]]
        for value, slope in (
            (law.value, law.slope(theta, FIRST)),
            (law.flexibility, law.flexibility_slope(theta)),
        ):
            numeric = (value(theta + step, FIRST) - value(theta - step, FIRST)) / (2.0 * h)
            assert slope[0, q] == pytest.approx(numeric[0, 0], rel=1e-7, abs=1e-12)


def test_the_gradient_of_a_fit_is_that_of_its_objective():
    """On all modes of the string, with robust weights of one and modes that do not mix."""
    s = searcher(hidden(absorbers=[(11, 0.8, 3.0)]), scatter=(0.0, 0.0))
    e = s.problem.evidence
    e = replace(e, noise=replace(e.noise, robust=1e9, mixing=1e-9))
    p = replace(s.problem, evidence=e, modes=N + 1)
    at = Suspect(2, 11, (np.log(0.8) + 0.02, np.log(3.0) + 0.004))
    nuisance = np.array([0.003, 0.0])
    _, g = _normal_equations(p, evaluate(p, nuisance, (at,)), (0,))

    def objective(x):
        moved = changed(p.catalogue, (at,), x[1:])
        return evaluate(p, nuisance + np.array([x[0], 0.0]), moved).objective

    h = 1e-6
    numeric = [(objective(h * d) - objective(-h * d)) / (4.0 * h) for d in np.eye(3)]
    np.testing.assert_allclose(g, numeric, rtol=1e-5)


def test_to_first_order_the_truth_is_missed_by_nothing():
    """On exact data the secular equation holds at every test mode, for the truth alone."""
    s = searcher(hidden(absorbers=[(11, 0.8, 3.0)]), scatter=(0.0, 0.0))
    small, here = s.local(evaluate(s.problem, np.zeros(2), ()))
    trials = np.log([[0.8, 3.0], [0.4, 3.0], [0.8, 3.4]])
    cost = promising(small, here, 2, np.arange(N), trials)
    assert cost[11, 0] < 1e-3
    assert np.min(np.delete(cost.ravel(), 11 * 3)) > 1.0
    exact = scan(small, here, 2, np.array([11]), trials)[0]
    assert exact[0] < 1e-3
    assert (exact[1:] > 1.0).all()


@pytest.mark.parametrize(("bead", "mass", "hz"), [(11, 0.8, 1.7), (5, 0.5, 3.1), (20, 1.5, 2.6)])
def test_an_absorber_is_found_beside_a_wrong_tension(bead, mass, hz):
    s = searcher(hidden(1.1, absorbers=[(bead, mass, hz)]), modes_out=(4, 10))
    found = searched(s)
    accepted = chosen(s, found)
    (suspect,) = found.levels[accepted].suspects
    assert s.problem.catalogue[suspect.kind].kind.name == "tuned_absorber"
    assert suspect.row == bead
    assert np.exp(suspect.theta) == pytest.approx([mass, hz], rel=0.1)
    assert np.exp(suspect.theta[1]) == pytest.approx(hz, rel=0.02)


@pytest.mark.slow
def test_a_mass_beside_an_absorber_is_found_too():
    s = searcher(hidden(masses=[(22, 2.0)], absorbers=[(9, 0.8, 2.4)]))
    found = searched(s)
    best = found.levels[chosen(s, found)]
    named = {(s.problem.catalogue[q.kind].kind.name, q.row) for q in best.suspects}
    assert named == {("point_mass", 22), ("tuned_absorber", 9)}


def test_tuned_far_above_the_band_it_is_told_as_the_mass_that_it_is():
    s = searcher(hidden(absorbers=[(9, 2.0, 30.0 * STRING_HZ[11])]))
    found = searched(s)
    best = found.levels[chosen(s, found)]
    assert [(s.problem.catalogue[q.kind].kind.name, q.row) for q in best.suspects] == [
        ("point_mass", 9)
    ]


def test_a_tuned_kind_costs_more_than_a_kind_with_one_magnitude():
    s = searcher(hidden())
    mass, tuned = (price(s, Suspect(k, 3, t)) for k, t in ((0, (0.0,)), (2, (0.0, 1.0))))
    assert tuned == pytest.approx(mass + 2.0 * np.log(60))


def test_magnitudes_move_together_and_stay_in_bounds():
    s = searcher(hidden())
    c = s.problem.catalogue
    before = (Suspect(0, 3, (0.5,)), Suspect(2, 3, (-1.0, 1.0)))
    after = changed(c, before, np.array([0.1, 0.2, 50.0]))
    np.testing.assert_allclose(magnitudes(after), [0.6, -0.8, c[2].upper[1]])
    assert fit(s.problem, np.zeros(2), after, (0,), 3).suspects[1].theta[1] <= c[2].upper[1]


def test_a_magnitude_moves_alone_and_by_its_own_step():
    c = searcher(hidden()).problem.catalogue
    tried = c[2].around((0.0, 1.0), np.array([-0.5, 0.0, 0.5]))
    expected = [(-0.5, 1.0), (0.0, 0.925), (0.0, 1.0), (0.0, 1.075), (0.5, 1.0)]
    np.testing.assert_allclose(tried, expected)
    np.testing.assert_allclose(c[0].around((2.0,), np.array([-0.2, 0.0])), [[1.8], [2.0]])
