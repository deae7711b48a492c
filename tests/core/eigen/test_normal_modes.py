"""Normal modes: closed forms, how many and up to where, bad input and checks that bite."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from tests.core.chains import chain, chain_exact, scalar_model

from trueup.core.data.parametric_model import Model, Term
from trueup.core.eigen import normal_modes, shift_invert_solver
from trueup.core.eigen.eigen_numbers import EIGEN
from trueup.core.eigen.normal_modes import modes_of, solve
from trueup.core.errors import CheckError, InputError

# closed forms


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
@pytest.mark.parametrize("n", [5, 300, 2000])
def test_free_chain(n, scale, backend):
    found = solve(chain(n, k=scale), min(n, 12), backend=backend)
    exact = chain_exact(n, k=scale)[: min(n, 12)]
    np.testing.assert_allclose(found.eigenvalues[1:], exact[1:], rtol=1e-9)
    assert abs(found.eigenvalues[0]) < 1e-10 * exact[1]
    assert found.rigid_body_modes == 1
    assert found.checks.missed == 0
    assert found.checks.orthonormality < 1e-10


@pytest.mark.parametrize("n", [20, 40])
def test_square_membrane_has_every_repeated_mode(membrane, backend, n):
    K, M, exact = membrane(n, tension=3.0, mass=0.1)
    for wanted in (1, 2, 3, 10, 37):
        found = solve((K, M), wanted, backend=backend)
        np.testing.assert_allclose(found.eigenvalues, exact[:wanted], rtol=1e-10)
        assert found.rigid_body_modes == 0


@pytest.mark.parametrize("copies", [12, 40])
def test_more_equal_modes_than_the_block_is_wide(backend, copies):
    """Identical oscillators side by side; the end of the list may cut their cluster."""
    K, M = chain(60, ground=1e-3)
    exact = np.repeat(1e-3 + chain_exact(60), copies)
    many = sp.block_diag([K] * copies).tocsr(), sp.block_diag([M] * copies).tocsr()
    for wanted in (copies - 3, 2 * copies):
        found = solve(many, wanted, backend=backend)
        np.testing.assert_allclose(found.eigenvalues, exact[:wanted], rtol=1e-9)


def test_all_modes_of_a_small_model(membrane):
    K, M, exact = membrane(12)
    found = solve((K, M), 144)
    np.testing.assert_allclose(found.eigenvalues, exact, rtol=1e-12)
    assert found.backend == "lapack"


def test_cantilever_in_two_planes(line, section):
    s, L = section, 1.0
    model = line(40, L, fixed=[(0, c) for c in range(1, 7)])
    roots = np.repeat([1.8751040687, 4.6940911330, 7.8547574382, 10.995540735], 2)
    exact = roots**2 * np.sqrt(s.E * s.I2 / (s.rho * s.A * L**4)) / (2.0 * np.pi)
    found = solve(model, 8)
    np.testing.assert_allclose(found.frequencies_hz, exact, rtol=1e-5)
    assert found.rigid_body_modes == 0


@pytest.mark.parametrize("bars", [20, 150])
def test_free_beam_has_six_rigid_body_modes_then_pairs(line, section, bars, backend):
    s, L = section, 1.0
    found = solve(line(bars, L), 12, backend=backend)
    roots = np.repeat([4.7300407449, 7.8532046241, 10.995607838], 2)
    exact = roots**2 * np.sqrt(s.E * s.I2 / (s.rho * s.A * L**4)) / (2.0 * np.pi)
    assert found.rigid_body_modes == 6
    np.testing.assert_allclose(found.frequencies_hz[6:], exact, rtol=2e-4)
    assert found.frequencies_hz[5] < 1e-3 * found.frequencies_hz[6]


def test_ring_pairs(ring, section, backend):
    """In-plane bending of a thin ring, Hoppe 1871: n^2 (n^2 - 1)^2 / (n^2 + 1)."""
    s, R = section, 0.5
    found = solve(ring(180, R), 24, backend=backend)
    n = np.array([2.0, 3.0, 4.0])
    exact = np.sqrt(s.E * s.I2 / (s.rho * s.A * R**4) * n**2 * (n**2 - 1) ** 2 / (n**2 + 1))
    exact = exact / (2.0 * np.pi)
    assert found.rigid_body_modes == 6
    for f in exact:
        assert np.count_nonzero(abs(found.frequencies_hz / f - 1.0) < 5e-3) == 2


# how many, up to where


def test_up_to_a_frequency(membrane, backend):
    K, M, exact = membrane(30)
    fmax = np.sqrt(0.5 * (exact[20] + exact[21 + int(np.argmax(exact[21:] > exact[20] + 1e-9))]))
    fmax /= 2.0 * np.pi
    inside = np.count_nonzero(exact <= (2.0 * np.pi * fmax) ** 2)
    assert len(solve((K, M), fmax=fmax, backend=backend).eigenvalues) == inside
    assert len(solve((K, M), 5, fmax=fmax, backend=backend).eigenvalues) == 5
    assert len(solve((K, M), fmax=1e-3 * fmax, backend=backend).eigenvalues) == 0


def test_default_is_ten(membrane):
    K, M, _ = membrane(10)
    assert len(solve((K, M)).eigenvalues) == 10


@pytest.mark.parametrize("n", [100, 900])
def test_fewer_masses_than_modes_asked_for(n, backend):
    K, _ = chain(n, ground=1e-4)
    M = sp.csr_matrix((np.ones(4), ([3, 20, 50, 90],) * 2), (n, n))
    found = solve(scalar_model(K, M), 10, backend=backend)
    d = np.linalg.inv(K.toarray())[np.ix_([3, 20, 50, 90], [3, 20, 50, 90])]
    np.testing.assert_allclose(found.eigenvalues, 1.0 / np.linalg.eigvalsh(d)[::-1], rtol=1e-8)
    assert "allows only 4" in found.warnings[0]


@pytest.mark.parametrize("bars", [30, 130])
def test_rotations_without_mass(line, backend, bars):
    fixed = [(0, c) for c in range(1, 7)]
    model = line(bars, lumped=True, fixed=fixed)
    found = solve(model, 6, backend=backend)
    K, M = model.K().toarray(), model.M().toarray()
    massed = np.flatnonzero(M.diagonal())
    compliance = np.linalg.inv(K)[np.ix_(massed, massed)] * M.diagonal()[massed]
    exact = np.sort(1.0 / np.linalg.eigvals(compliance).real)[:6]
    np.testing.assert_allclose(found.eigenvalues, exact, rtol=1e-6)


def test_both_ends_of_a_wide_spectrum_are_accurate():
    """Springs over twelve decades: LAPACK's one-sided error would spoil one end."""
    k = 10.0 ** np.linspace(-4, 8, 13)
    K, M = sp.diags(k).tocsr(), sp.identity(13, format="csr")
    Q = np.linalg.qr(np.random.default_rng(0).standard_normal((13, 13)))[0]
    found = solve((K, M), 13)
    np.testing.assert_allclose(found.eigenvalues, k, rtol=1e-9)
    assert Q.shape == (13, 13)


