"""What a dashpot of any size does to a model, and a test without it: a rod in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from trueup.core.discovery.dampers.damped_model import damped
from trueup.core.discovery.dampers.damper_search import DampingEvidence, find_damper
from trueup.core.discovery.likelihood.complex_modes import Oriented
from trueup.core.discovery.likelihood.mode_likelihood import Evidence, noise_of

N, COUNT = 60, 8
X = np.linspace(0.05, 1.0, 20)
K = (np.arange(1, N + 1) - 0.5) * np.pi
U = np.sqrt(2.0) * np.sin(np.outer(X, K))
"""Fixed-free rod of unit length, mass and wave speed: frequencies [rad/s], shapes at places."""


def exact(place: int, c: float, count: int = COUNT) -> tuple[np.ndarray, np.ndarray]:
    """Poles and shapes of the continuous rod with a dashpot: waves that meet at its place.

    Left of it sinh(s x), right of it cosh(s (1 − x)); the force jumps by c s: roots of
    cosh s + c sinh(s a) cosh(s (1 − a)) = 0.
    """
    a = X[place]

    def balance(s):
        return np.cosh(s) + c * np.sinh(s * a) * np.cosh(s * (1.0 - a))

    s = 1j * K[:count]
    for share in np.linspace(0.0, 1.0, 101)[1:]:
        f = lambda z, b=share * c: np.cosh(z) + b * np.sinh(z * a) * np.cosh(z * (1 - a))  # noqa: E731
        for _ in range(6):
            h = 1e-6j
            s = s - f(s) * 2.0 * h / (f(s + h) - f(s - h))
    np.testing.assert_allclose(np.abs(balance(s)), 0.0, atol=1e-8)
    left = np.sinh(np.outer(X, s)) / np.sinh(s * a)
    right = np.cosh(np.outer(1.0 - X, s)) / np.cosh(s * (1.0 - a))
    return s, np.where(X[:, None] < a, left, right)


def evidence(poles: np.ndarray, shapes: np.ndarray) -> Evidence:
    unit = np.real(shapes) / np.linalg.norm(np.real(shapes), axis=0)
    return Evidence(np.abs(poles) / (2.0 * np.pi), unit, noise_of(None, 0.03))


def with_dashpot(place: int, c: float, poles: np.ndarray, shapes: np.ndarray):
    D = c * np.outer(U[place], U[place])
    return damped(evidence(poles, shapes), shapes, K, U, D)


@pytest.mark.parametrize(("place", "c"), [(6, 0.3), (12, 0.8), (10, 1.5)])
def test_poles_and_shapes_are_those_of_the_rod_in_closed_form(place, c):
    poles, shapes = exact(place, c)
    d = with_dashpot(place, c, poles, shapes)
    np.testing.assert_allclose(d.poles, poles, rtol=0.01)
    np.testing.assert_allclose(d.ratios, -poles.real / np.abs(poles), rtol=0.03, atol=1e-4)
    np.testing.assert_allclose(d.omega, K[:COUNT])
    np.testing.assert_allclose(d.stretched, np.abs(poles) / K[:COUNT], rtol=0.01)
    half = with_dashpot(place, 0.5 * c, poles, shapes)
    assert d.misfit < 0.1 * half.misfit


def test_modes_apart_are_their_own_without_the_dashpot():
    d = with_dashpot(12, 0.8, *exact(12, 0.8))
    np.testing.assert_allclose(np.abs(d.undamped), np.eye(N)[:, :COUNT], atol=1e-2)
    np.testing.assert_allclose(np.linalg.norm(d.shapes, axis=0), 1.0)
    assert len(d.moved)
    assert not len(with_dashpot(12, 0.01, *exact(12, 0.01)).moved)


def test_a_dashpot_that_stops_a_mode_leaves_every_measured_mode_a_partner():
    D = 1e4 * np.outer(U[12], U[12])[:COUNT, :COUNT]
    poles, shapes = exact(12, 0.8)
    d = damped(evidence(poles, shapes), shapes, K[:COUNT], U[:, :COUNT], D)
    assert sorted(d.omega) == pytest.approx(K[:COUNT])
    assert d.ratios.max() == pytest.approx(1.0)


@pytest.mark.parametrize(("place", "c"), [(7, 0.6), (12, 0.9)])
def test_the_size_of_a_heavy_dashpot_follows_from_its_exact_modes(place, c):
    """A model 1 % too stiff, noise, ratios of its own: to first order it comes out smaller."""
    rng = np.random.default_rng(4)
    poles, shapes = exact(place, c)
    own = rng.uniform(0.002, 0.01, COUNT)
    measured = -poles.real / np.abs(poles) + own
    phase = np.exp(-0.5j * np.angle(np.sum(shapes**2, axis=0)))
    shapes = shapes * phase
    scale = np.sqrt(np.mean(np.abs(shapes) ** 2, axis=0))
    shapes = shapes + 0.02 * scale * rng.standard_normal(shapes.shape)
    e, omega = evidence(poles, shapes), 1.005 * K
    modes = Oriented(np.concatenate([np.abs(poles), omega[COUNT:]]), np.eye(N), COUNT)

    def model(row: int, size: float, level: float):
        D = size * np.outer(U[row], U[row]) + np.diag(2.0 * level * omega)
        return damped(e, shapes, omega, U, D)

    said = DampingEvidence(measured, None, 12.0)
    none = np.zeros((N, N))
    found = find_damper(said, modes, U, U, none, model)
    assert found is not None
    assert found.exists > 0.5
    assert abs(X[found.rows[0]] - X[place]) < 0.06
    assert np.exp(found.log_size[0]) == pytest.approx(c, rel=0.3)
