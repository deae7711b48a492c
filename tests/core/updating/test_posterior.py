"""Priors, intervals and other starts, on problems whose posterior is known."""

from dataclasses import replace

import numpy as np
import pytest
from tests.core.updating.spring_chain import HALVES, chain, measured

from trueup.core.data.parameter import Parameter
from trueup.core.updating.posterior import from_elsewhere, profile_intervals, remarks
from trueup.core.updating.problem import Configuration
from trueup.core.updating.residuals import Weights
from trueup.core.updating.update import Stage, update

SIGMA = 0.02


def posterior(model, truth, weights, active=(0,)):
    target = measured(model, truth, slice(0, 1))
    stage = Stage(active, "frequencies, prior", 30)
    done = update(model, target, [stage], weights=weights, n_modes=1, tolerance=1e-9)
    one = Configuration(model, target, weights=weights, n_modes=1)
    found = profile_intervals([one], stage, done)
    return done, found


@pytest.mark.parametrize("weight", [1.0, 4.0])
@pytest.mark.parametrize("prior", [0.03, 0.2, 10.0])
def test_one_spring_and_a_prior_are_two_gaussians(prior, weight):
    """λ = p k/m against λ_t = 1.2 k/m: r = (p/1.2 − 1)/2 is linear, so all is closed form."""
    model = chain([range(1)], n=1)
    model = replace(model, parameters=(replace(model.parameters[0], weight=weight),))
    weights = Weights({"frequency_sigma": SIGMA, "prior_sigma": prior}, 0.0)
    done, found = posterior(model, [1.2], weights)
    by_test, by_prior = 1.0 / (2.0 * SIGMA * 1.2) ** 2, weight / prior**2
    mean = (1.2 * by_test + by_prior) / (by_test + by_prior)
    deviation = (by_test + by_prior) ** -0.5
    assert done.factors[0] == pytest.approx(mean, rel=1e-9)
    assert done.standard_error[0] == pytest.approx(deviation, rel=1e-9)
    ends = mean + np.sqrt(3.84) * deviation * np.array([-1.0, 1.0])
    np.testing.assert_allclose(found[0], ends, rtol=1e-4)


def test_a_mass_has_an_interval_that_leans():
    """λ = k/(p m): r = (0.9/p − 1)/2 ends at ±1.96 σ where p = 0.9/(1 ± 3.92 σ)."""
    model = chain([range(1)], ["m"], n=1)
    weights = Weights({"frequency_sigma": 0.05, "prior_sigma": 1e4}, 0.0)
    _, found = posterior(model, [0.9], weights)
    reach = 2.0 * 0.05 * np.sqrt(3.84)
    np.testing.assert_allclose(found[0], [0.9 / (1.0 + reach), 0.9 / (1.0 - reach)], rtol=1e-3)


def test_of_stiffness_and_mass_the_ratio_is_known_and_the_rest_is_the_prior():
    """Others follow: at a given p the mass that fits costs ((p/1.2 − 1)/s)²/2 at most."""
    model = chain([range(1), range(1)], ["k", "m"], n=1)
    weights = Weights({"frequency_sigma": 1e-4, "prior_sigma": 0.05}, 0.0)
    done, found = posterior(model, [1.2, 1.0], weights, (0, 1))
    p, q = done.factors
    assert p / q == pytest.approx(1.2, rel=1e-4)
    # On the line p = 1.2 q: (1.2 q − 1)² + (q − 1)² is least at q = 2.2/2.44.
    assert q == pytest.approx(2.2 / 2.44, rel=1e-4)
    deviation = 1.2 * 0.05 / np.sqrt(2.44)
    assert done.standard_error[0] == pytest.approx(deviation, rel=1e-3)
    np.testing.assert_allclose(
        found[0], p + np.sqrt(3.84) * deviation * np.array([-1, 1]), rtol=2e-3
    )


def test_an_interval_ends_nowhere_before_a_bound():
    model = chain([range(1)], n=1)
    only = Parameter("k0", ("k",), (1.0,), lower=0.99, upper=1.01)
    model = replace(model, parameters=(only,))
    weights = Weights({"frequency_sigma": 0.09, "prior_sigma": 10.0}, 0.0)
    _, found = posterior(model, [1.0], weights)
    np.testing.assert_array_equal(found[0], [-np.inf, np.inf])


def test_what_stays_as_it_is_has_no_interval():
    model = chain(HALVES)
    target = measured(model, [1.1, 0.9], noise=0.01)
    stage = Stage((1,), "frequencies", 20)
    done = update(model, target, [stage], n_modes=8)
    found = profile_intervals([Configuration(model, target, n_modes=8)], stage, done)
    assert np.isnan(found[0]).all()
    assert found[1, 0] < done.factors[1] < found[1, 1]


def test_other_starts_lead_to_the_one_optimum_or_say_that_there_are_more():
    """A start of 2.7 times a spring ends where most pairs are lost and frequencies say no more."""
    model = chain(HALVES)
    target = measured(model, [1.3, 0.8])
    stage = Stage((0, 1), "frequencies", 30)
    done = update(model, target, [stage], n_modes=8)
    one = Configuration(model, target, n_modes=8)
    best, starts = from_elsewhere([one], [stage], done, 5, seed=1)
    assert best.after is done.after
    assert len({tuple(s.start) for s in starts}) == 5
    assert all(s.same for s in starts)
    assert remarks(done, best, starts) == ()
    best, starts = from_elsewhere([one], [stage], done, 5, seed=3)
    (said,) = remarks(done, best, starts)
    assert said.startswith("4 of 5 other starts lead to this optimum, 1 to a worse one")
    lost = starts[[s.same for s in starts].index(False)]
    assert lost.objective > 1000.0 > max(lost.start) > 2.5


def test_a_better_optimum_elsewhere_is_taken():
    """From the deck one iteration is allowed, from elsewhere as many as it takes."""
    model = chain(HALVES)
    target = measured(model, [1.3, 0.8])
    done = update(model, target, [Stage((0, 1), "frequencies", 1)], n_modes=8)
    one = Configuration(model, target, n_modes=8)
    best, starts = from_elsewhere([one], [Stage((0, 1), "frequencies", 30)], done, 3)
    np.testing.assert_allclose(best.factors, [1.3, 0.8], rtol=1e-3)
    assert best.before is done.before
    assert "better optimum, which is taken: 3 of 3" in remarks(done, best, starts)[0]
    assert best.eigensolutions > done.eigensolutions
