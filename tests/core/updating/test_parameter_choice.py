"""Parameters are chosen by what they explain, and only those that the test determines."""

from __future__ import annotations

import numpy as np
import pytest

from trueup.core.updating.parameter_choice import forward_selection, indistinct


def test_the_parameters_behind_a_misfit_are_chosen_largest_first():
    G = 20.0 * np.linalg.qr(np.random.default_rng(4).standard_normal((15, 6)))[0]
    choice = forward_selection(G, G @ [0.0, 0.3, 0.0, 0.0, 1.0, 0.0], 0.5)
    assert choice.chosen == (4, 1)
    assert choice.explained == pytest.approx((1.0 / 1.09, 1.0))


def test_of_two_that_do_the_same_the_first_is_chosen():
    g = 30.0 * np.random.default_rng(5).standard_normal((12, 2))
    choice = forward_selection(np.column_stack([g[:, 0], g[:, 1], 2.0 * g[:, 0]]), g[:, 0], 0.5)
    assert choice.chosen == (0,)


def test_chance_is_no_reason():
    """Residuals of one standard deviation: of a hundred selections few name anything."""
    rng = np.random.default_rng(6)
    named = [
        bool(
            forward_selection(
                20.0 * rng.standard_normal((20, 8)), rng.standard_normal(20), 0.5
            ).chosen
        )
        for _ in range(100)
    ]
    assert sum(named) <= 5


def test_what_is_not_determined_is_not_chosen():
    G = np.array([[1.0, 0.0], [0.0, 40.0]])
    assert forward_selection(G, np.array([8.0, 20.0]), 0.5).chosen == (1,)


def test_groups_are_those_not_told_apart():
    cosines = np.array([[1.0, 0.2, -0.995], [0.2, 1.0, 0.1], [-0.995, 0.1, 1.0]])
    group = indistinct(cosines)
    assert group[0] == group[2] != group[1]
