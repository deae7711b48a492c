"""Steps of a fit by the misfit of frequencies and shapes."""

from dataclasses import replace

import numpy as np
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.map_fit import _matrices, _normal_equations, evaluate


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
