"""A hypothesis is fitted to where the test is likeliest, however far the first step reaches."""

import numpy as np
import pytest
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.model_error import diffuse_fit
from trueup.core.discovery.model_error.diffuse_fit import everything, judged, with_drift
from trueup.core.discovery.model_error.smooth_fields import Fields


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


def test_fields_that_could_not_make_the_error_that_is_left_are_not_tried(monkeypatch):
    problem = searcher(hidden(masses=[(7, 3.0)])).problem.entire()
    start = evaluate(problem, np.zeros(len(problem.prior.spread)), ())
    error = judged(problem, start, everything(problem)).diffuse.error
    none = np.zeros((1, *problem.mesh.shape))
    tried, honest = [], diffuse_fit.with_fields

    def sized(problem, fields, size):
        tried.append(size)
        return honest(problem, fields, size)

    monkeypatch.setattr(diffuse_fit, "with_fields", sized)
    with_drift(problem, start, lambda: Fields(("mass along x",), none, none))
    assert 0.02 < error < 0.06
    assert tried[0] == pytest.approx(0.01)
