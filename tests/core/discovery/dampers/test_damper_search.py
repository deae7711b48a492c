"""Is there a dashpot, and where: a rod whose modes are known in closed form."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.discovery.dampers.damper_numbers import DAMPERS
from trueup.core.discovery.dampers.damper_search import DampingEvidence, find_damper
from trueup.core.discovery.dampers.damping_ratios import levels_for, log_likelihood, marginal
from trueup.core.discovery.likelihood.complex_modes import Oriented, complex_modes, ratios

N, COUNT, C = 14, 10, 1.0
X = np.linspace(0.025, 1.0, 40)
"""Places and sensors along a fixed-free rod of unit mass, length and wave speed."""
FIRST = 4
"""Modes 5 to 14 are measured: of the lowest, one at 1/ω looks like damping by mass."""


def _rod(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    k = (np.arange(1, N + 1) + FIRST - 0.5) * np.pi
    return k, np.sqrt(2.0) * np.sin(np.outer(x, k))


OMEGA, U = _rod(X)
MODES = Oriented(OMEGA, np.eye(N), COUNT)
NONE = np.zeros((N, N))


def _scatter(rng: np.random.Generator) -> np.ndarray:
    return rng.uniform(0.002, 0.012, N)


def _damped(place: int, c: float, level: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ratios and imaginary parts at the sensors, exactly."""
    D = c * np.outer(U[place], U[place]) + np.diag(2.0 * level * OMEGA)
    poles, shapes = complex_modes(OMEGA, D)
    y = U @ shapes[:, :COUNT]
    phase = 0.5 * np.angle(np.sum(y**2, axis=0))
    y = y * np.exp(-1j * phase)
    sign = np.sign(np.sum(y.real * U[:, :COUNT], axis=0))
    return ratios(poles)[:COUNT], (y * sign).imag


def _found(measured, imaginary=None, known=NONE):
    e = DampingEvidence(np.asarray(measured), imaginary, 12.0)
    found = find_damper(e, MODES, U, U, known)
    assert found is not None
    return found


def test_a_dashpot_is_found_at_its_place_with_its_size():
    rng = np.random.default_rng(3)
    right = 0
    for place in (12, 20, 29):
        z, _ = _damped(place, C, _scatter(rng))
        found = _found(z)
        assert found.exists > 0.6
        near = np.abs(X[found.rows] - X[place]) < 0.06
        right += found.weights[near].sum() > 0.5
        k = int(np.flatnonzero(near)[0])
        assert abs(found.log_size[k] - np.log(C)) < 3.0 * np.hypot(found.log_deviation[k], 0.12)
        assert found.weights.sum() == pytest.approx(1.0)
    assert right >= 2


def test_complex_shapes_make_it_surer():
    """A dashpot too small to be seen in the ratios alone shows in shapes out of phase."""
    z, y = _damped(20, 0.3 * C, _scatter(np.random.default_rng(5)))
    noise = 0.02 * np.random.default_rng(6).standard_normal(y.shape)
    without, beside = _found(z), _found(z, y + noise)
    assert without.exists < 0.6
    assert beside.exists > 0.95
    assert beside.weights[np.abs(X[beside.rows] - X[20]) < 0.06].sum() > 0.9
    assert _found(z, -y + noise).exists < beside.exists


def test_noise_in_complex_shapes_says_nothing():
    rng = np.random.default_rng(7)
    for _ in range(10):
        noise = 0.1 * rng.standard_normal((len(X), COUNT))
        assert _found(_scatter(rng)[:COUNT], noise).exists < 0.5


def test_a_dashpot_that_the_deck_has_is_not_missing():
    z, _ = _damped(20, C, _scatter(np.random.default_rng(3)))
    known = C * np.outer(U[20], U[20])
    assert _found(z).exists > 0.6
    assert _found(z, known=known).exists < 0.5


def test_too_few_ratios_say_nothing():
    z = np.full(COUNT, np.nan)
    z[:4] = 0.01
    e = DampingEvidence(z, None, 12.0)
    assert find_damper(e, MODES, U, U, NONE) is None
    zero = replace(e, measured=np.zeros(COUNT))
    assert find_damper(zero, MODES, U, U, NONE) is None


def _draws(kind: str, rng: np.random.Generator) -> np.ndarray:
    z = rng.uniform(0.002, 0.012, COUNT)
    if kind == "all at 3 %":
        return 0.03 * np.exp(0.15 * rng.standard_normal(COUNT))
    if kind == "one heavy mode":
        z[rng.integers(COUNT)] *= 6.0
    if kind == "wide":
        return 0.01 * np.exp(0.6 * rng.standard_normal(COUNT))
    if kind == "Rayleigh":
        x, share = OMEGA[:COUNT] / OMEGA[:COUNT].mean(), rng.uniform()
        return 0.01 * (share / x + (1 - share) * x) * np.exp(0.25 * rng.standard_normal(COUNT))
    return z


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "draws", "most"),
    [
        ("0.2 to 1.2 %", 200, 1),
        ("all at 3 %", 40, 0),
        ("one heavy mode", 40, 0),
        ("wide", 40, 0),
        ("Rayleigh", 40, 0),
    ],
)
def test_random_damping_raises_no_alarm(kind, draws, most):
    """Draws without a dashpot: at most one in two hundred names a place."""
    rng = np.random.default_rng(11)
    alarms = 0
    for _ in range(draws):
        found = _found(_draws(kind, rng))
        near = np.abs(X[found.rows][:, None] - X[found.rows][None]) < 0.1
        alarms += found.exists * (near @ found.weights).max() > 0.6
    assert alarms <= most


def test_levels_are_integrated_out():
    """The marginal likelihood is the mean of the likelihoods over the prior."""
    z = np.array([0.004, 0.006, 0.011, 0.008, 0.005])
    omega = np.linspace(1.0, 5.0, 5)
    grid = levels_for(z, omega)
    assert np.exp(grid.log_prior).sum() == pytest.approx(1.0)
    none = np.zeros(5)
    each = log_likelihood(z, grid, none, none)
    plain = np.sum(np.exp(grid.log_prior) * np.exp(each))
    assert marginal(z, grid, none, none) == pytest.approx(np.log(plain))
    batch = marginal(z, grid, np.zeros((3, 2, 5)), np.zeros((3, 2, 5)))
    assert batch.shape == (3, 2)
    np.testing.assert_allclose(batch, np.log(plain))


def test_densities_of_many_modes_are_multiplied_within_what_a_float_holds():
    z = np.geomspace(1e-4, 0.5, 300)
    grid = levels_for(z, np.linspace(1.0, 50.0, 300))
    part = 0.1 * z
    v = ((grid.spreads[:, None] * grid.levels) ** 2 + (0.2 * part) ** 2) / (grid.levels + part) ** 2
    v += DAMPERS.measured**2
    t = np.log((grid.levels + part) / z)
    one_by_one = -0.5 * (DAMPERS.tails + 1.0) * np.log(1.0 + t**2 / (DAMPERS.tails * v))
    one_by_one -= 0.5 * np.log(v)
    together = log_likelihood(z, grid, part, 0.2 * part)
    np.testing.assert_allclose(together, one_by_one.sum(axis=-1), rtol=1e-10)
