"""What a dashpot does to modes, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from trueup.core.discovery.likelihood.complex_modes import (
    added,
    complex_modes,
    imaginary,
    of_pairs,
    oriented,
    predicted,
    ratios,
)
from trueup.core.discovery.likelihood.mode_likelihood import Evidence, Noise, noise_of

K = np.array([[300.0, -100.0], [-100.0, 150.0]])
M = np.diag([1.0, 0.5])


def _two_dof() -> tuple[np.ndarray, np.ndarray]:
    lam, phi = np.linalg.eigh(np.diag(1 / np.sqrt(np.diag(M))) @ K @ np.diag(1 / np.diag(M) ** 0.5))
    return np.sqrt(lam), np.diag(1 / np.diag(M) ** 0.5) @ phi


@pytest.mark.parametrize("c", [0.01, 0.4, 3.0])
def test_two_masses_and_a_dashpot_have_the_roots_of_their_characteristic_polynomial(c):
    omega, phi = _two_dof()
    u = phi[1]
    poles, shapes = complex_modes(omega, c * np.outer(u, u))
    # det(s² M + s C + K) = 0 written out, the dashpot at the second mass
    first = np.array([M[0, 0], 0.0, K[0, 0]])
    second = np.array([M[1, 1], c, K[1, 1]])
    polynomial = np.polymul(first, second)
    polynomial[-1] -= K[0, 1] ** 2
    roots = np.roots(polynomial)
    roots = np.sort_complex(roots[roots.imag > 0])
    np.testing.assert_allclose(np.sort_complex(poles), roots, rtol=1e-9)
    for s, q in zip(poles, shapes.T, strict=True):
        x = phi @ q
        C = np.diag([0.0, c])
        left = (s**2 * M + s * C + K) @ x
        assert np.abs(left).max() < 1e-9 * np.abs(K @ x).max()


def test_a_rod_damped_at_its_end_decays_as_dalembert_says():
    """Fixed-free rod, dashpot at the free end: tanh(s L/a) = -EA/(a c), with r = a c/EA below 1
    all modes decay alike, Re s = -(a/L) artanh r."""
    L = a = EA = 1.0
    r = 0.05
    n = np.arange(1, 401)
    omega = (n - 0.5) * np.pi * a / L
    u = np.sqrt(2.0 / (EA / a**2 * L)) * np.sin((n - 0.5) * np.pi)
    poles, _ = complex_modes(omega, r * EA / a * np.outer(u, u))
    exact = -np.arctanh(r) + 1j * omega[:6]
    np.testing.assert_allclose(poles[:6].real, exact.real, rtol=5e-3)
    np.testing.assert_allclose(poles[:6].imag, exact.imag, rtol=1e-3)
    first = r * EA / a * added(u, omega)[:6]
    np.testing.assert_allclose(first, r / omega[:6], rtol=1e-12)


def test_the_first_order_is_the_slope_of_the_exact_solution():
    omega, phi = _two_dof()
    u, c = phi[1], 1e-4
    poles, shapes = complex_modes(omega, c * np.outer(u, u))
    np.testing.assert_allclose(ratios(poles) / c, added(u, omega), rtol=1e-6)
    e = Evidence(omega / (2 * np.pi), phi / np.linalg.norm(phi, axis=0), noise_of(None, 0.03))
    modes = oriented(e, omega**2, phi, 2)
    turned, _ = imaginary((phi @ modes.turn)[[1]], modes, phi @ modes.turn)
    along = modes.turn @ turned[0].T
    for j in range(2):
        other = 1 - j
        # up to the parts that may turn freely, which for modes this far apart is 1e-3
        assert along[other, j] == pytest.approx(shapes[other, j].imag / c, rel=2e-3)


def test_a_level_everywhere_stays_where_there_is_no_dashpot():
    omega = np.array([0.0, 3.0, 5.0, 9.0])
    out = predicted(omega, np.zeros((4, 4)), np.full(4, 0.013))
    assert np.isnan(out[0])
    np.testing.assert_allclose(out[1:], 0.013, rtol=1e-12)


def test_an_overdamped_mode_has_no_ratio_and_the_others_keep_theirs():
    omega = np.array([1.0, 10.0])
    poles, _ = complex_modes(omega, np.diag([4.0, 0.2]))
    assert np.isnan(poles[0])
    assert ratios(poles[[1]])[0] == pytest.approx(0.01)


@pytest.mark.parametrize(
    "noise", [noise_of(None, 0.03), Noise(np.full(3, 0.004), np.full(3, 0.05))]
)
def test_a_repeated_pair_lies_as_the_test_found_it(noise):
    """Two modes of one frequency, turned by 30 degrees in the test."""
    rng = np.random.default_rng(1)
    S = np.linalg.qr(rng.standard_normal((20, 3)))[0]
    t = np.radians(30.0)
    R = np.array([[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]])
    shapes = np.column_stack([S[:, :2] @ R, S[:, 2]])
    e = Evidence(np.array([10.0, 10.01, 15.0]), shapes, noise)
    lam = (2 * np.pi * np.array([10.0, 10.0, 15.0])) ** 2
    modes = oriented(e, lam, S, 3)
    np.testing.assert_allclose(np.abs((S @ modes.turn).T @ shapes), np.eye(3), atol=0.01)
    np.testing.assert_allclose(modes.turn.T @ modes.turn, np.eye(3), atol=1e-12)


def test_pairs_get_the_ratio_of_their_own_analysis_mode():
    lam = np.array([1.0, 4.0, 9.0])
    D = np.diag([0.2, 0.0, 0.0])
    out = of_pairs(lam, D, np.array([0.01, 0.02]), [(0, 2), (1, 0)])
    assert out[0] == pytest.approx(0.01, rel=1e-9)
    assert out[1] == pytest.approx(0.02 + 0.1, rel=1e-9)
