"""Factorisation: solves, inertia, refactorisation, refusals; both backends alike."""

import contextlib
import ctypes
import gc

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.core.errors import CheckError, InputError
from trueup.core.numerics import factorisation as factor_module, pardiso
from trueup.core.numerics.factorisation import NotDefinite, best_backend, factorise, upper_triangle
from trueup.core.numerics.pardiso import library


def _in_a_gap(values, index):
    """A shift between two different neighbours, at or above `index`."""
    index += int(np.argmax(np.diff(values[index:]) > 1e-6))
    return 0.5 * (values[index] + values[index + 1])


@pytest.fixture
def indefinite():
    """Random, symmetric, badly scaled: rows differ by ten orders of magnitude."""
    rng = np.random.default_rng(7)
    a = sp.random(300, 300, 0.03, random_state=rng)
    scale = sp.diags(10.0 ** rng.uniform(-5, 5, 300))
    a = a + a.T + sp.diags(rng.choice([-3.0, 3.0], 300))
    return (scale @ a @ scale).tocsr()


def test_solves_one_and_many_right_hand_sides(membrane, backend):
    K, _, _ = membrane(20)
    f = factorise(K, True, backend)
    x = np.random.default_rng(0).standard_normal((400, 5))
    assert f.backend == backend
    np.testing.assert_allclose(f.solve(K @ x), x, rtol=1e-10)
    np.testing.assert_allclose(f.solve(K @ x[:, 0]), x[:, 0], rtol=1e-10)
    assert f.solve(np.zeros((400, 0))).shape == (400, 0)


@pytest.mark.parametrize("definite", [True, False])
def test_compliances_are_those_of_whole_solutions(membrane, backend, definite):
    K, _, _ = membrane(20)
    b = np.random.default_rng(1).standard_normal((400, 4))
    f = factorise(K, definite, backend)
    expected = np.einsum("ij,ij->j", b, np.linalg.solve(K.toarray(), b))
    loads = sp.csr_matrix(b.T)
    np.testing.assert_allclose(f.compliances(loads), expected, rtol=1e-10)
    assert f.compliances(loads[:0]).shape == (0,)


@pytest.mark.parametrize("shift", [False, True])
def test_compliances_of_many_loads_here_and_there_are_those_of_whole_solutions(
    membrane, backend, shift
):
    """Loads at one place, at neighbours, at places far apart; where signs of pivots differ, too."""
    K, M, exact = membrane(20)
    A = (K - shift * _in_a_gap(exact, 60) * M).tocsr()
    each = np.arange(400)
    apart = np.stack([np.roll(each, -k) for k in (0, 1, 57)])
    rows = np.tile(each, 3)
    loads = sp.csr_matrix((np.repeat([1.0, -2.0, 0.5], 400), (rows, apart.ravel())), (400, 400))
    loads = sp.vstack([sp.identity(400), loads, loads[:, ::-1], A]).tocsr()
    f = factorise(A, not shift, backend)
    expected = np.sum(loads.toarray() * np.linalg.solve(A.toarray(), loads.toarray().T).T, axis=1)
    np.testing.assert_allclose(f.compliances(loads), expected, rtol=1e-8, atol=1e-12)
    f.refactorise(2.0 * A)
    np.testing.assert_allclose(f.compliances(loads), expected / 2.0, rtol=1e-8, atol=1e-12)


def test_indefinite_solve(membrane, backend):
    K, _, exact = membrane(20)
    A = K - _in_a_gap(exact, 60) * sp.identity(400)
    x = np.random.default_rng(0).standard_normal((400, 3))
    np.testing.assert_allclose(factorise(A, False, backend).solve(A @ x), x, rtol=1e-8)


@pytest.mark.parametrize("index", [0, 3, 57, 200, 398])
def test_inertia_counts_eigenvalues_below_the_shift(membrane, backend, index):
    K, M, exact = membrane(20)
    shift = _in_a_gap(exact, index)
    below = np.count_nonzero(exact < shift)
    assert factorise(K - shift * M, False, backend).negative == below


def test_inertia_of_a_badly_scaled_matrix_is_that_of_dense_truth(indefinite):
    if best_backend() != "pardiso":
        pytest.skip("the optional mkl package is not installed")
    d = 1.0 / np.sqrt(abs(indefinite.diagonal()))
    truth = np.count_nonzero(np.linalg.eigvalsh(d[:, None] * indefinite.toarray() * d) < 0)
    assert factorise(indefinite, False, "pardiso").negative == truth


def test_without_pivoting_the_count_is_right_or_refused(indefinite):
    d = 1.0 / np.sqrt(abs(indefinite.diagonal()))
    truth = np.count_nonzero(np.linalg.eigvalsh(d[:, None] * indefinite.toarray() * d) < 0)
    with contextlib.suppress(CheckError):
        assert factorise(indefinite, False, "superlu").negative == truth


