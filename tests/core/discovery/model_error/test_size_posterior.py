"""A magnitude that the test hardly tells is told as the middle of what is likely."""

from dataclasses import replace

import numpy as np
import pytest
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.effects.effect_numbers import EFFECTS
from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.model_error.diffuse_fit import everything, judged
from trueup.core.discovery.model_error.size_posterior import amid, centred


def test_what_the_test_tells_stays():
    found = fitted(200.0)
    assert centred(found) is found


def test_a_stiff_spring_is_told_in_the_middle_of_what_is_as_likely():
    found = fitted(4e5)
    new = centred(found)
    log = {t: likely(found, t) for t in np.arange(6.0, 22.0, 0.25)}
    weight = np.exp(np.array([*log.values()]) - max(log.values()))
    share = np.cumsum(weight) / weight.sum()
    low, middle, high = np.interp((0.16, 0.5, 0.84), share, [*log])
    assert middle - found.fit.suspects[0].theta[0] > 0.5
    assert new.fit.suspects[0].theta[0] == pytest.approx(middle, abs=0.3)
    assert new.state.suspects == new.fit.suspects
    deviation = np.sqrt(np.linalg.inv(new.information)[-1, -1])
    assert deviation == pytest.approx((high - low) / 2.0, rel=0.25)


def test_a_magnitude_stays_within_its_bounds():
    found = fitted(2e5)
    most = found.fit.suspects[0].theta[0] + 0.5
    every = found.problem.catalogue
    bounded = tuple(replace(c, upper=np.full(len(c.typical), most)) for c in every)
    new = centred(replace(found, problem=replace(found.problem, catalogue=bounded)))
    assert new.fit.suspects[0].theta[0] < most


def test_of_several_as_likely_the_middle_of_all_is_told():
    found = fitted(4e5)
    own = np.sqrt(np.linalg.inv(found.information)[-1, -1])
    (at,) = found.fit.suspects[0].theta
    alone = amid(found, [found])
    assert alone.fit.suspects[0].theta[0] == pytest.approx(at, abs=0.02 * own)
    assert np.sqrt(np.linalg.inv(alone.information)[-1, -1]) == pytest.approx(own, rel=0.02)
    apart = [moved(found, by * own) for by in (-30.0, -20.0, 20.0)]
    new = amid(found, apart)
    assert new.state.suspects == new.fit.suspects
    assert new.fit.suspects[0].theta[0] == pytest.approx(at - 20.0 * own, abs=own)
    assert np.sqrt(np.linalg.inv(new.information)[-1, -1]) == pytest.approx(25.0 * own, rel=0.05)


def moved(found, by):
    (s,) = found.state.suspects
    return replace(found, state=replace(found.state, suspects=(s.moved(np.array(s.theta) + by),)))


def fitted(stiffness):
    """Return a spring at the bead where it is, as the diffuse error fits it."""
    problem = searcher(hidden(springs=[(11, stiffness)])).problem.entire()
    wide = tuple(replace(c, spread=np.full(len(c.typical), 5.0)) for c in problem.catalogue)
    problem = replace(problem, catalogue=wide)
    start = Suspect(1, 11, (np.log(stiffness),))
    here = evaluate(problem, np.zeros(len(problem.prior.spread)), (start,))
    return judged(problem, here, everything(problem))


def likely(found, theta):
    """Return ln of the posterior of a spring as stiff as that."""
    prior = found.problem.catalogue[1]
    held = replace(prior, typical=np.array([theta]), spread=np.array([EFFECTS.held]))
    problem = replace(found.problem, catalogue=(found.problem.catalogue[0], held))
    start = evaluate(problem, found.state.nuisance, (Suspect(1, 11, (theta,)),))
    there = judged(problem, start, everything(problem))
    return there.evidence - 0.5 * float(prior.surprise(np.array([theta])))
