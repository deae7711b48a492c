"""The reduced matrices of a small basis, and the flexibility that it lacks."""

from types import SimpleNamespace

import numpy as np
import pytest
import scipy.sparse as sp
from numpy.polynomial import chebyshev
from tests.core.chains import proportional

from trueup.core.data.parametric_model import Factor, Term
from trueup.core.discovery.reduction.residual_flexibility import (
    Compliance,
    Flexibility,
    Lost,
    SharedFlexibility,
)
from trueup.core.discovery.reduction.search_basis import independent
from trueup.core.reduction.reduced_sum import reduced_sum

RNG = np.random.default_rng(4)
V = RNG.normal(size=(30, 6))
THICKNESS = Factor(1, (1.1, 0.7, 0.2, -0.05), 0.5, 1.6)


def _term(*factors: Factor) -> Term:
    half = sp.random(30, 30, 0.1, random_state=5)
    return Term((half + half.T).tocsr(), factors)


TERMS = (_term(), _term(proportional(0, 0.5, 2.0)), _term(proportional(0, 0.5, 2.0), THICKNESS))
P = np.array([1.3, 0.8])


def test_a_factor_is_its_chebyshev_series():
    x = (2.0 * P[1] - 2.1) / 1.1
    slope = chebyshev.chebval(x, chebyshev.chebder(np.array(THICKNESS.coefficients)))
    assert THICKNESS.value(P) == pytest.approx(chebyshev.chebval(x, THICKNESS.coefficients))
    assert THICKNESS.derivative(P) == pytest.approx(slope * 2.0 / 1.1)
    assert proportional(0, 0.5, 2.0).value(P) == pytest.approx(1.3)


@pytest.mark.parametrize("turn", [np.eye(6), RNG.normal(size=(6, 4))])
def test_the_reduced_sum_is_the_full_sum_on_the_turned_basis(turn):
    full = sum(t.coefficient(P) * t.matrix for t in TERMS)
    own = reduced_sum(TERMS, V).turned(turn)
    np.testing.assert_allclose(own.at(P), (V @ turn).T @ (full @ (V @ turn)), atol=1e-10)


def test_a_sum_on_more_vectors_is_that_on_all_of_them():
    W = RNG.normal(size=(30, 2))
    wide = reduced_sum(TERMS, V).widened([V], W)
    np.testing.assert_allclose(wide.whole, reduced_sum(TERMS, np.hstack([V, W])).whole, atol=1e-12)


def test_the_slopes_are_those_of_the_sum():
    own = reduced_sum(TERMS, V)
    for slope, step in zip(own.slopes(P, [1, 0]), (1e-6 * np.eye(2))[::-1], strict=True):
        expected = (own.at(P + step) - own.at(P - step)) / 2e-6
        np.testing.assert_allclose(slope, expected, atol=1e-6)


SPREAD = sp.random(8, 30, 0.2, random_state=6, format="csr")
TOGETHER = (sp.random(8, 5, 0.6, random_state=6) @ sp.identity(30, format="csr")[7:12]).tocsr()


@pytest.mark.parametrize("loads", [SPREAD, TOGETHER], ids=["spread", "at the same few grids"])
def test_what_a_basis_lacks_is_the_rest_of_the_flexibility(loads):
    half = RNG.normal(size=(30, 30))
    K, M = sp.csr_matrix(half @ half.T), sp.identity(30, format="csr")
    model = SimpleNamespace(K=lambda: K, M=lambda: M)
    known = Compliance(model, SimpleNamespace(sigma=-2.0, factor=None))
    each = sp.identity(8, format="csr")
    lacking = Flexibility(Lost(known, V), loads, each, 2)
    A = K.toarray() + 2.0 * np.eye(30)
    lost = np.linalg.inv(A) - V @ np.linalg.inv(V.T @ A @ V) @ V.T
    expected = np.einsum("ij,jk,ik->i", loads.toarray(), lost, loads.toarray()).reshape(4, 2)
    for rows in ([2], [0, 2, 3, 2]):
        np.testing.assert_allclose(lacking[np.array(rows)], expected[rows], rtol=1e-8)


def test_a_spring_between_two_places_lacks_what_a_basis_lacks_at_either_end():
    half, near = RNG.normal(size=(15, 15)), RNG.normal(size=(15, 3))
    K, M = sp.csr_matrix(np.kron(np.eye(2), half @ half.T)), sp.identity(30, format="csr")
    basis = np.kron(np.eye(2), near)
    model = SimpleNamespace(K=lambda: K, M=lambda: M)
    known = Compliance(model, SimpleNamespace(sigma=-2.0, factor=None))
    ends = sp.csr_matrix(np.eye(30)[[2, 20]])
    lacking = Flexibility(Lost(known, basis), ends, sp.csr_matrix([[-1.0, 1.0]]), 1)
    A = K.toarray() + 2.0 * np.eye(30)
    lost = np.linalg.inv(A) - basis @ np.linalg.inv(basis.T @ A @ basis) @ basis.T
    line = np.eye(30)[20] - np.eye(30)[2]
    np.testing.assert_allclose(lacking[np.array([0])], [[line @ lost @ line]], rtol=1e-8)


def test_what_a_basis_lacks_among_the_loads_of_a_candidate_is_the_rest_of_the_flexibility():
    half = RNG.normal(size=(30, 30))
    K, M = sp.csr_matrix(half @ half.T), sp.identity(30, format="csr")
    model = SimpleNamespace(K=lambda: K, M=lambda: M)
    known = Compliance(model, SimpleNamespace(sigma=-2.0, factor=None))
    loads = sp.random(5, 30, 0.3, random_state=6, format="csr")
    turns = sp.random(8, 5, 0.5, random_state=7, format="csr")
    lacking = SharedFlexibility(Lost(known, V), loads, turns, 2)
    A = K.toarray() + 2.0 * np.eye(30)
    lost = np.linalg.inv(A) - V @ np.linalg.inv(V.T @ A @ V) @ V.T
    own = (turns @ loads).toarray().reshape(4, 2, 30)
    expected = np.einsum("nij,jk,nlk->nil", own, lost, own)
    for rows in ([2], [0, 2, 3, 2]):
        np.testing.assert_allclose(lacking[np.array(rows)], expected[rows], rtol=1e-7, atol=1e-12)


def test_loads_of_modes_that_strain_nothing_and_loads_that_others_make_up_are_left_out():
    noise = 1e-12 * RNG.standard_normal((30, 2))
    own = independent(np.hstack([noise, 1e-3 * V[:, :2], V[:, 2:4], V[:, :1] - V[:, 3:4]]))
    assert own.shape == (30, 4)
    assert np.linalg.matrix_rank(np.hstack([own, V[:, :4]])) == 4
    assert independent(np.zeros((30, 3))).shape == (30, 0)
