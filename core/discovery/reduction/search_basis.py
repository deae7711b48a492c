"""A small basis in which every suspect is evaluated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats
from ...data.parametric_model import Model
from ...eigen.normal_modes import Eigensolution
from ...numerics.factorisation import factorise
from ...reduction.reduced_sum import ReducedSum, reduced_sum
from .reduction_numbers import REDUCTION


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


def build_basis(model: Model, solution: Eigensolution, targets: int) -> Basis:
    """Make the basis: modes of the deck as it is and the static response to every parameter.

    The first `targets` modes get static responses A⁻¹ ∂K/∂p φ.
    """
    K, M, p = model.K(), model.M(), model.deck_point
    V = np.asarray(solution.vectors)
    modes = V[:, :targets]
    sides = [independent(model.dK(k, p) @ modes) for k in range(len(model.parameters))]
    if sides:
        factor = solution.factor or factorise((K - solution.sigma * M).tocsr(), definite=True)
        X = factor.solve(np.ascontiguousarray(np.hstack(sides)))
        V = np.hstack([V, beside(X, [V], M, REDUCTION.dependent)])
    motion = np.asarray(model.expansion @ V)
    return Basis(V, motion, reduced_sum(model.stiffness, V), reduced_sum(model.mass, V))


def independent(loads: Floats) -> Floats:
    """Return loads that span the same as those of some modes, (n_free, m) and (n_free, s ≤ m).

    Modes of a free body that strain nothing have none but rounding.
    """
    length = np.linalg.norm(loads, axis=0)
    live = length > REDUCTION.rounding * length.max(initial=0.0)
    unit = loads[:, live] / length[live]
    values, vectors = np.linalg.eigh(unit.T @ unit)
    return np.asarray(unit @ vectors[:, values > REDUCTION.rounding * len(values)])


def _lengths(X: Floats, M: sp.spmatrix) -> Floats:
    """Return the lengths of the columns of X in the norm of M."""
    return np.asarray(np.sqrt(np.maximum(np.einsum("ij,ij->j", X, M @ X), 0.0)))


def beside(X: Floats, parts: Sequence[Floats], M: sp.spmatrix, least: float) -> Floats:
    """Return an M-orthonormal basis of what X (n, k) adds to M-orthonormal vectors: `parts` (n, m).

    Directions with less than the share `least` of the largest squared length are left out.
    """
    before = _lengths(X, M)
    for _ in range(2):
        MX = M @ X
        for V in parts:
            X = X - ((MX.T @ V) @ V.T).T
    length = _lengths(X, M)
    new = length > REDUCTION.rounding * before
    X = X[:, new] / length[new]
    values, vectors = np.linalg.eigh(X.T @ (M @ X))
    keep = values > least * values[-1] if len(values) else np.zeros(0, bool)
    return np.asarray(X @ (vectors[:, keep] / np.sqrt(values[keep])))


def structural(T: Floats, own: Floats) -> Floats:
    """Return vectors that span those of the structure in modes that have coordinates of their own.

    T (r, n) is the structure's part of mass-orthonormal modes, `own` (q, n) what else moves in
    them, of unit mass: a mode in which hardly anything else does has no independent part of the
    structure's.
    """
    values, vectors = np.linalg.eigh(np.eye(T.shape[1]) - own.T @ own)
    if values[0] > REDUCTION.own:
        return T
    keep = values > REDUCTION.own
    return np.asarray(T @ (vectors[:, keep] / np.sqrt(values[keep])))
