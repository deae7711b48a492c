"""Sparse symmetric factorisation by the best direct solver present.

MKL PARDISO where the optional ``mkl`` wheel is installed, else scipy's SuperLU without pivoting
on a fill-reducing order of the nodes. Which one is used is an argument, never a global setting.
"""

import warnings
from collections.abc import Callable
from typing import Any, Literal, Protocol

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from ..arrays import Floats, Ints, Numbers, require_finite
from ..errors import CheckError, InputError
from .fill_reducing_ordering import nodal_order
from .pardiso import NotDefinite, Pardiso, library
from .selected_inverse import selected_inverse

Backend = Literal["pardiso", "superlu"]

__all__ = ["Backend", "Factorisation", "NotDefinite", "best_backend", "factorise"]

_PROBE_ERROR = 1e-2
"""Largest ||E A^-1|| by a probe, A + E what was factorised, at which its signs are believed.

Below one they are those of A. The probe tells the Frobenius norm within its draw, hence the room.
"""
_AT_ONCE = 128
"""Loads whose compliances are found at once: memory."""
_WORTH = 32
"""Unknowns a load, of all that were asked for, up to which the inverse on the pattern takes less
time than solutions do."""


class Factorisation(Protocol):
    """A factorised symmetric matrix."""

    backend: Backend
    n: int

    @property
    def negative(self) -> int:
        """Number of negative pivots: by Sylvester's law the number of negative eigenvalues.

        Raises
        ------
        CheckError
            Some pivots vanished, so that the count cannot be trusted.
        """
        ...

    def solve(self, b: Numbers) -> Floats:
        """Return x of A x = b, for b of shape (n,) or (n, n_rhs); same shape, Fortran order."""
        ...

    def compliances(self, loads: sp.csr_matrix) -> Floats:
        """Return lᵀ A⁻¹ l of each row l of `loads` (n_load, n), (n_load,).

        With Cholesky's factor this takes half a solution; by SuperLU's the inverse on the pattern
        of A takes less than the solutions for many.
        """
        ...

    def refactorise(self, a: sp.spmatrix) -> None:
        """Replace the factor, in place, by that of another matrix of the same type.

        Where the stored pattern is the same the ordering and symbolic analysis are reused.
        """
        ...


def best_backend() -> Backend:
    """Return the fastest backend that is installed."""
    return "pardiso" if library() is not None else "superlu"


def factorise(
    a: sp.spmatrix,
    definite: bool | None = None,
    backend: Backend | None = None,
    groups: Ints | None = None,
) -> Factorisation:
    """Factorise a sparse symmetric matrix.

    Parameters
    ----------
    a : (n, n) sparse
        Only the upper triangle is read. Explicit zeros are kept, so that matrices of one fixed
        pattern can share the analysis.
    definite : bool, optional
        True: positive definite (Cholesky). False: indefinite. Default: Cholesky if that
        succeeds, else indefinite.
    backend : {"pardiso", "superlu"}, optional
        Default: `best_backend`.
    groups : (n,) int, optional
        Node of each row, which helps SuperLU to a better order; PARDISO finds its own.

    Returns
    -------
    Factorisation

    Raises
    ------
    InputError
        The matrix is not square or not finite, or there is not enough memory.
    NotDefinite
        `definite` is True and the matrix is not positive definite. (SuperLU notices only an
        exactly singular one; `Factorisation.negative` tells.)
    CheckError
        An indefinite matrix is exactly singular.

    Notes
    -----
    The matrix is first scaled symmetrically to a unit diagonal by powers of two, which is exact
    and leaves the inertia as it is, so that pivots of dofs with small stiffness (rotations in
    millimetre models, drilling) are not taken for zeros.
    """
    if a.ndim != 2 or a.shape[0] != a.shape[1]:
        raise InputError(f"only a square matrix can be factorised, this one has shape {a.shape}")
    chosen = backend or best_backend()
    makers: dict[str, Callable[[sp.spmatrix, bool], Factorisation]] = {
        "pardiso": _PardisoFactorisation,
        "superlu": lambda m, d: _SuperluFactorisation(m, d, groups),
    }
    make = makers.get(chosen)
    if make is None:
        raise InputError(f"unknown backend {chosen!r}: use 'pardiso' or 'superlu'")
    if definite is None:
        try:
            return make(a, True)
        except NotDefinite:
            return make(a, False)
    return make(a, definite)


