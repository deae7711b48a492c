"""The iteration by itself: restarts, growth, exhaustion, locked vectors."""

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.core.numerics.block_lanczos import BlockLanczos
from trueup.core.numerics.factorisation import factorise


def run(K, M, wanted, room, steps, locked=None, width=4):
    n = K.shape[0]
    start = np.random.default_rng(0).standard_normal((n, width))
    locked = np.zeros((n, 0)) if locked is None else locked
    lanczos = BlockLanczos(factorise(K, True).solve, M, start, locked, room)
    sizes = []
    for _ in range(steps):
        lanczos.step()
        theta, residual = lanczos.ritz()
        sizes.append(lanczos.size)
        if lanczos.exhausted or (residual[:wanted] < 1e-10 * theta[:wanted]).all():
            break
        if lanczos.full:
            lanczos.restart(wanted + 4)
        lanczos.advance()
    return lanczos, theta, sizes


def test_restarts_reach_the_same_modes_in_a_small_basis(membrane):
    K, M, exact = membrane(25)
    lanczos, theta, sizes = run(K, M, 6, 24, 200)
    assert max(sizes) <= 28
    assert min(np.diff(sizes)) < 0
    np.testing.assert_allclose(1.0 / theta[:6], exact[:6], rtol=1e-10)
    X = lanczos.taken(6)
    np.testing.assert_allclose(X.T @ (M @ X), np.eye(6), atol=1e-9)
    np.testing.assert_allclose(K @ X, M @ X / theta[:6], atol=1e-7)


def test_the_room_grows_when_most_of_it_is_wanted(membrane):
    K, M, exact = membrane(25)
    _, theta, sizes = run(K, M, 30, 40, 200)
    assert max(sizes) > 44
    np.testing.assert_allclose(1.0 / theta[:30], exact[:30], rtol=1e-9)


def test_the_range_of_a_singular_mass_is_exhausted(membrane):
    K, _, _ = membrane(12)
    at = [3, 40, 41, 90, 143]
    M = sp.csr_matrix((np.arange(1.0, 6.0), (at, at)), K.shape)
    lanczos, theta, _ = run(K, M, 100, 60, 50)
    root = np.sqrt(np.arange(1.0, 6.0))
    exact = np.linalg.eigvalsh(root[:, None] * np.linalg.inv(K.toarray())[np.ix_(at, at)] * root)
    assert lanczos.exhausted
    assert lanczos.size == 5
    np.testing.assert_allclose(theta, exact[::-1], rtol=1e-10)


def test_locked_modes_do_not_come_back(membrane):
    K, M, exact = membrane(20)
    first, _, _ = run(K, M, 5, 60, 100)
    _, theta, _ = run(K, M, 4, 60, 100, locked=first.taken(5))
    np.testing.assert_allclose(1.0 / theta[:4], exact[5:9], rtol=1e-9)


@pytest.mark.parametrize("width", [1, 3, 16])
def test_any_width(membrane, width):
    K, M, exact = membrane(15, mass=2.0)
    _, theta, _ = run(K, M, 3, 80, 200, width=width)
    assert abs(1.0 / theta[0] / exact[0] - 1.0) < 1e-10
