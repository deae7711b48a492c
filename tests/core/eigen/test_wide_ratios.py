"""Masses and stiffnesses that differ by up to twelve decades: closed forms, one answer for all."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.optimize import brentq
from tests.core.chains import chain, scalar_model

from trueup.core.data.parametric_model import Term
from trueup.core.eigen import pencil
from trueup.core.eigen.normal_modes import solve
from trueup.core.errors import CheckError, InputError
from trueup.core.numerics.factorisation import best_backend

RATIOS = [1e-12, 1e-8, 1e-4, 1.0, 1e4, 1e8, 1e12]


def two_masses(k, m):
    """Ground - k[0] - m[0] - k[1] - m[1], and its eigenvalues, each to the last digits."""
    a, b, c = (k[0] + k[1]) / m[0], k[1] / m[1], k[0] * k[1] / (m[0] * m[1])
    half = (a + b) / 2.0
    high = half + np.sqrt(((a - b) / 2.0) ** 2 + k[1] ** 2 / (m[0] * m[1]))
    K = sp.csr_matrix([[k[0] + k[1], -k[1]], [-k[1], k[1]]])
    return K, sp.diags(m).tocsr(), np.array([c / high, high])


@pytest.mark.parametrize("stiffness", RATIOS)
@pytest.mark.parametrize("mass", RATIOS)
def test_two_masses(stiffness, mass):
    K, M, exact = two_masses((1.0, stiffness), (1.0, mass))
    found = solve(scalar_model(K, M), 2)
    # K itself holds the softer spring to the last digit of the stiffer one only
    held = 1e-10 + 1e-14 * max(stiffness, 1.0)
    np.testing.assert_allclose(found.eigenvalues, exact, rtol=held)
    assert found.rigid_body_modes == 0


@pytest.mark.parametrize("mass", RATIOS)
@pytest.mark.parametrize("n", [30, 900])
def test_chain_on_a_base_of_any_mass(n, mass, backend):
    """Displacements cos((n - j - 1/2) theta), lambda = 4 sin^2(theta / 2); the base gives theta."""
    K, M = chain(n)
    M = M.tolil()
    M[0, 0] = mass

    def base(theta):
        return np.sin((n - 1) * theta) + 2.0 * mass * np.sin(theta / 2) * np.cos((n - 0.5) * theta)

    grid = np.linspace(0.01, 8.0, 3000) * np.pi / n
    turns = np.flatnonzero(np.diff(np.sign(base(grid))))[:5]
    theta = np.array([brentq(base, grid[k], grid[k + 1], xtol=1e-16, rtol=1e-14) for k in turns])
    found = solve(scalar_model(K, M.tocsr()), 6, backend=backend)
    np.testing.assert_allclose(found.eigenvalues[1:], 4.0 * np.sin(theta / 2) ** 2, rtol=1e-8)
    assert found.rigid_body_modes == 1


def test_a_free_beam_on_a_large_mass_is_a_clamped_one(line, section):
    free, clamped = line(30), line(30, fixed=[(0, c) for c in range(1, 7)])
    M = free.M().tolil()
    for row in range(6):
        M[row, row] += 1e12 * free.M().diagonal()[:3].max()
    found = solve(replace(free, mass=(Term(M.tocsr()),)), 12)
    exact = solve(clamped, 6)
    assert found.rigid_body_modes == 6
    np.testing.assert_allclose(found.eigenvalues[6:], exact.eigenvalues, rtol=1e-7)


@pytest.mark.parametrize("ratio", [1e6, 1e9])
def test_a_free_beam_on_a_large_mass_without_inertia_is_a_pinned_one(line, ratio):
    free, pinned = line(30), line(30, fixed=[(0, c) for c in (1, 2, 3)])
    M = free.M().tolil()
    for row in range(3):
        M[row, row] += ratio * free.M().diagonal()[:3].max()
    found = solve(replace(free, mass=(Term(M.tocsr()),)), 12)
    exact = solve(pinned, 9)
    assert (found.rigid_body_modes, exact.rigid_body_modes) == (6, 3)
    np.testing.assert_allclose(found.eigenvalues[6:], exact.eigenvalues[3:], rtol=100.0 / ratio)


def test_masses_that_get_lost_are_noticed(monkeypatch):
    """The check by the matrices as they were given sees what was done to them."""
    K, M = chain(30)
    M = M.tolil()
    M[0, 0] = 1e9

    def lossy(K, M, nodes):
        return sp.diags(np.where(M.diagonal() < 1e-3 * M.diagonal().max(), 0.5, 1.0)) @ M

    monkeypatch.setattr(pencil, "_without_rounding", lossy)
    with pytest.raises(CheckError, match="orthonormal"):
        solve(scalar_model(K, M.tocsr()), 6)


@pytest.mark.parametrize("stiff", [1e9, 1e12, 1e15])
@pytest.mark.parametrize("soft", [1.0, 1e-2])
@pytest.mark.parametrize("n", [5, 9])
def test_two_frames_joined_by_stiff_springs_on_soft_ones(frame, section, backend, n, stiff, soft):
    """They move up and down as one rigid body: omega^2 = 4 k / m."""
    found, model = _suspended(frame, section, n, stiff, soft, backend)
    up = np.zeros(model.n_free)
    up[2::6] = 1.0
    exact = 4.0 * soft / (up @ (model.M() @ up))
    assert found.rigid_body_modes == 0
    assert np.abs(found.eigenvalues[:6] / exact - 1.0).min() < 1e-5
    assert not found.warnings


@pytest.mark.parametrize("modulus", [0.5, 0.9, 1.0, 1.1, 2.0])
def test_a_suspension_far_below_the_rounding_has_one_answer(frame, section, modulus):
    """Its stiffness is 1e-17 of what moves with it, whatever the structure and the solver."""
    own = replace(section, E=modulus * section.E)
    usual = _suspended(frame, own, 9, 1e9, 1e-2, "superlu")[0].eigenvalues[:6]
    for backend in ("superlu", best_backend()):
        found = _suspended(frame, own, 9, 1e14, 1e-2, backend)[0]
        np.testing.assert_allclose(found.eigenvalues[:6], usual, rtol=1e-3)


def _suspended(frame, section, n, stiff, soft, backend):
    """Two square frames, one upon the other, joined inside, the corners of one on springs."""
    xyz = np.array([[i, j, 0.0] for j in range(n) for i in range(n)]) / n
    bars = [(i + n * j, i + 1 + n * j) for j in range(n) for i in range(n - 1)]
    bars += [(i + n * j, i + n * (j + 1)) for j in range(n - 1) for i in range(n)]
    bars += [(a + n * n, b + n * n) for a, b in bars]
    corners = (0, n - 1, n * (n - 1), n * n - 1)
    springs = [(c, d, soft) for c in corners for d in (1, 2, 3)]
    model = frame(np.vstack([xyz, xyz]), bars, section, springs=springs)
    inside = ((xyz > 0.0) & (xyz < xyz.max()))[:, :2].all(axis=1)
    at_each = sp.kron(sp.diags(stiff * inside), sp.identity(6))
    joint = sp.kron([[1.0, -1.0], [-1.0, 1.0]], at_each)
    model = replace(model, stiffness=(*model.stiffness, Term(joint.tocsr())))
    return solve(model, 10, backend=backend), model


@pytest.mark.parametrize("soft", [1e-2, 1.0, 1e6])
@pytest.mark.parametrize("stiff", [0.0, 1e9, 1e12])
def test_a_flap_on_a_soft_suspension_is_a_mechanism_and_the_suspension_is_none(frame, stiff, soft):
    xyz = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [2, 0, 0], [2, 1, 0]], float)
    bars = [(0, 1), (0, 2), (1, 2), (1, 3), (2, 4), (3, 4)]
    pins = [(3, 4), (3, 5), (3, 6), (4, 4), (4, 5), (4, 6)]
    springs = [(g, c, soft) for g in range(3) for c in (1, 2, 3)]

    def solved(**more):
        model = frame(xyz, bars, springs=springs, **more)
        between = sp.csr_matrix([[stiff, -stiff], [-stiff, stiff]])
        take = sp.csr_matrix((np.ones(2), ([0, 1], [0, 6])), (2, model.n_free))  # 1:1 and 2:1
        joint = Term((take.T @ between @ take).tocsr())
        return solve(replace(model, stiffness=(*model.stiffness, joint)), 8)

    assert solved().rigid_body_modes == 0
    with pytest.raises(InputError, match="mechanism") as caught:
        solved(pins=pins)
    named = str(caught.value).split(" at ")[1].split(";")[0]
    assert "4:3" in named
    assert "5:3" in named
    assert not any(label in named for label in ("1:3", "2:3", "3:3"))


def test_what_lapack_gives_up_on_is_said(monkeypatch):
    def lost(*_):
        raise np.linalg.LinAlgError("6-th leading minor not positive definite")

    monkeypatch.setattr("trueup.core.eigen.normal_modes.dense_modes", lost)
    K, M, _ = two_masses([1.0, 1e60], [1.0, 1.0])
    with pytest.raises(CheckError, match=r"differ by too many decades \(6-th"):
        solve((K, M), 1)


def test_ratios_beyond_the_numbers_of_the_machine_are_said():
    with pytest.raises(CheckError, match="more decades than numbers have"):
        solve((sp.diags([1.0, 1e200]).tocsr(), sp.diags([1.0, 1e-200]).tocsr()), 1)
