"""Modes from what is nearly known of them: the same, none missed, none taken on trust."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as sl
import scipy.sparse as sp

from trueup.core.eigen import shift_invert_solver, warm_modes
from trueup.core.eigen.eigen_numbers import EIGEN
from trueup.core.eigen.normal_modes import solve
from trueup.core.eigen.warm_modes import Near
from trueup.core.numerics import pardiso
from trueup.core.numerics.pardiso import library

N_MODES = 12


@pytest.fixture
def plate(membrane):
    """K and M of a plate of 900 points, nearly square so that modes come in near pairs."""
    K, M, *_ = membrane(30)
    return K, M @ sp.diags(1.0 + 0.01 * np.arange(M.shape[0]) / M.shape[0])


def known(matrices, noise, seed=0):
    """What would be known of the modes: their shapes and some above, mixed with eight more."""
    found = solve(matrices, N_MODES + 12)
    rng = np.random.default_rng(seed)
    mixed = found.vectors @ (
        np.eye(N_MODES + 12) + noise * rng.standard_normal((N_MODES + 12,) * 2)
    )
    K, M = (mixed.T @ (matrix @ mixed) for matrix in matrices)
    few, above = slice(N_MODES + 4), slice(N_MODES + 4, None)
    values, C = sl.eigh(K[few, few], M[few, few])
    rough = K.diagonal()[above] / M.diagonal()[above]
    return found, Near(np.append(values, np.sort(rough)), mixed[:, few] @ C)


@pytest.fixture
def cold(monkeypatch):
    """How often a search from nothing was begun."""
    begun = []
    started = shift_invert_solver._started

    def counted(*words):
        begun.append(1)
        return started(*words)

    monkeypatch.setattr(shift_invert_solver, "_started", counted)
    return begun


@pytest.mark.parametrize("backend", ["superlu", None])
def test_the_modes_are_those_of_a_search_from_nothing(plate, cold, backend):
    truth, near = known(plate, 0.01)
    begun = len(cold)
    found = solve(plate, N_MODES, near=near, backend=backend)
    assert len(cold) == begun
    np.testing.assert_allclose(found.eigenvalues, truth.eigenvalues[:N_MODES], rtol=1e-6)
    overlap = found.vectors.T @ (plate[1] @ truth.vectors[:, :N_MODES])
    np.testing.assert_allclose(np.linalg.norm(overlap, axis=0), 1.0, atol=1e-5)
    error = np.abs(found.eigenvalues / truth.eigenvalues[:N_MODES] - 1.0).max()
    assert error < 2.0 * found.checks.residual + 1e-12  # of λ - σ, σ is half of the first λ
    assert found.checks.missed == 0


def test_a_mode_that_nobody_knew_is_there(plate):
    truth, near = known(plate, 0.01)
    lost = Near(np.delete(near.values, [3, 4]), np.delete(near.vectors, [3, 4], axis=1))
    found = solve(plate, N_MODES, near=lost)
    np.testing.assert_allclose(found.eigenvalues, truth.eigenvalues[:N_MODES], rtol=1e-6)


def test_without_random_vectors_a_lost_mode_is_counted_and_searched_for(plate, cold, monkeypatch):
    monkeypatch.setattr(warm_modes, "EIGEN", replace(EIGEN, guard=0))
    truth, near = known(plate, 0.0)
    lost = Near(np.delete(near.values, 3), np.delete(near.vectors, 3, axis=1))
    begun = len(cold)
    found = solve(plate, N_MODES, near=lost)
    assert len(cold) > begun
    np.testing.assert_allclose(found.eigenvalues, truth.eigenvalues[:N_MODES], rtol=1e-9)


def test_what_is_not_near_is_no_harm(plate, cold):
    truth, near = known(plate, 0.0)
    noise = np.random.default_rng(1).standard_normal(near.vectors.shape)
    values, C = sl.eigh(*(noise.T @ (matrix @ noise) for matrix in plate))
    begun = len(cold)
    found = solve(plate, N_MODES, near=Near(values, noise @ C))
    assert len(cold) > begun
    np.testing.assert_allclose(found.eigenvalues, truth.eigenvalues[:N_MODES], rtol=1e-9)


def test_what_one_solution_keeps_serves_the_next_at_other_values(line, backend):
    halves = [("E", range(60)), ("E", range(60, 120))]
    model = line(120, parameters=halves)  # equal moduli make zeros of stiffnesses in the middle
    first = solve(model, N_MODES, keep_counter=True, backend=backend)
    p = np.array([1.1, 1.3])
    truth = solve(model, N_MODES + 12, p=p, backend=backend)
    near = Near(truth.eigenvalues[6:], truth.vectors[:, 6 : N_MODES + 4])
    alone, after = (
        solve(model, N_MODES, p=p, near=replace(near, kept=kept), backend=backend)
        for kept in (None, first.kept)
    )
    assert after.count_factor is first.kept.counter
    assert after.rigid_body_modes == 6
    np.testing.assert_allclose(after.eigenvalues[6:], truth.eigenvalues[6:N_MODES], rtol=1e-6)
    np.testing.assert_allclose(after.eigenvalues[6:], alone.eigenvalues[6:], rtol=1e-8)


def test_what_is_kept_is_analysed_once(line, monkeypatch):
    if library() is None:
        pytest.skip("PARDISO is not installed")
    model = line(120, parameters=[("E", range(60)), ("E", range(60, 120))])
    first = solve(model, N_MODES, keep_counter=True, backend="pardiso")
    p = np.array([1.1, 1.3])
    truth = solve(model, N_MODES + 12, p=p)
    near = Near(truth.eigenvalues[6:], truth.vectors[:, 6 : N_MODES + 4], first.kept)
    made = []
    honest = pardiso.Pardiso._run
    monkeypatch.setattr(
        pardiso.Pardiso,
        "_run",
        lambda self, phase, *b: made.append(phase) or honest(self, phase, *b),
    )
    solve(model, N_MODES, p=p, near=near, backend="pardiso")
    assert pardiso._ANALYSE not in made
    assert made.count(pardiso._FACTORISE) == 1
