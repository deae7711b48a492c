"""A mast whose modes come in pairs: which vectors of a pair a solver gives must not count."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp
from tests.core.discovery.strings import K, N, hidden, searcher

from trueup.core.data.parametric_model import Term
from trueup.core.discovery.likelihood.likelihood_numbers import LIKELIHOOD
from trueup.core.discovery.likelihood.map_fit import fit, solve
from trueup.core.discovery.likelihood.mode_likelihood import Evidence
from trueup.core.discovery.likelihood.repeated_modes import in_pairs, none_cut, turned_to_test
from trueup.core.discovery.model_error.diffuse_fit import judged
from trueup.core.reduction.reduced_sum import ReducedSum


def doubled(A):
    """Return A (n, m) for two directions, columns in pairs: (2n, 2m)."""
    return np.kron(A, np.eye(2))


def turn(angles):
    """Turn each pair of vectors by an angle."""
    parts = [[[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]] for a in angles]
    return la.block_diag(*parts)


def mast(angles):
    """A string that moves in two directions, which lacks a mass, its pairs turned by angles.

    The error of its mesh is mass on the first of its beads.
    """
    p = searcher(hidden(1.1, masses=[(9, 4.0)]), n_modes=6).problem
    values, linear = np.linalg.eigvalsh(K), p.basis.stiffness.terms[0].factors
    stiffness = ReducedSum(
        (Term(sp.csr_matrix(doubled(K)), linear),), np.diag(np.repeat(values, 2))[None]
    )
    mass = ReducedSum((Term(sp.eye(2 * N, format="csr")),), np.eye(2 * N)[None])
    vectors = doubled(p.basis.vectors)
    basis = replace(p.basis, vectors=vectors, motion=vectors, stiffness=stiffness, mass=mass)
    lumps = np.repeat(np.where(np.arange(N) < 14, 0.3, 0.0), 2)
    e, seen = p.whole, doubled(p.sensors)
    shapes = doubled(e.shapes) @ turn(np.linspace(0.3, 1.4, 6))
    e = Evidence(np.repeat(e.frequencies_hz, 2), shapes, e.noise, e.scatter, e.reading)
    whole = replace(
        p, basis=basis, evidence=e, whole=e, sensors=seen, everywhere=seen,
        mesh=vectors.T @ (lumps[:, None] * vectors), catalogue=(), factors=(), modes=23,
    )  # fmt: skip
    return whole.turned(turn(angles))


@pytest.mark.parametrize("seed", range(3))
def test_a_fit_is_the_same_whatever_vectors_a_solver_gives(seed):
    angles = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, N)
    both = [mast(np.zeros(N)), mast(angles)]
    first, other = (fit(p, np.zeros(2), (), (0, 1), 8) for p in both)
    assert abs(first.nuisance[1]) > 0.1
    assert other.objective == pytest.approx(first.objective, rel=1e-9)
    assert other.nuisance == pytest.approx(first.nuisance, rel=1e-7)
    first, other = (judged(p, f, (0, 1)) for p, f in zip(both, (first, other), strict=True))
    assert other.evidence == pytest.approx(first.evidence, rel=1e-9)
    assert other.fit.nuisance == pytest.approx(first.fit.nuisance, rel=1e-6)


def test_no_pair_is_cut():
    assert none_cut(np.array([1.0, 2.0, 2.0, 3.0]), 2) == 3
    assert none_cut(np.array([1.0, 2.0, 2.0, 3.0]), 1) == 1
    assert none_cut(np.array([1.0, 2.0, 2.0]), 2) == 3
    assert none_cut(np.zeros(0), 0) == 0
    p = mast(np.zeros(N))
    for modes in (5, p.modes):
        assert len(solve(p, np.zeros(2), (), modes)[0]) == modes + 1


def test_vectors_are_those_of_the_test():
    rng = np.random.default_rng(4)
    V, _ = np.linalg.qr(rng.normal(size=(7, 4)))
    values = np.array([1.0, 2.0, 2.0, 3.0])
    shape = V[:, 1] * 0.6 + V[:, 2] * 0.8
    cross = np.array([shape @ V, V[:, 3] @ V])
    out = turned_to_test(V, values, cross, np.array([2, 3]))
    assert out[:, 2] == pytest.approx(shape)
    assert out.T @ out == pytest.approx(np.eye(4), abs=1e-12)
    assert out[:, [0, 3]] == pytest.approx(V[:, [0, 3]])
    apart = values + np.array([0.0, 0.0, 10.0, 10.0]) * LIKELIHOOD.repeated
    assert turned_to_test(V, apart, cross, np.array([2, 3])) is V


@pytest.mark.parametrize(
    ("hz", "paired"),
    [
        ([76.0, 76.3, 104.0, 194.0, 194.0, 211.0, 212.0], True),
        ([76.0, 84.0, 104.0, 194.0, 220.0, 221.0], False),
        ([76.0], False),
    ],
)
def test_modes_of_round_structures_come_in_pairs(hz, paired):
    assert in_pairs(np.square(hz)) is paired