class _PardisoFactorisation:
    backend: Backend = "pardiso"

    def __init__(self, a: sp.spmatrix, definite: bool) -> None:
        self.n = int(a.shape[0])
        self._definite = definite
        self._factorise(upper_triangle(a))

    def _factorise(self, upper: sp.csr_matrix) -> None:
        self._scale = _scale(upper)
        self._pattern = (upper.indptr, upper.indices)
        self._pardiso = Pardiso(_scaled(upper, self._scale), self._definite)

    def refactorise(self, a: sp.spmatrix) -> None:
        upper = upper_triangle(a)
        if _same(self._pattern, upper):
            self._scale = _scale(upper)
            self._pardiso.refactorise(_scaled(upper, self._scale).data)
        else:
            self._factorise(upper)

    def solve(self, b: Numbers) -> Floats:
        d = self._scale[:, None]
        columns = np.asarray(b, np.float64).reshape(self.n, -1)
        x = self._pardiso.solve(np.multiply(columns, d, order="F"))
        x *= d
        return x.reshape(np.shape(b), order="F")

    def compliances(self, loads: sp.csr_matrix) -> Floats:
        return _by_parts(self._each if self._definite else _by_solving(self.solve), loads)

    def _each(self, b: Floats) -> Floats:
        x = self._pardiso.half_solve(b * self._scale[:, None])
        return np.asarray(np.einsum("ij,ij->j", x, x))

    @property
    def negative(self) -> int:
        if self._definite:
            return 0
        if self._pardiso.perturbed:
            raise CheckError(f"{self._pardiso.perturbed} pivots vanished: no count of signs")
        return self._pardiso.negative


class _SuperluFactorisation:
    backend: Backend = "superlu"

    def __init__(self, a: sp.spmatrix, definite: bool, groups: Ints | None = None) -> None:
        self.n = int(a.shape[0])
        self._definite = definite
        self._groups = groups
        self._lu: Any = None
        self._full: Any = None
        self._pattern: tuple[Ints, Ints] | None = None
        self._inverse: tuple[sp.csr_matrix, sp.csr_matrix] | None = None
        self._asked = 0
        self.refactorise(a)

    def refactorise(self, a: sp.spmatrix) -> None:
        upper = upper_triangle(a)
        self._scale = _scale(upper)
        scaled = _scaled(upper, self._scale)
        full = (scaled + sp.triu(scaled, 1).T).tocsr()
        if self._pattern is None or not _same(self._pattern, upper):
            self._order = nodal_order(full, self._groups)
            self._pattern = upper.indptr, upper.indices
        self._full = full[self._order][:, self._order].tocsc()
        self._inverse, self._asked = None, 0
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", spla.MatrixRankWarning)
                self._lu = spla.splu(
                    self._full,
                    permc_spec="NATURAL",
                    diag_pivot_thresh=0.0,
                    options={"SymmetricMode": True},
                )
        except RuntimeError as error:
            if self._definite:
                raise NotDefinite from error
            raise CheckError("the matrix to factorise is exactly singular") from error
        except MemoryError as error:
            raise InputError(
                f"not enough memory to factorise {self.n} degrees of freedom: "
                "use a machine with more memory, a smaller model, or install mkl"
            ) from error

    def solve(self, b: Numbers) -> Floats:
        d = self._scale[:, None]
        columns = np.asarray(b, np.float64).reshape(self.n, -1)
        y = self._lu.solve(np.asfortranarray((columns * d)[self._order]))
        x = np.empty((self.n, columns.shape[1]), order="F")
        x[self._order] = y
        x *= d
        return x.reshape(np.shape(b), order="F")

    def compliances(self, loads: sp.csr_matrix) -> Floats:
        out, far = np.empty(loads.shape[0]), np.ones(loads.shape[0], bool)
        self._asked += len(out)
        if self._inverse is None and self.n < _WORTH * self._asked and self._symmetric:
            found = self._on_pattern()
            self._inverse = found, abs(found).sign()
        if self._inverse is not None:
            inverse, stored = self._inverse
            scaled = loads @ sp.diags(self._scale)
            there = abs(scaled).sign()
            pairs = (there @ stored).multiply(there).sum(axis=1)
            far = np.asarray(pairs).ravel() != np.diff(scaled.indptr) ** 2
            out = np.asarray((scaled @ inverse).multiply(scaled).sum(axis=1)).ravel()
        out[far] = _by_parts(_by_solving(self.solve), loads[far])
        return out

    def _on_pattern(self) -> sp.csr_matrix:
        """Return the inverse of the scaled matrix where that has entries, stored zeros too."""
        assert self._pattern is not None
        indptr, indices = self._pattern
        upper = sp.csr_matrix((np.ones(len(indices)), indices, indptr), (self.n, self.n))
        order = self._order[np.argsort(self._lu.perm_c)]
        pattern = (upper + upper.T).tocsr()[order][:, order]
        found = selected_inverse(pattern, self._lu.L.tocsc(), self._lu.U.diagonal())
        back = np.argsort(order)
        return found[back][:, back]

    @property
    def _symmetric(self) -> bool:
        return np.array_equal(self._lu.perm_r, self._lu.perm_c)

    @property
    def negative(self) -> int:
        if not self._symmetric:
            raise CheckError("SuperLU left the diagonal: no count of signs")
        probe = np.random.default_rng(0).standard_normal(self.n)
        residual = np.linalg.norm(self._full @ self._lu.solve(probe) - probe)
        if not residual <= _PROBE_ERROR:
            raise CheckError("the factorisation without pivoting lost its accuracy")
        return int(np.count_nonzero(self._lu.U.diagonal() < 0.0))


