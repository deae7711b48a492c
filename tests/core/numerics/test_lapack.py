"""LAPACK called directly: what its routines promise, and inputs left as they were."""

import numpy as np
import pytest

from trueup.core.numerics.lapack import eigenpairs, lower_solved


def test_eigenpairs_solve_the_pencil_and_are_orthonormal_in_mass() -> None:
    rng = np.random.default_rng(1)
    A, B = rng.standard_normal((2, 9, 9))
    K, M = A + A.T, B @ B.T + np.eye(9)
    kept = K.copy(), M.copy()
    values, vectors = eigenpairs(K, M)
    assert np.all(np.diff(values) >= 0.0)
    np.testing.assert_allclose(K @ vectors, M @ vectors * values, atol=1e-10)
    np.testing.assert_allclose(vectors.T @ M @ vectors, np.eye(9), atol=1e-12)
    assert np.array_equal(K, kept[0])
    assert np.array_equal(M, kept[1])


def test_a_negative_mass_is_no_pencil() -> None:
    with pytest.raises(np.linalg.LinAlgError):
        eigenpairs(np.eye(3), np.diag([1.0, -1.0, 1.0]))


def test_lower_solved_solves_one_and_many_triangles() -> None:
    rng = np.random.default_rng(2)
    L = np.tril(rng.standard_normal((4, 6, 6))) + 4.0 * np.eye(6)
    B = rng.standard_normal((4, 3, 6)).transpose(0, 2, 1)
    found = lower_solved(L, B)
    np.testing.assert_allclose(L @ found, B, atol=1e-12)
    np.testing.assert_allclose(lower_solved(L[1], B[1]), found[1], atol=1e-14)
