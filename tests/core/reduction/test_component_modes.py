"""Component mode synthesis of a chain of masses against the chain itself."""

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.core.assembly.guyan import condensed, static_condensation, without_strain
from trueup.core.reduction.component_modes import component_modes

N = 8


def chain(grounded):
    K = 2.0 * np.eye(N) - np.eye(N, k=1) - np.eye(N, k=-1)
    K[-1, -1] = 1.0
    K[0, 0] = 2.0 if grounded else 1.0
    return sp.csr_matrix(K), sp.identity(N, format="csr")


def eigenvalues(K, M, T):
    rigid = np.zeros((T.shape[1], 0))
    K, M = (condensed(A, T, rigid).toarray() for A in (K, M))
    return np.linalg.eigvals(np.linalg.solve(M, K)).real


@pytest.mark.parametrize("grounded", [True, False])
@pytest.mark.parametrize("held", [[], [0], [0, N - 1]])
def test_all_modes_make_the_whole_structure(grounded, held):
    """Every mode of the component beside the constraint modes: nothing is lost."""
    K, M = chain(grounded)
    kept = np.array([0, N - 1])
    T = static_condensation(K, kept, np.zeros((N, 0)))
    modes = component_modes(K, M, T, kept, np.array(held, int), N - len(held), None)
    basis = np.hstack([T, modes])
    u, s, _ = np.linalg.svd(basis, full_matrices=False)
    found = eigenvalues(K, M, u[:, s > 1e-9 * s[0]])
    np.testing.assert_allclose(np.sort(found), np.linalg.eigvalsh(K.toarray()), atol=1e-10)


def test_a_free_boundary_makes_the_modes_it_was_given():
    K, M = chain(True)
    kept = np.array([N - 1])
    T = static_condensation(K, kept, np.zeros((N, 0)))
    modes = component_modes(K, M, T, kept, np.array([], int), 3, None)
    found = np.sort(eigenvalues(K, M, np.hstack([T, modes])))
    np.testing.assert_allclose(found[:3], np.linalg.eigvalsh(K.toarray())[:3], rtol=1e-10)
    assert not modes[kept].any()


def test_rigid_body_modes_are_the_constraint_modes_already():
    K, M = chain(False)
    kept = np.array([0])
    T = static_condensation(K, kept, np.zeros((N, 0)))
    assert component_modes(K, M, T, kept, np.array([], int), 3, None).shape == (N, 2)


def test_condensation_leaves_rigid_motions_free():
    """Springs that differ by 1e9: what is left by rounding would hold the chain."""
    k = np.array([1e9, 1.0, 1e9, 1.0, 1e9, 3.0, 1e9])
    ends = np.arange(N - 1)
    B = sp.csr_matrix(
        (np.tile([1.0, -1.0], N - 1), (np.repeat(ends, 2), np.c_[ends, ends + 1].ravel()))
    )
    K, kept = (B.T @ sp.diags(k) @ B).tocsr(), np.array([1, 3, 6])
    rigid = without_strain(K, np.ones((N, 1)))
    assert rigid.shape == (N, 1)
    T = static_condensation(K, kept, rigid)
    np.testing.assert_allclose(T.sum(axis=1), 1.0, rtol=1e-15)
    found = condensed(K, T, rigid[kept]).toarray()
    assert np.abs(found.sum(axis=1)).max() < 1e-15 * found.max()
    assert without_strain(K + sp.identity(N), np.ones((N, 1))).shape == (N, 0)