def _by_solving(solve: Callable[[Numbers], Floats]) -> Callable[[Floats], Floats]:
    return lambda b: np.asarray(np.einsum("ij,ij->j", b, solve(b)))


def _by_parts(compliances: Callable[[Floats], Floats], loads: sp.csr_matrix) -> Floats:
    parts = (loads[k : k + _AT_ONCE].T.toarray() for k in range(0, loads.shape[0], _AT_ONCE))
    return np.concatenate([np.zeros(0), *map(compliances, parts)])


def _same(pattern: tuple[Ints, Ints], upper: sp.csr_matrix) -> bool:
    return np.array_equal(upper.indptr, pattern[0]) and np.array_equal(upper.indices, pattern[1])


def upper_triangle(a: sp.spmatrix) -> sp.csr_matrix:
    """Upper triangle, (n, n) csr, sorted, with every diagonal entry stored."""
    upper, rows = sp.csr_matrix(a), np.arange(a.shape[0])
    if not upper.has_canonical_format or (_first_column(upper) < rows).any():
        upper = sp.triu(a, format="csr")
        upper.sum_duplicates()
    require_finite(upper.data, "the matrix to factorise")
    stored = _first_column(upper) == rows
    if stored.all():
        return upper
    missing = rows[~stored]
    entries = upper.tocoo()
    data = np.concatenate([entries.data, np.zeros(len(missing))])
    where = [np.concatenate([at, missing]) for at in (entries.row, entries.col)]
    return sp.csr_matrix((data, where), shape=upper.shape)


def _first_column(a: sp.csr_matrix) -> Ints:
    """Column of the first stored entry of each row, (n,); n where there is none."""
    column = np.full(a.shape[0], a.shape[1])
    stored = np.diff(a.indptr) > 0
    column[stored] = a.indices[a.indptr[:-1][stored]]
    return column


def _scale(upper: sp.csr_matrix) -> Floats:
    """Power of two nearest 1/sqrt(|a_ii|), (n,); the largest entry of the row where a_ii = 0."""
    size = np.abs(upper.diagonal())
    if not size.all():
        largest = abs(upper).maximum(abs(upper).T).max(axis=1).toarray().ravel()
        size = np.where(size > 0.0, size, largest)
    size = np.where(size > 0.0, size, 1.0)
    return np.asarray(np.exp2(np.round(-0.5 * np.log2(size))))


def _scaled(upper: sp.csr_matrix, scale: Floats) -> sp.csr_matrix:
    data = upper.data * np.repeat(scale, np.diff(upper.indptr)) * scale[upper.indices]
    return sp.csr_matrix((data, upper.indices, upper.indptr), shape=upper.shape)
