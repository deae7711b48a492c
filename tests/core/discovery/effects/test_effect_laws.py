"""Connections that get a finite stiffness."""

import numpy as np
import pytest

from trueup.core.discovery.effects.effect_laws import FactorLaw, ReleaseLaw, directions

RNG = np.random.default_rng(8)
NO_PARAMETERS = np.zeros(0)


def _definite(n: int) -> np.ndarray:
    half = RNG.normal(size=(n, n))
    return half @ half.T + 0.1 * np.eye(n)


@pytest.mark.parametrize("free", [0, 2])
@pytest.mark.parametrize("k", [0.01, 3.0, 500.0])
def test_freed_coordinates_taken_one_by_one_are_the_springs_taken_together(free, k):
    A = np.array([_definite(5), _definite(5)])
    d, W = directions(A, free)
    sprung = np.diag([0.0] * free + [1.0] * (5 - free))
    for one, own, turn in zip(A, d, W, strict=True):
        together = turn.T @ np.diag(1.0 / (own + k * np.diag(sprung))) @ turn
        np.testing.assert_allclose(together, np.linalg.inv(one + k * sprung), atol=1e-8)


@pytest.mark.parametrize("free", [0, 1])
def test_a_release_on_a_basis_that_lacks_flexibility_is_the_release_of_the_whole(free):
    """A structure of nine dofs on three held ones, seen on the four lowest of its modes."""
    n, q, k = 9, 3, 0.7
    whole = _definite(n + q)
    K, R, C = whole[:n, :n], whole[n:, :n], whole[n:, n:]
    (d,), (turn,) = directions(C[None], free)
    R = turn @ R
    values, vectors = np.linalg.eigh(K)
    basis, rest = vectors[:, :4], vectors[:, 4:] / np.sqrt(values[4:])
    law = ReleaseLaw(d[None], np.zeros((1, q, 0)), np.zeros(0), free)
    beyond = R @ rest
    law = law.on_basis(np.zeros(1, int), (beyond @ beyond.T)[None], NO_PARAMETERS, 0.0)
    change = law.value(np.log([[k]]), np.zeros(1, int))[0]
    U = law.turn[0] @ R @ basis
    soft = np.linalg.inv(np.diag(values[:4]) + (U.T * change) @ U)
    springs = np.diag([0.0] * free + [k] * (q - free))
    expected = np.linalg.inv(
        np.block([[K, (np.linalg.inv(turn) @ R).T], [whole[n:, :n], C + springs]])
    )
    np.testing.assert_allclose(soft, basis.T @ expected[:n, :n] @ basis, rtol=1e-7)


def test_the_slope_of_a_release_is_that_of_its_value():
    law = ReleaseLaw(np.array([[2.0, 5.0]]), np.full((1, 2, 1), 0.3), np.array([0.2]), 1)
    first, theta, step = np.zeros(1, int), np.array([[0.4]]), 1e-6
    rise = law.value(theta + step, first) - law.value(theta - step, first)
    np.testing.assert_allclose(law.slope(theta, first)[:, 0], rise / (2.0 * step), atol=1e-8)
    assert law.slope(theta, first)[0, 0, 0] == 0.0


def test_a_factor_takes_no_more_than_the_known_parameters_left():
    law = FactorLaw(np.array([[1.0, 0.0], [3.0, 1.0]]))
    left = np.log([0.7, 0.9])
    there = law.on_basis(np.array([1]), None, left, 0.0)
    theta, first = np.log([[0.05]]), np.zeros(1, int)
    held = 0.7**3 * 0.9
    np.testing.assert_allclose(there.value(theta, first), [[(0.05 - 1.0) * held]])
    assert held + there.value(theta, first)[0, 0] > 0.0
    step = 1e-6
    rise = there.value(theta + step, first) - there.value(theta - step, first)
    np.testing.assert_allclose(there.slope(theta, first)[:, 0], rise / (2.0 * step), rtol=1e-7)
    for q in (0, 1):
        up, down = (
            law.on_basis(np.array([1]), None, left + s * np.eye(2)[q], 0.0).value(theta, first)
            for s in (step, -step)
        )
        slope = there.by_parameter(theta, first, q)
        np.testing.assert_allclose(slope, (up - down) / (2.0 * step), rtol=1e-7)
    assert there.by_parameter(theta, first, 2) is None
