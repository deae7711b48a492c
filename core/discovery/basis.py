"""A small basis in which every suspect is evaluated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from ..arrays import Floats, Ints
from ..eigen import Eigensolution
from ..model import Model, Term

_DEPENDENT = 1e-5
_CHUNK = 128


@dataclass(frozen=True, eq=False)
class ReducedTerm:
    """A term of K or M on the basis, (r, r), with the factors of the full one."""

    matrix: Floats
    term: Term


@dataclass(frozen=True, eq=False)
class Basis:
    """Modes and local static responses of a model.

    Parameters
    ----------
    vectors : (n_free, r) float
        Mass-orthonormal for the deck as it is.
    motion : (n_dof, r) float
        The same on all analysis dofs, basic axes.
    stiffness, mass : tuple of ReducedTerm
    """

    vectors: Floats
    motion: Floats
    stiffness: tuple[ReducedTerm, ...]
    mass: tuple[ReducedTerm, ...]

    @property
    def size(self) -> int:
        """Number of basis vectors r."""
        return int(self.vectors.shape[1])

    def K(self, p: Floats) -> Floats:
        """Return the reduced stiffness at the parameter values `p`, (r, r)."""
        return _sum(self.stiffness, [t.term.coefficient(p) for t in self.stiffness], self.size)

    def M(self, p: Floats) -> Floats:
        """Return the reduced mass at the parameter values `p`, (r, r)."""
        return _sum(self.mass, [t.term.coefficient(p) for t in self.mass], self.size)

    def dK(self, p: Floats, k: int) -> Floats:
        """Return the derivative of the reduced stiffness by parameter `k`, (r, r)."""
        c = [t.term.coefficient_derivative(p, k) for t in self.stiffness]
        return _sum(self.stiffness, c, self.size)

    def dM(self, p: Floats, k: int) -> Floats:
        """Return the derivative of the reduced mass by parameter `k`, (r, r)."""
        c = [t.term.coefficient_derivative(p, k) for t in self.mass]
        return _sum(self.mass, c, self.size)

    def turned(self, T: Floats) -> Basis:
        """Return the basis with vectors ``vectors @ T``, T (r, s)."""
        return Basis(
            self.vectors @ T,
            self.motion @ T,
            tuple(ReducedTerm(T.T @ t.matrix @ T, t.term) for t in self.stiffness),
            tuple(ReducedTerm(T.T @ t.matrix @ T, t.term) for t in self.mass),
        )


def _sum(terms: Sequence[ReducedTerm], coefficients: Sequence[float], size: int) -> Floats:
    total = np.zeros((size, size))
    for t, c in zip(terms, coefficients, strict=True):
        if c != 0.0:
            total += c * t.matrix
    return total


def build_basis(
    model: Model, solution: Eigensolution, targets: int, extra: Floats | None = None
) -> Basis:
    """Make the basis: modes, the static response to every parameter, further vectors.

    Parameters
    ----------
    model : Model
        With the parameters that may move.
    solution : Eigensolution
        Of the deck as it is, its factor kept.
    targets : int
        The first so many modes get static responses A⁻¹ ∂K/∂p φ.
    extra : (n_free, k) float, optional
        Further right-hand sides: their static responses are added.
    """
    K, M = model.K(), model.M()
    phi = solution.vectors
    p = model.deck_point
    sides = [model.dK(k, p) @ phi[:, :targets] for k in range(len(model.parameters))]
    if extra is not None:
        sides.append(extra)
    V = np.asarray(phi)
    if sides:
        X = np.asarray(_solve(solution, K, M, np.hstack(sides)))
        V = np.hstack([phi, _independent(X, phi, M)])
    return Basis(
        V,
        np.asarray(model.expansion @ V),
        tuple(ReducedTerm(V.T @ (t.matrix @ V), t) for t in model.stiffness),
        tuple(ReducedTerm(V.T @ (t.matrix @ V), t) for t in model.mass),
    )


class Flexibility:
    """The flexibility of loads that a basis does not have, found when asked for, then kept.

    Parameters
    ----------
    model : Model
    solution : Eigensolution
        Its factor is used; the flexibility is that of K − σM with its shift.
    basis : Basis
    root : (n · q, n_free) sparse
        Loads of n candidates, q each.
    """

    def __init__(
        self, model: Model, solution: Eigensolution, basis: Basis, root: sp.csr_matrix, each: int
    ) -> None:
        self._K, self._M = model.K(), model.M()
        self._solution = solution
        self._V = basis.vectors
        self._root = root
        A = basis.vectors.T @ ((self._K - solution.sigma * self._M) @ basis.vectors)
        self._inverse = np.linalg.inv(A)
        self._kept = np.full((root.shape[0] // max(each, 1), max(each, 1)), np.nan)

    def __getitem__(self, rows: Ints) -> Floats:
        """Return what the basis lacks, (len(rows), q)."""
        wanted = np.unique(rows)
        new = wanted[np.isnan(self._kept[wanted, 0])] if len(wanted) else wanted
        q = self._kept.shape[1]
        for start in range(0, len(new), _CHUNK):
            some = new[start : start + _CHUNK]
            own = self._root[(some[:, None] * q + np.arange(q)).ravel()]
            X = _solve(self._solution, self._K, self._M, np.asarray(own.T.todense()))
            seen = np.asarray(own @ self._V)
            exact = np.asarray(own.multiply(X.T).sum(axis=1)).ravel()
            lost = exact - np.einsum("ij,ij->i", seen @ self._inverse, seen)
            self._kept[some] = np.maximum(lost, 0.0).reshape(-1, q)
        return np.asarray(self._kept[rows])


def _solve(solution: Eigensolution, K: sp.spmatrix, M: sp.spmatrix, B: Floats) -> Floats:
    from ..factor import factorise

    factor = solution.factor or factorise((K - solution.sigma * M).tocsr(), definite=True)
    return np.asarray(factor.solve(np.ascontiguousarray(B)))


def _independent(X: Floats, phi: Floats, M: sp.spmatrix) -> Floats:
    """M-orthonormal basis of what X adds to the span of phi."""
    for _ in range(2):
        X = X - phi @ (phi.T @ (M @ X))
    length = np.sqrt(np.maximum(np.einsum("ij,ij->j", X, M @ X), 0.0))
    X = X[:, length > 0.0] / length[length > 0.0]
    values, vectors = la.eigh(X.T @ (M @ X))
    keep = values > _DEPENDENT * values[-1] if len(values) else np.zeros(0, bool)
    return np.asarray(X @ (vectors[:, keep] / np.sqrt(values[keep])))
