import numpy as np
import pytest
import scipy.linalg as la

from trueup.core.discovery.search.exact_scan import _attached, _changed, _gram, best_apart

RNG = np.random.default_rng(1)
LAM = np.sort(RNG.uniform(1.0, 50.0, 12))
U = RNG.normal(size=(5, 3, 12)) * 0.4


@pytest.mark.parametrize("on", ["K", "M"])
def test_every_place_is_an_exact_solution_of_the_changed_eigenproblem(on):
    c = np.array([0.3, 1.0, 2.0, 0.1, 5.0])[:, None] * np.ones(3)
    values, Z = _changed(LAM, _gram(U, c), on)
    for g in range(5):
        change = (U[g].T * c[g]) @ U[g]
        K = np.diag(LAM) + (change if on == "K" else 0.0)
        M = np.eye(12) + (change if on == "M" else 0.0)
        expected, vectors = la.eigh(K, M)
        np.testing.assert_allclose(values[g], expected, rtol=1e-9)
        np.testing.assert_allclose(np.abs(Z[g].T @ M @ vectors), np.eye(12), atol=1e-6)


def test_masses_on_a_free_structure_keep_its_rigid_body_modes():
    lam = np.concatenate([np.zeros(3), LAM[3:]])
    c = np.array([0.3, 1.0, 2.0, 0.1, 5.0])[:, None]
    values, Z = _changed(lam, _gram(U, c), "M")
    for g in range(5):
        M = np.eye(12) + c[g, 0] * U[g].T @ U[g]
        expected = la.eigh(np.diag(lam), M, eigvals_only=True)
        np.testing.assert_allclose(values[g], expected, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(Z[g].T @ M @ Z[g], np.eye(12), atol=1e-6)


def test_the_best_places_are_apart():
    xyz = np.array([[0.0, 0, 0], [0.1, 0, 0], [5.0, 0, 0], [5.1, 0, 0]])
    assert best_apart(xyz, np.array([2.0, 1.0, 4.0, 3.0]), 1.0, 5) == [1, 3]


def test_a_mass_on_springs_is_the_pencil_with_its_coordinates():
    m, k = np.array([[0.3], [1.0], [2.0], [0.1], [5.0]]), np.full((5, 3), 40.0)
    values, Z = _attached(LAM, U, m, k)
    for g in range(5):
        K = np.zeros((15, 15))
        K[:12, :12] = np.diag(LAM) + (U[g].T * k[g]) @ U[g]
        K[12:, :12] = -(k[g][:, None] * U[g])
        K[:12, 12:] = K[12:, :12].T
        K[12:, 12:] = np.diag(k[g])
        M = np.diag(np.r_[np.ones(12), np.full(3, m[g, 0])])
        expected, vectors = la.eigh(K, M)
        np.testing.assert_allclose(values[g], expected, rtol=1e-8)
        np.testing.assert_allclose(np.abs(Z[g]), np.abs(vectors[:12]), atol=1e-6)


def test_a_mass_on_rigid_springs_is_a_mass():
    m = np.full((5, 1), 0.7)
    stiff, _ = _attached(LAM, U, m, np.full((5, 3), 1e9))
    rigid, _ = _changed(LAM, _gram(U, m), "M")
    np.testing.assert_allclose(stiff[:, :12], rigid, rtol=1e-5)
