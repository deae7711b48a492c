"""What is there foretells modes that it was not fitted to, what is not does not."""

import numpy as np
import pytest
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.model_error.diffuse_fit import everything, judged
from trueup.core.discovery.model_error.held_out import agreement, foretold


def foretells(problem, *suspects):
    start = evaluate(problem, np.zeros(len(problem.prior.spread)), suspects)
    return foretold(judged(problem, start, everything(problem)))


def test_a_bead_foretells_modes_that_it_was_not_fitted_to():
    problem = searcher(hidden(masses=[(7, 1.0)])).problem.entire()
    none = foretells(problem)
    assert agreement(foretells(problem, Suspect(0, 7, (0.0,))), none) > 2.0
    assert agreement(foretells(problem, Suspect(0, 20, (-2.0,))), none) < 1.64


def test_nothing_foretells_itself_better():
    x = np.arange(5.0)
    assert agreement(x, x) == pytest.approx(0.0)


def test_one_mode_does_not_decide():
    zero = np.zeros(12)
    rest = np.tile([1.0, -1.0], 6)
    assert agreement(rest + 1000.0 * (np.arange(12) == 0), zero) < 1.0
    assert agreement(np.abs(rest), zero) > 3.0


def test_it_is_a_standard_deviation_where_signs_are_by_chance():
    rng = np.random.default_rng(0)
    said = [agreement(rng.normal(size=14), np.zeros(14)) for _ in range(2000)]
    assert np.std(said) == pytest.approx(1.0, abs=0.05)
