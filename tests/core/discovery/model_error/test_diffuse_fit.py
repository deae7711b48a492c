"""A hypothesis is fitted to where the test is likeliest, however far the first step reaches."""

from dataclasses import replace

import numpy as np
import pytest
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.model_error import diffuse_fit
from trueup.core.discovery.model_error.diffuse_error import at
from trueup.core.discovery.model_error.diffuse_fit import (
    everything,
    judged,
    normal_equations,
    seen,
)


def test_a_step_to_where_no_model_is_counts_as_too_long(monkeypatch):
    problem = searcher(hidden(masses=[(7, 1.0)])).problem.entire()
    start = evaluate(problem, np.zeros(len(problem.prior.spread)), (Suspect(0, 7, (0.3,)),))
    free = judged(problem, start, everything(problem))
    honest, calls = diffuse_fit.stepped, []

    def first_fails(*arguments):
        calls.append(1)
        if len(calls) == 1:
            raise np.linalg.LinAlgError
        return honest(*arguments)

    monkeypatch.setattr(diffuse_fit, "stepped", first_fails)
    found = judged(problem, start, everything(problem))
    assert found.fit.suspects[0].theta[0] == pytest.approx(0.0, abs=0.05)
    assert found.evidence == pytest.approx(free.evidence, abs=0.5)


def test_a_partner_that_no_sensor_sees_says_nothing_of_the_unknowns():
    """What is read of it is rounding, whose multiple the test's shape is not."""
    problem = searcher(hidden(masses=[(7, 1.0)])).problem.entire()
    start = evaluate(problem, np.zeros(len(problem.prior.spread)), (Suspect(0, 7, (0.0,)),))
    here = seen(problem, start)
    best = at(here, 0.005, 0.1)
    H, _, _ = normal_equations(problem, start, here, best, everything(problem))
    modes = here.modes.copy()
    modes[:, best.match[0]] *= 1e-13
    blind, _, _ = normal_equations(
        problem, start, replace(here, modes=modes), best, everything(problem)
    )
    assert np.all(np.diag(blind) > 0.0)
    assert np.all(np.diag(blind) < 1.01 * np.diag(H))


def test_modes_that_a_small_error_left_out_are_taken_in_again():
    """By an error far below what a mass of 0.6 of the true one leaves hardly a mode is its."""
    problem = searcher(hidden(masses=[(11, 8.0)])).problem.entire()
    suspect = Suspect(0, 11, (np.log(8.0) - 0.5,))
    start = evaluate(problem, np.zeros(len(problem.prior.spread)), (suspect,))
    near = at(seen(problem, start), 3e-4, 0.02)
    assert np.mean(near.stray > 0.5) > 0.9
    found = judged(problem, start, everything(problem), near)
    assert not np.any(found.diffuse.stray > 0.5)
    assert np.exp(found.fit.suspects[0].theta[0]) == pytest.approx(8.0, rel=0.02)
