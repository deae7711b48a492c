"""A hypothesis is fitted to where the test is likeliest, however far the first step reaches."""

import numpy as np
import pytest
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.model_error import diffuse_fit
from trueup.core.discovery.model_error.diffuse_fit import everything, judged


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
