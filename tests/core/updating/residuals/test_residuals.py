"""Residuals of equations (5) and (6): closed forms, scaling, gradients."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.linalg import polar
from tests.core.updating.weighing import eigenvalue_residuals, shape_residuals

from trueup.core.correlation.mac import mac
from trueup.core.correlation.mode_pairing import Pair
from trueup.core.eigen.normal_modes import solve
from trueup.core.errors import InputError
from trueup.core.reduction.eigenpair_derivatives import sensitivities
from trueup.core.updating.residuals import Weights


def pair(test_hz: float, analysis_hz: float) -> Pair:
    return Pair(0, 0, test_hz, analysis_hz, 1.0)


def shapes_at(p, seed=3, sensors=9, modes=4):
    """Shapes that bend with two parameters, and their derivatives."""
    rng = np.random.default_rng(seed)
    a, b, c = rng.standard_normal((3, sensors, modes))
    values = a + p[0] * b + p[0] ** 2 * p[1] * c
    slopes = np.stack([b + 2.0 * p[0] * p[1] * c, p[0] ** 2 * c], axis=-1)
    return values, slopes


def test_an_eigenvalue_residual_is_the_relative_difference_over_twice_sigma():
    hz = np.array([10.0, 20.0])
    lam = (2.0 * np.pi * hz * [1.1, 1.0]) ** 2
    slopes = np.array([[lam[0]], [0.5 * lam[1]]])
    found = eigenvalue_residuals([pair(10.0, 11.0), pair(20.0, 20.0)], lam, slopes, 0.01)
    np.testing.assert_allclose(found.values, [(1.1**2 - 1.0) / 0.02, 0.0], atol=1e-12)
    np.testing.assert_allclose(found.gradient, [[1.1**2 / 0.02], [0.5 / 0.02]])


def test_a_small_frequency_error_of_one_sigma_is_one():
    lam = (2.0 * np.pi * 10.0 * (1.0 + 1e-6)) ** 2
    found = eigenvalue_residuals([pair(10.0, 10.0)], np.array([lam]), np.ones((1, 1)), 1e-6)
    assert found.values[0] == pytest.approx(1.0, rel=1e-6)


@given(st.integers(0, 10_000), st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
def test_the_squared_length_of_a_shape_residual_is_one_minus_mac(seed, scale_a, scale_t):
    rng = np.random.default_rng(seed)
    analysis, test = (
        rng.standard_normal((2, 7, 3)) * np.array([10.0**scale_a, 10.0**scale_t])[:, None, None]
    )
    found = shape_residuals(analysis, np.zeros((7, 3, 1)), test, 1.0).values.reshape(3, 7)
    np.testing.assert_allclose(
        np.sum(found**2, axis=1), 1.0 - np.diag(mac(test, analysis)), atol=1e-12
    )
    np.testing.assert_allclose(
        found, shape_residuals(analysis, np.zeros((7, 3, 1)), -5.0 * test, 1.0).values.reshape(3, 7)
    )


def test_a_shape_like_the_test_has_no_residual():
    values, slopes = shapes_at([0.4, 0.7])
    found = shape_residuals(values, slopes, -0.3 * values, 0.1)
    np.testing.assert_allclose(found.values, 0.0, atol=1e-13)


def test_the_gradient_agrees_with_central_differences():
    p, h = np.array([0.4, 0.7]), 1e-5
    test = shapes_at([0.5, 0.6])[0] + 0.1
    found = shape_residuals(*shapes_at(p), test, 0.1)
    for k in range(2):
        up, down = (
            shape_residuals(*shapes_at(p + s * h * np.eye(2)[k]), test, 0.1).values for s in (1, -1)
        )
        difference = (up - down) / (2.0 * h)
        np.testing.assert_allclose(
            found.gradient[:, k], difference, atol=1e-5 * abs(difference).max()
        )


def test_rows_stand_pair_by_pair():
    values, slopes = shapes_at([0.4, 0.7])
    test = np.random.default_rng(0).standard_normal(values.shape)
    both = shape_residuals(values, slopes, test, 0.1)
    first = shape_residuals(values[:, :1], slopes[:, :1], test[:, :1], 0.1)
    np.testing.assert_allclose(both.values[:9], first.values)
    np.testing.assert_allclose(both.gradient[:9], first.gradient)


@pytest.mark.parametrize("spin", [0.0, 0.3, np.pi / 4])
def test_residuals_of_a_ring_agree_with_central_differences(ring, spin):
    """Repeated eigenvalues, turned onto the test: the turned pair is followed as a subspace."""
    n = 16
    model = ring(n, parameters=[("E", [0, 1, 2, n // 2]), ("rho", range(5, 8))])
    p, h = np.ones(2), 1e-4
    C = np.eye(model.n_free)[[6 * i + 2 for i in range(0, n, 2)]]
    here = solve(model, 14, p=p, tolerance=1e-11)
    c, s = np.cos(spin), np.sin(spin)
    cluster = [6, 7]
    assert here.eigenvalues[7] / here.eigenvalues[6] - 1.0 < 1e-8
    T = np.zeros((14, 2))
    T[cluster] = [[c, -s], [s, c]]
    test = np.random.default_rng(1).standard_normal((len(C), 2))
    pairs = [pair(50.0, 1.0), pair(60.0, 1.0)]
    lam, slopes, shapes = sensitivities(model, p, here, T, [0, 1], C)
    found = (
        eigenvalue_residuals(pairs, lam, slopes, 0.01),
        shape_residuals(C @ here.vectors @ T, shapes, test, 0.1),
    )

    def at(q):
        """The subspace at q, turned without stretching onto the one here, then by T."""
        there = solve(model, 14, p=q, tolerance=1e-11)
        X, X0 = there.vectors[:, cluster], here.vectors[:, cluster]
        turn = polar(X.T @ (model.M(p) @ X0))[0] @ T[cluster]
        quotients = np.einsum("ij,i,ij->j", turn, there.eigenvalues[cluster], turn)
        none = np.zeros((2, 1))
        return (
            eigenvalue_residuals(pairs, quotients, none, 0.01).values,
            shape_residuals(C @ X @ turn, np.zeros((len(C), 2, 1)), test, 0.1).values,
        )

    for k in range(2):
        ends = [at(p + s * h * np.eye(2)[k]) for s in (1, -1)]
        for kind in range(2):
            difference = (ends[0][kind] - ends[1][kind]) / (2.0 * h)
            np.testing.assert_allclose(
                found[kind].gradient[:, k], difference, atol=1e-5 * abs(difference).max()
            )


@pytest.mark.parametrize(
    "sigmas",
    [{"frequency_sigma": 0.0}, {"shape_sigma": -1.0}, {"frequency_sigma": np.nan}, {"sigma": 1.0}],
)
def test_weights_that_make_no_sense_are_refused(sigmas):
    with pytest.raises(InputError):
        Weights(sigmas)
    with pytest.raises(InputError):
        Weights(regularisation=-1.0)
