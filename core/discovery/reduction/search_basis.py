"""A small basis in which every suspect is evaluated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats
from ..eigen import Eigensolution
from ..factor import factorise
from ..model import Model, Term
from ..reduced_basis import projected

_OWN = 1e-6
"""Least share of the mass of a mode that moves with the structure, for it to count."""
_ROUNDING = 1e-7
"""What is left of a vector beside this part of it is rounding."""
_DEPENDENT = 1e-5


@dataclass(frozen=True, eq=False)
class ReducedSum:
    """K or M on a basis: a sum of constant matrices times the factors of the full terms.

    Parameters
    ----------
    terms : tuple of Term
    whole : (n_term, s, s) float
        The matrices on the basis as it was made.
    turn : (s, r) float, optional
        What the basis has become since.
    """

    terms: tuple[Term, ...]
    whole: Floats
    turn: Floats | None = None

    @cached_property
    def matrices(self) -> Floats:
        """The matrices on the basis, (n_term, r, r), made when first asked for."""
        if self.turn is None:
            return self.whole
        return np.asarray(np.matmul(self.turn.T, np.matmul(self.whole, self.turn)))

    def at(self, p: Floats) -> Floats:
        """Return the sum at the parameter values `p`, (r, r)."""
        return np.asarray(np.tensordot([t.coefficient(p) for t in self.terms], self.matrices, 1))

    def slopes(self, p: Floats, parameters: Sequence[int]) -> Floats:
        """Return its derivatives by some parameters, (len(parameters), r, r)."""
        c = np.zeros((len(parameters), len(self.terms)))
        for row, k in zip(c, parameters, strict=True):
            for i in self._moved_by.get(k, ()):
                row[i] = self.terms[i].coefficient_derivative(p, k)
        return np.asarray(np.tensordot(c, self.matrices, 1))

    @cached_property
    def _moved_by(self) -> dict[int, list[int]]:
        """Terms that a parameter changes."""
        out: dict[int, list[int]] = {}
        for i, t in enumerate(self.terms):
            for k in {f.parameter for f in t.factors}:
                out.setdefault(k, []).append(i)
        return out

    def turned(self, T: Floats) -> ReducedSum:
        """Return the sum on the basis turned by T (r, s)."""
        return replace(self, turn=T if self.turn is None else self.turn @ T)

    def plus(self, change: Floats) -> ReducedSum:
        """Return the sum with a constant matrix (r, r) on the basis more."""
        none = sp.csr_matrix(self.terms[0].matrix.shape)
        return ReducedSum((*self.terms, Term(none)), np.stack([*self.matrices, change]))


def reduced_sum(terms: tuple[Term, ...], V: Floats) -> ReducedSum:
    """Return the sum of `terms` on the vectors V (n_free, r)."""
    return ReducedSum(terms, projected(terms, V))


@dataclass(frozen=True, eq=False)
class Basis:
    """Modes and local static responses of a model.

    Parameters
    ----------
    vectors : (n_free, r) float
        Mass-orthonormal for the deck as it is.
    motion : (n_dof, r) float
        The same on all analysis dofs, basic axes.
    stiffness, mass : ReducedSum
    """

    vectors: Floats
    motion: Floats
    stiffness: ReducedSum
    mass: ReducedSum

    @property
    def size(self) -> int:
        """Number of basis vectors r."""
        return int(self.vectors.shape[1])

    def K(self, p: Floats) -> Floats:
        """Return the reduced stiffness at the parameter values `p`, (r, r)."""
        return self.stiffness.at(p)

    def M(self, p: Floats) -> Floats:
        """Return the reduced mass at the parameter values `p`, (r, r)."""
        return self.mass.at(p)

    def bare(self) -> Basis:
        """Return the basis without its vectors: what eigenproblems on it need."""
        return replace(self, vectors=self.vectors[:0], motion=self.motion[:0])

    def turned(self, T: Floats) -> Basis:
        """Return the basis with vectors ``vectors @ T``, T (r, s)."""
        return Basis(
            self.vectors @ T, self.motion @ T, self.stiffness.turned(T), self.mass.turned(T)
        )


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
        V = np.hstack([phi, beside(X, phi, M, _DEPENDENT)])
    return Basis(
        V,
        np.asarray(model.expansion @ V),
        reduced_sum(model.stiffness, V),
        reduced_sum(model.mass, V),
    )


def _solve(solution: Eigensolution, K: sp.spmatrix, M: sp.spmatrix, B: Floats) -> Floats:
    factor = solution.factor or factorise((K - solution.sigma * M).tocsr(), definite=True)
    return np.asarray(factor.solve(np.ascontiguousarray(B)))


def _lengths(X: Floats, M: sp.spmatrix) -> Floats:
    """Return the lengths of the columns of X in the norm of M."""
    return np.asarray(np.sqrt(np.maximum(np.einsum("ij,ij->j", X, M @ X), 0.0)))


def beside(X: Floats, phi: Floats, M: sp.spmatrix, least: float) -> Floats:
    """Return an M-orthonormal basis of what X adds to M-orthonormal vectors.

    Parameters
    ----------
    X : (n, k) float
    phi : (n, m) float
    M : (n, n) sparse
    least : float
        Directions with less than this share of the largest squared length are left out.
    """
    before = _lengths(X, M)
    for _ in range(2):
        X = X - phi @ (phi.T @ (M @ X))
    length = _lengths(X, M)
    new = length > _ROUNDING * before
    X = X[:, new] / length[new]
    values, vectors = np.linalg.eigh(X.T @ (M @ X))
    keep = values > least * values[-1] if len(values) else np.zeros(0, bool)
    return np.asarray(X @ (vectors[:, keep] / np.sqrt(values[keep])))


def structural(T: Floats, own: Floats) -> Floats:
    """Return vectors that span those of the structure in modes that have coordinates of their own.

    Parameters
    ----------
    T : (r, n) float
        The structure's part of mass-orthonormal modes.
    own : (q, n) float
        What else moves in them, of unit mass: a mode in which hardly anything else does has no
        independent part of the structure's.
    """
    values, vectors = np.linalg.eigh(np.eye(T.shape[1]) - own.T @ own)
    if values[0] > _OWN:
        return T
    keep = values > _OWN
    return np.asarray(T @ (vectors[:, keep] / np.sqrt(values[keep])))
