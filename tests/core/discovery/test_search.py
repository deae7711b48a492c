"""Steps of the search: on a string of beads."""

from dataclasses import replace

import numpy as np
import pytest
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.candidates import Suspect
from trueup.core.discovery.fitting import evaluate
from trueup.core.discovery.search import Effort

MASS, SPRING, ABSORBER = range(3)


@pytest.mark.parametrize(
    "held",
    [
        (Suspect(SPRING, 9, (np.log(3000.0),)),),
        (Suspect(MASS, 9, (np.log(2.0),)),),
        (Suspect(ABSORBER, 9, (np.log(0.8), np.log(1.7))),),
        (Suspect(SPRING, 9, (np.log(3000.0),)), Suspect(MASS, 20, (0.0,))),
    ],
)
def test_on_its_own_lowest_modes_a_hypothesis_is_what_it_was(held):
    s = searcher(hidden(tension=1.1))
    s = replace(s, effort=Effort(search_modes=18))
    state = evaluate(s.problem, np.array([0.05, 0.0]), held)
    small, here = s.local(state)
    assert small.basis.size <= 18 < s.problem.basis.size
    n = s.problem.columns
    np.testing.assert_allclose(here.eigenvalues[:n], state.eigenvalues[:n], rtol=1e-8)
    assert here.objective == pytest.approx(state.objective, rel=1e-6)
