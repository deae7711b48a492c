"""Which hypotheses are grown further: on a string of beads."""

from dataclasses import replace

import numpy as np
import pytest
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.search.beam_search import _as_the_deck, _near

MASS, SPRING = 0, 1


def hypotheses(s, *chosen):
    made = [evaluate(s.problem, np.zeros(2), (Suspect(k, row, (0.0,)),)) for k, row, _ in chosen]
    return [replace(f, objective=c[2]) for f, c in zip(made, chosen, strict=True)]


def test_none_that_gained_much_less_is_grown():
    s = searcher(hidden(masses=[(9, 2.0)]))
    fits = hypotheses(s, (SPRING, 3, 50.0), (SPRING, 9, 51.0), (MASS, 9, 80.0))
    assert _near(s, fits, 100.0) == fits[:2]
    assert _near(s, hypotheses(s, (SPRING, 3, 50.0), (MASS, 9, 80.0)), 100.0)[1:] == []


@pytest.mark.parametrize("moved", [0.0, 0.05])
def test_a_beam_starts_from_the_deck_too_where_the_known_parameters_have_moved(moved):
    s = searcher(hidden(masses=[(9, 2.0)]))
    null = evaluate(s.problem, np.array([moved, 0.3]), ())
    begun = _as_the_deck(s, null)
    assert [f.nuisance.tolist() for f in begun] == ([[0.0, 0.3]] if moved else [])