# bad input, and checks that bite


def test_bad_input_is_refused_in_words(membrane):
    K, M, _ = membrane(5)
    for bad, words in (
        ((K, sp.csr_matrix(M.shape)), "no mass"),
        ((K, -M), "negative"),
        ((K * np.nan, M), "not finite"),
        ((-K, M), "not positive semi-definite|negative"),
        ((sp.csr_matrix(np.triu(K.toarray())), M), "not symmetric"),
        ((K[:20], M), "shape"),
    ):
        with pytest.raises(InputError, match=words):
            solve(bad)
    with pytest.raises(InputError, match="at least one"):
        solve((K, M), 0)
    with pytest.raises(InputError, match="above 0"):
        solve((K, M), fmax=-1.0)
    with pytest.raises(InputError, match="nothing can move"):
        solve((sp.csr_matrix((0, 0)), sp.csr_matrix((0, 0))))


def test_degree_of_freedom_with_nothing_is_named(ring):
    model = ring(12)
    out = sp.identity(72).tolil()
    out[14, 14] = 0.0
    bare = Model(
        model.geometry, model.dofs, model.expansion,
        (Term((out @ model.K() @ out).tocsr()),), (Term((out @ model.M() @ out).tocsr()),),
        (), model.free_labels,
    )  # fmt: skip
    with pytest.raises(InputError, match="3:3 has neither stiffness nor mass"):
        solve(bare)


@pytest.mark.parametrize("n", [50, 900])
def test_negative_spring(n, backend):
    K, M = chain(n, ground=1e-3)
    K = K + sp.csr_matrix(([-50.0], ([17], [17])), K.shape)
    with pytest.raises(InputError, match="negative"):
        solve(scalar_model(K, M), 4, backend=backend)


@pytest.mark.parametrize("n", [50, 900])
def test_mass_that_is_indefinite_off_the_diagonal(n, backend):
    K, M = chain(n, ground=1e-3)
    M = M + sp.csr_matrix(([3.0, 3.0], ([4, 5], [5, 4])), M.shape)
    with pytest.raises(InputError, match="mass matrix is not positive semi-definite"):
        solve(scalar_model(K, M), 4, backend=backend)


