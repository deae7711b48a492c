"""Which parameters a fit determines: regressions whose answer is known."""

import numpy as np
import pytest

from trueup.core.discovery.likelihood.elimination import in_deck

WIDE = np.full(3, 10.0)
"""How far unknowns may be off beforehand."""


def regression(columns, data):
    """Least squares with unit noise: unknowns and half the Hessian."""
    J = np.column_stack(columns)
    H = J.T @ J
    return np.linalg.solve(H, J.T @ data), H


def test_what_is_not_clear_stays_and_the_rest_is_what_a_fit_without_it_gives():
    rng = np.random.default_rng(3)
    a, b, c = rng.normal(size=(3, 40))
    data = 2.0 * a + 0.1 * b - 1.5 * c
    x, H = regression([a, b, c], data)
    known = in_deck(x, H, 1.0, WIDE[: len(x)])
    alone, own = regression([a, c], data)
    assert known.clear.tolist() == [True, False, True]
    assert known.alone == pytest.approx([alone[0], 0.0, alone[1]])
    at_least = np.sqrt(np.diag(np.linalg.inv(own)))
    at_most = np.sqrt(np.diag(np.linalg.inv(H)))
    assert np.all(at_least <= known.deviation[[0, 2]])
    assert np.all(known.deviation[[0, 2]] <= at_most[[0, 2]])
    assert known.deviation[1] == pytest.approx(np.sqrt(np.linalg.inv(H)[1, 1]))
    np.testing.assert_array_equal(known.together, x)


def test_of_two_that_only_their_sum_tells_neither_is_clear():
    """Each is where the other stays; which of them is off nothing tells."""
    rng = np.random.default_rng(5)
    a = rng.normal(size=60)
    b = a + 0.02 * rng.normal(size=60)
    x, H = regression([a, b], 1.2 * a + 0.8 * b)
    assert np.all(np.abs(x) < 3.0 * np.sqrt(np.diag(np.linalg.inv(H))))
    assert not in_deck(x, H, 1.0, WIDE[: len(x)]).clear.any()
    known = in_deck(x[:1] + x[1:], np.array([[a @ a]]), 1.0, WIDE[:1])
    assert known.clear.all()
    assert known.alone == pytest.approx([2.0], abs=0.05)


def test_more_noise_makes_less_clear():
    x, H = np.array([0.4, 0.1]), np.diag([100.0, 400.0])
    assert in_deck(x, H, 1.0, WIDE[: len(x)]).clear.tolist() == [True, False]
    assert not in_deck(x, H, 4.0, WIDE[: len(x)]).clear.any()
    assert not in_deck(np.zeros(0), np.zeros((0, 0)), 1.0, WIDE[:0]).clear.any()


def test_a_clear_one_is_known_as_well_as_the_others_may_be_off():
    """Of two columns that are alike by cos φ, one clear: its deviation by both models, averaged."""
    phi, b = 0.3, 1.5
    C = np.array([[1.0, np.cos(phi)], [np.cos(phi), 1.0]])
    known = in_deck(np.array([30.0, b]), C, 1.0, np.array([10.0, 10.0]))
    s2 = 1.0 / np.sin(phi) ** 2
    bayes = np.sqrt(s2) / 10.0 * np.exp(0.5 * b**2 / s2)
    chance = bayes / (1.0 + bayes)
    off = np.cos(phi) ** 2 * (s2 + (1.0 - chance) * b**2)
    assert known.clear.tolist() == [True, False]
    assert known.deviation == pytest.approx([np.sqrt(1.0 + chance * off), np.sqrt(s2)])


def test_what_no_other_imitates_is_known_as_its_curvature_says():
    known = in_deck(np.array([0.4, 0.01]), np.diag([100.0, 400.0]), 1.0, np.ones(2))
    assert known.deviation == pytest.approx([0.1, 0.05])
