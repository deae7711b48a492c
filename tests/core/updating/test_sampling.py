"""Samples of densities that are known, and of posteriors in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from tests.core.updating.spring_chain import chain, measured

from trueup.core.errors import InputError
from trueup.core.updating.metropolis import Chains, adaptive_metropolis
from trueup.core.updating.problem import Problem
from trueup.core.updating.residuals import Weights
from trueup.core.updating.sampling import sample_posterior
from trueup.core.updating.scatter import Scatter
from trueup.core.updating.update import Configuration, Stage, update_configurations


def test_a_gaussian_is_met_from_a_covariance_that_is_far_off():
    C = np.array([[1.0, 0.9, 0.0], [0.9, 2.0, -0.3], [0.0, -0.3, 0.5]])
    inverse, mean = np.linalg.inv(C), np.array([1.0, -2.0, 0.5])

    def log_density(x):
        return -0.5 * (x - mean) @ inverse @ (x - mean)

    found = adaptive_metropolis(log_density, np.zeros(3), 0.01 * np.eye(3), 20000, seed=1)
    error = np.sqrt(np.diag(C) / found.effective)
    assert (found.effective > 800.0).all()
    assert (np.abs(found.samples.mean(axis=0) - mean) < 3.0 * error).all()
    np.testing.assert_allclose(np.cov(found.samples.T), C, atol=0.2)
    assert 0.15 < found.accepted < 0.5
    assert (found.spread < 1.02).all()


def test_both_sides_of_a_density_with_two_are_found():
    """exp(−(x² − 1)²/2s²): half of it lies below 0, E x² by quadrature."""
    s = 0.6

    def log_density(x):
        return -0.5 * ((x[0] ** 2 - 1.0) / s) ** 2

    x = np.linspace(-3.0, 3.0, 20001)
    weight = np.exp(-0.5 * ((x**2 - 1.0) / s) ** 2)
    found = adaptive_metropolis(log_density, np.ones(1), np.eye(1) * (s / 2.0) ** 2, 20000, seed=2)
    n = found.effective[0]
    assert n > 300.0
    assert np.mean(found.samples < 0.0) == pytest.approx(0.5, abs=3.0 * 0.5 / np.sqrt(n))
    second = np.sum(weight * x**2) / np.sum(weight)
    assert np.mean(found.samples**2) == pytest.approx(second, rel=0.05)


def test_the_seed_decides():
    def log_density(x):
        return -0.5 * float(x @ x)

    one, same, other = (
        adaptive_metropolis(log_density, np.zeros(2), np.eye(2), 400, seed=s).values
        for s in (3, 3, 4)
    )
    np.testing.assert_array_equal(one, same)
    assert not np.array_equal(one, other)


@pytest.mark.parametrize("rho", [0.0, 0.6, 0.95])
def test_effective_samples_of_an_autoregressive_chain(rho):
    """(1 − ρ)/(1 + ρ) of them."""
    rng = np.random.default_rng(5)
    x = np.zeros((4, 8000, 1))
    x[:, 0] = rng.standard_normal((4, 1))
    for k in range(1, 8000):
        x[:, k] = rho * x[:, k - 1] + np.sqrt(1.0 - rho**2) * rng.standard_normal((4, 1))
    found = Chains(x, 1.0)
    expected = 4 * 8000 * (1.0 - rho) / (1.0 + rho)
    assert found.effective[0] == pytest.approx(expected, rel=0.15)
    assert found.spread[0] == pytest.approx(1.0, abs=0.02)


def test_chains_that_part_are_told():
    x = np.random.default_rng(6).standard_normal((4, 500, 1))
    x[0] += 3.0
    assert Chains(x, 1.0).spread[0] > 1.3
    assert Chains(x, 1.0).effective[0] < 20.0


def sampled(model, truth, weights, active=(0,), count=6000, residuals="frequencies, prior"):
    target = measured(model, truth, slice(0, 1))
    every = [Configuration(model, target, weights=weights, n_modes=1)]
    stage = Stage(active, residuals, 30)
    done = update_configurations(every, [stage], tolerance=1e-9)
    return done, sample_posterior(every, stage, done, count, seed=7)


def test_one_spring_and_a_prior_are_two_gaussians():
    """As in `test_posterior`: r = (p/1.2 − 1)/2 is linear."""
    model = chain([range(1)], n=1)
    weights = Weights({"frequency_sigma": 0.02, "prior_sigma": 0.05}, 0.0)
    done, found = sampled(model, [1.2], weights)
    x = found.chains.samples[:, 0]
    error = done.standard_error[0] / np.sqrt(found.chains.effective[0])
    assert x.mean() == pytest.approx(done.factors[0], abs=3.0 * error)
    assert x.std() == pytest.approx(done.standard_error[0], rel=0.06)
    assert found.doubts == ()


def test_few_data_without_a_prior_are_student_s():
    """r = (p/1.1 − 1)/2 + noise is linear in p: of four frequencies t with three degrees."""
    model = chain([range(8)])
    target = measured(model, [1.1], slice(0, 4), noise=0.004, seed=1)
    stage, weights = Stage((0,), "frequencies", 30), Weights(regularisation=0.0)
    one = Configuration(model, target, weights=weights, n_modes=8)
    done = update_configurations([one], [stage], tolerance=1e-9)
    found = sample_posterior([one], stage, done, 4000, seed=2)
    assert found is not None
    away = (found.chains.samples[:, 0] - done.factors[0]) / done.standard_error[0]
    ends = np.quantile(away, [0.025, 0.5, 0.975])
    np.testing.assert_allclose(ends, [-3.182, 0.0, 3.182], atol=0.5)


def test_a_mass_leans_as_its_density_does():
    """r = (0.9/p − 1)/2 with σ 0.05 and no prior to speak of: quantiles by quadrature."""
    model = chain([range(1)], ["m"], n=1)
    weights = Weights({"frequency_sigma": 0.05, "prior_sigma": 1e4}, 0.0)
    _, found = sampled(model, [0.9], weights)
    p = np.linspace(0.45, 1.8, 40001)
    cumulated = np.cumsum(np.exp(-((0.9 / p - 1.0) ** 2) / (8.0 * 0.05**2)))
    known = np.interp([0.025, 0.5, 0.975], cumulated / cumulated[-1], p)
    ends = np.quantile(found.chains.samples[:, 0], [0.025, 0.5, 0.975])
    np.testing.assert_allclose(ends, known, rtol=0.03)
    assert known[2] - known[1] > 1.3 * (known[1] - known[0])


def test_samples_stay_within_the_bounds():
    model = chain([range(1)], n=1)
    model = replace(model, parameters=(replace(model.parameters[0], lower=0.98, upper=1.02),))
    weights = Weights({"frequency_sigma": 0.09, "prior_sigma": 10.0}, 0.0)
    _, found = sampled(model, [1.0], weights, count=4000)
    x = found.chains.samples
    assert 0.98 <= x.min() < 0.982
    assert 1.018 < x.max() <= 1.02
    assert x.std() == pytest.approx(0.04 / np.sqrt(12.0), rel=0.1)


def test_few_samples_are_doubted():
    model = chain([range(1)], n=1)
    weights = Weights({"frequency_sigma": 0.02, "prior_sigma": 0.05}, 0.0)
    _, found = sampled(model, [1.2], weights, count=20)
    assert "ask for more" in found.doubts[0]


def test_where_nothing_is_left_of_the_residuals_there_is_no_posterior(monkeypatch):
    one = np.ones((1, 1))
    none = Scatter(one, 0.0, one[0], one[0])
    monkeypatch.setattr(Problem, "scatter", lambda *_: none)
    weights = Weights({"frequency_sigma": 0.02, "prior_sigma": 0.05}, 0.0)
    with pytest.raises(InputError, match="the posterior is a point"):
        sampled(chain([range(1)], n=1), [1.2], weights)