def test_a_missed_mode_is_found_again(membrane, monkeypatch):
    """An iteration that hides one mode: the count notices and a second search brings it."""
    K, M, exact = membrane(30)
    honest = shift_invert_solver._converged
    calls = []

    def forgetful(*args):
        found = honest(*args)
        calls.append(1)
        if len(calls) > 1:
            return found
        keep = np.arange(len(found.values)) != 4
        return shift_invert_solver.replace(
            found,
            values=found.values[keep],
            vectors=found.vectors[:, keep],
            residual=found.residual[keep],
        )

    monkeypatch.setattr(shift_invert_solver, "_converged", forgetful)
    found = solve((K, M), 12)
    np.testing.assert_allclose(found.eigenvalues, exact[:12], rtol=1e-9)
    assert found.checks.missed == 0
    assert len(calls) == 2


def test_a_mode_that_stays_missing_is_an_error(membrane, monkeypatch):
    K, M, _ = membrane(30)
    honest = shift_invert_solver._inertia

    def miscounted(*of):
        count, factor = honest(*of)
        return count + 1, factor

    monkeypatch.setattr(shift_invert_solver, "_inertia", miscounted)
    with pytest.raises(CheckError, match="inertia count"):
        solve((K, M), 12)


@pytest.mark.parametrize(
    "bad",
    [
        {"residual": 1e-3}, {"residual": np.nan}, {"orthonormality": 1e-3}, {"missed": 1},
        {"backward_error": 1e-3}, {"backward_error": np.nan}, {"rayleigh": 1e-3},
    ],
)  # fmt: skip
def test_checks_that_are_not_met_raise(bad):
    good = dict.fromkeys(["residual", "orthonormality", "backward_error", "rayleigh"], 0.0)
    assert normal_modes.Checks(**good, missed=0).missed == 0
    with pytest.raises(CheckError):
        normal_modes.Checks(**{**good, "missed": 0, **bad})


@pytest.mark.parametrize("hertz", [1e-9, 1e-3, 1.0, 1e4, 1e9])
def test_any_first_shift_leads_to_the_modes(ring, monkeypatch, hertz):
    monkeypatch.setattr(shift_invert_solver, "EIGEN", replace(EIGEN, first_shift=hertz))
    model = ring(150)
    expected = solve(ring(150), 16).eigenvalues[6:]
    np.testing.assert_allclose(solve(model, 16).eigenvalues[6:], expected, rtol=1e-7)


def test_units_do_not_matter(frame, section):
    """Metres and kilograms, or millimetres and tonnes: the same hertz."""
    from dataclasses import replace

    a = 2.0 * np.pi * np.arange(120) / 120
    xyz = np.column_stack([np.cos(a), np.sin(a), 0.1 * np.sin(3 * a)])
    bars = [(i, (i + 1) % 120) for i in range(120)]
    s = section
    mm = replace(s, E=s.E * 1e-6, rho=s.rho * 1e-12, A=s.A * 1e6, I2=s.I2 * 1e12, J=s.J * 1e12)
    metres = solve(frame(xyz, bars, s), 20)
    millimetres = solve(frame(1e3 * xyz, bars, mm), 20)
    np.testing.assert_allclose(metres.frequencies_hz[6:], millimetres.frequencies_hz[6:], rtol=1e-8)
    assert metres.rigid_body_modes == millimetres.rigid_body_modes == 6


def test_modes_are_expanded_with_unit_modal_mass(ring):
    model = ring(24, fixed=[(0, c) for c in range(1, 7)])
    found = solve(model, 5)
    modes = modes_of(model, found)
    assert modes.shapes.shape == (144, 5)
    assert (modes.shapes[:6] == 0.0).all()
    assert (modes.generalized_mass == 1.0).all()
    np.testing.assert_allclose(modes.frequencies_hz, found.frequencies_hz)


def test_solution_is_read_only_and_repeatable(ring):
    model = ring(150)
    one, two = solve(model, 12), solve(model, 12)
    assert (one.vectors == two.vectors).all()
    with pytest.raises(ValueError, match="read-only"):
        one.vectors[0, 0] = 1.0


def test_the_factor_is_kept_on_request(ring, backend):
    model = ring(150)
    found = solve(model, 8, backend=backend, keep_factor=True)
    A = model.K() - found.sigma * model.M()
    b = np.ones(model.n_free)
    np.testing.assert_allclose(A @ found.factor.solve(b), b, atol=1e-5)
    assert solve(model, 8, backend=backend).factor is None


def test_too_many_modes_below_a_frequency_are_bounded_and_counted(membrane, backend):
    """A frequency typed in kHz as Hz must not ask for thousands."""
    K, M, exact = membrane(50)
    found = solve((K, M), fmax=np.sqrt(exact[700]) * 1.0001 / (2.0 * np.pi), backend=backend)
    inside = np.count_nonzero(exact <= exact[700] * 1.0002)
    assert len(found.eigenvalues) == EIGEN.most < inside
    np.testing.assert_allclose(found.eigenvalues, exact[: EIGEN.most], rtol=1e-9)
    assert any(f"{inside} modes lie below" in w for w in found.warnings)
