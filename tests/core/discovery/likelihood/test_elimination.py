"""Which parameters a fit determines: regressions whose answer is known."""

import numpy as np
import pytest

from trueup.core.discovery.likelihood.elimination import in_deck


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
    known = in_deck(x, H, 1.0)
    alone, own = regression([a, c], data)
    assert known.clear.tolist() == [True, False, True]
    assert known.alone == pytest.approx([alone[0], 0.0, alone[1]])
    assert known.deviation[[0, 2]] == pytest.approx(np.sqrt(np.diag(np.linalg.inv(own))))
    assert known.deviation[1] == pytest.approx(np.sqrt(np.linalg.inv(H)[1, 1]))
    np.testing.assert_array_equal(known.together, x)


def test_of_two_that_only_their_sum_tells_one_stays_clear():
    """Neither is clear beside the other; without both nothing would be explained."""
    rng = np.random.default_rng(5)
    a = rng.normal(size=60)
    b = a + 0.02 * rng.normal(size=60)
    x, H = regression([a, b], 1.2 * a + 0.8 * b)
    assert np.all(np.abs(x) < 3.0 * np.sqrt(np.diag(np.linalg.inv(H))))
    known = in_deck(x, H, 1.0)
    assert known.clear.sum() == 1
    assert known.alone.sum() == pytest.approx(2.0, abs=0.05)


def test_more_noise_makes_less_clear():
    x, H = np.array([0.4, 0.1]), np.diag([100.0, 400.0])
    assert in_deck(x, H, 1.0).clear.tolist() == [True, False]
    assert not in_deck(x, H, 4.0).clear.any()
    assert not in_deck(np.zeros(0), np.zeros((0, 0)), 1.0).clear.any()
