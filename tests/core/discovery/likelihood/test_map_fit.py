"""Steps of a fit by the misfit of frequencies and shapes."""

from dataclasses import replace

import numpy as np
import pytest
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.map_fit import (
    _matrices,
    _normal_equations,
    evaluate,
    step_within,
)


def test_a_partner_that_no_sensor_sees_says_nothing_of_the_unknowns():
    """What is read of it is rounding, whose relative change is no evidence."""
    problem = searcher(hidden(masses=[(7, 1.0)])).problem
    start = evaluate(problem, np.zeros(len(problem.prior.spread)), (Suspect(0, 7, (0.0,)),))
    v = start.vectors[:, start.match[0]]
    _, M = _matrices(problem, start.nuisance, start.suspects)
    blind = replace(
        problem, sensors=problem.sensors - np.outer(problem.sensors @ v, v @ M) / (v @ M @ v)
    )
    assert np.abs(blind.sensors @ v).max() < 1e-12 * np.abs(problem.sensors).max()
    H, _ = _normal_equations(problem, start, (0, 1))
    unseen, _ = _normal_equations(blind, start, (0, 1))
    assert np.all(np.diag(unseen) < 10.0 * np.diag(H))


def test_what_a_bound_holds_does_not_hold_up_the_others():
    H, g = np.array([[2.0, 1.0], [1.0, 2.0]]), np.array([-3.0, -1.0])
    far = np.full(2, 9.0)
    assert step_within(H, g, (-far, far)) == pytest.approx(np.array([5.0, -1.0]) / 3.0)
    assert step_within(H, g, (-far, np.array([0.5, 9.0]))) == pytest.approx([0.5, 0.25])
