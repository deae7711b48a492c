"""Two masses that each explain little alone: on a string of beads."""

from dataclasses import replace

import numpy as np
import pytest
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.map_fit import fit
from trueup.core.discovery.search.beam_search import grown
from trueup.core.discovery.search.model_selection import chosen

MASSES = [(8, 3.0), (22, 5.0)]


def masses_alone(**truth):
    """A search for masses only, three of the modes kept out of it."""
    s = searcher(hidden(**truth), modes_out=(4, 10))
    masses = [c.kind.name == "point_mass" for c in s.problem.catalogue]
    rows = [r if own else r[:0] for r, own in zip(s.coarse, masses, strict=True)]
    return replace(s, coarse=tuple(rows)), masses.index(True)


def test_two_masses_are_found_and_fitted_to_the_noise_of_the_test():
    s, _ = masses_alone(masses=MASSES)
    best = grown(s).levels[2]
    assert {(q.row, round(float(np.exp(q.theta[0])))) for q in best.suspects} == set(MASSES)
    again = fit(s.problem, best.nuisance, best.suspects, s.active, 10)
    assert best.objective == pytest.approx(again.objective, abs=0.1)


def test_where_nothing_is_missing_the_known_parameters_are_left():
    s, _ = masses_alone(tension=1.1)
    found = grown(s)
    assert chosen(s, found) == 0
    assert found.levels[0].nuisance[0] == pytest.approx(np.log(1.1), abs=0.01)


def test_a_beam_grows_from_what_it_is_given():
    s, mass = masses_alone(masses=MASSES)
    first = [s.null()]
    first.append(fit(s.problem, first[0].nuisance, (Suspect(mass, 22, (1.0,)),), s.active, 15))
    found = grown(s, first=first)
    assert found.levels[1].suspects[0].row == 22
    assert {q.row for q in found.levels[2].suspects} == {8, 22}