@pytest.mark.parametrize(("stiff", "told"), [(1e8, True), (1e10, True), (1e13, False)])
def test_pairs_of_masses_beside_stiff_springs_are_counted_while_rounding_allows(stiff, told):
    """Pairs that a stiff spring joins move as one mass of two in a chain of springs of one."""
    pairs = 300
    springs = np.tile([1.0, stiff], pairs)
    diagonal = springs + np.append(springs[1:], 0.0)
    chain = sp.diags([-springs[1:], diagonal, -springs[1:]], [-1, 0, 1], format="csr")
    odd = 2 * np.arange(1, pairs + 1) - 1
    values = 2.0 * np.sin(odd * np.pi / (2 * (2 * pairs + 1))) ** 2
    shift = (values[20] + values[21]) / 2.0
    factor = factorise(chain - shift * sp.identity(2 * pairs, format="csr"), False, "superlu")
    if told:
        assert factor.negative == 21
    else:
        with pytest.raises(CheckError, match="lost its accuracy"):
            _ = factor.negative


def test_superlu_refuses_a_count_it_cannot_vouch_for():
    tiny = sp.csr_matrix([[1e-30, 1.0, 0.0], [1.0, 1e-30, 1.0], [0.0, 1.0, 1e-30]])
    f = factor_module._SuperluFactorisation(tiny, False)
    f._full = f._full * 2.0  # a factor that does not belong to its matrix
    with pytest.raises(CheckError, match=r"accuracy|diagonal"):
        _ = f.negative


def test_refactorise_on_the_same_and_on_another_pattern(membrane, backend):
    K, M, exact = membrane(15)
    f = factorise(K, False, backend)
    b = np.ones(225)
    f.refactorise(K - 0.5 * (exact[4] + exact[6]) * M)
    expected = np.linalg.solve((K - 0.5 * (exact[4] + exact[6]) * M).toarray(), b)
    np.testing.assert_allclose(f.solve(b), expected, rtol=1e-8)
    other = (K + 0.1 * K @ K).tocsr()
    f.refactorise(other)
    np.testing.assert_allclose(f.solve(b), np.linalg.solve(other.toarray(), b), rtol=1e-8)
    assert f.negative == 0


def test_definite_or_not_is_found_out(membrane):
    if best_backend() != "pardiso":
        pytest.skip("the optional mkl package is not installed")
    K, M, exact = membrane(10)
    assert factorise(K).negative == 0
    shift = 0.5 * (exact[0] + exact[1])
    assert factorise(K - shift * M).negative == 1
    with pytest.raises(NotDefinite):
        factorise(K - shift * M, True)


def test_exactly_singular(backend):
    singular = sp.csr_matrix(np.diag([1.0, 0.0, 2.0]))
    with pytest.raises(NotDefinite):
        factorise(singular, True, backend)
    with pytest.raises(CheckError):
        _ = factorise(singular, False, backend).negative


def test_bad_input_is_refused_in_words():
    with pytest.raises(InputError, match="square"):
        factorise(sp.csr_matrix((3, 4)))
    with pytest.raises(InputError, match="not finite"):
        factorise(sp.csr_matrix(np.diag([1.0, np.nan])))
    with pytest.raises(InputError, match="unknown backend"):
        factorise(sp.identity(3), backend="umfpack")


def test_a_missing_mkl_falls_back_and_is_named_when_asked_for(monkeypatch):
    monkeypatch.setattr(factor_module, "library", lambda: None)
    monkeypatch.setattr(pardiso, "library", lambda: None)
    assert best_backend() == "superlu"
    assert factorise(sp.identity(3)).backend == "superlu"
    with pytest.raises(InputError, match="mkl package is not installed"):
        factorise(sp.identity(3), backend="pardiso")


def test_upper_triangle_stores_every_diagonal_entry():
    a = sp.csr_matrix(np.array([[0.0, 2.0, 0.0], [2.0, 5.0, 0.0], [0.0, 0.0, 0.0]]))
    u = upper_triangle(a)
    assert u.nnz == 4
    assert (u.toarray() == np.triu(a.toarray())).all()


def test_memory_is_given_back(membrane):
    if best_backend() != "pardiso":
        pytest.skip("the optional mkl package is not installed")
    mkl = ctypes.CDLL(library()._name)  # its own: the program's stays as it is
    mkl.MKL_Mem_Stat.restype = ctypes.c_int64

    def in_use():
        return mkl.MKL_Mem_Stat(ctypes.byref(ctypes.c_int()))

    K = membrane(40)[0]
    f = factorise(K, True, "pardiso")
    f.solve(np.ones(1600))
    del f
    gc.collect()
    before = in_use()
    f = factorise(K, False, "pardiso")
    held = in_use()
    del f
    gc.collect()
    assert held > before + 100_000
    assert in_use() - before < 0.1 * (held - before)  # MKL keeps small buffers of its threads


@pytest.mark.parametrize("backend", ["pardiso", "superlu"])
def test_a_factor_serves_other_values_on_its_pattern(membrane, backend):
    if backend == "pardiso" and library() is None:
        pytest.skip("PARDISO is not installed")
    K, M, values = membrane(12)
    below = [_in_a_gap(values, k) for k in (5, 20)]
    factor = factorise(K - below[0] * M, definite=False, backend=backend)
    A = (K - below[1] * M).tocsr()
    factor.refactorise(A)
    assert factor.negative == np.count_nonzero(values < below[1])
    b = np.random.default_rng(3).standard_normal((A.shape[0], 2))
    np.testing.assert_allclose(A @ factor.solve(b), b, atol=1e-8)
