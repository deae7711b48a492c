"""The evidence for a prior, where it is known in closed form."""

import numpy as np
import pytest
from tests.core.updating.spring_chain import HALVES, chain, measured

from trueup.core.errors import InputError
from trueup.core.updating.prior_evidence import best_prior, weigh_prior
from trueup.core.updating.residuals import Weights
from trueup.core.updating.update import Configuration, Stage, update_configurations


def weighed(model, truth, sigmas, modes=slice(0, 1), residuals="frequencies, prior", noise=0.0):
    target = measured(model, truth, modes, noise=noise)
    every = [Configuration(model, target, weights=Weights(sigmas, 0.0), n_modes=model.n_free)]
    stage = Stage(tuple(range(len(model.parameters))), residuals, 30)
    done = update_configurations(every, [stage], tolerance=1e-9)
    return weigh_prior(every, stage, done)


def test_one_spring_in_closed_form():
    """r = (p/1.2 − 1)/2σ is a datum: Gaussian, mean (1/1.2 − 1)/2σ, variance 1 + (s/2.4σ)²."""
    sigma = 0.02
    rows = weighed(chain([range(1)], n=1), [1.2], {"frequency_sigma": sigma, "prior_sigma": 0.2})
    s = np.array([r.prior_sigma for r in rows])
    mean, variance = (1.0 / 1.2 - 1.0) / (2.0 * sigma), 1.0 + (s / (2.4 * sigma)) ** 2
    known = -0.5 * mean**2 / variance - 0.5 * np.log(variance)
    found = np.array([r.log_evidence for r in rows])
    np.testing.assert_allclose(found - found[8], known - known[8], atol=1e-3)
    assert s[8] == pytest.approx(0.2)
    effective = (s / (2.4 * sigma)) ** 2 / variance
    np.testing.assert_allclose([r.effective for r in rows], effective, rtol=1e-4)


def test_parameters_that_scatter_are_given_their_scatter():
    """Eight springs off by 10 %: the evidence asks for about that, the L-curve goes one way."""
    rng = np.random.default_rng(3)
    truth = 1.0 + 0.1 * rng.standard_normal(8)
    model = chain([[k] for k in range(8)])
    sigmas = {"frequency_sigma": 0.002, "prior_sigma": 0.3}
    rows = weighed(model, truth, sigmas, slice(0, 8), noise=0.002)
    assert 0.05 < best_prior(rows) < 0.2
    misfit, moved = (np.array([getattr(r, k) for r in rows]) for k in ("misfit", "moved"))
    assert (np.diff(misfit) < 1e-3).all()
    assert (np.diff(moved) > -1e-3).all()
    assert (np.diff([r.effective for r in rows]) > 0.0).all()


def test_without_a_prior_there_is_nothing_to_weigh():
    with pytest.raises(InputError, match="add it to the residuals"):
        weighed(chain(HALVES), [1.1, 0.9], {}, slice(0, 6), "frequencies", 0.01)
