"""K or M of a model on a basis, at any parameter values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats
from ..data.parametric_model import Factor, Term


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
            for i in self.moved_by.get(k, ()):
                row[i] = self.terms[i].coefficient_derivative(p, k)
        return np.asarray(np.tensordot(c, self.matrices, 1))

    @cached_property
    def moved_by(self) -> dict[int, list[int]]:
        """Terms that a parameter changes."""
        out: dict[int, list[int]] = {}
        for i, t in enumerate(self.terms):
            for k in {f.parameter for f in t.factors}:
                out.setdefault(k, []).append(i)
        return out

    def turned(self, T: Floats) -> ReducedSum:
        """Return the sum on the basis turned by T (r, s)."""
        return replace(self, turn=T if self.turn is None else self.turn @ T)

    def widened(self, V: Floats, W: Floats) -> ReducedSum:
        """Return the sum on the vectors V, on which it is made, and W (n_free, s).

        Term by term, each on the rows that it has, of many terms of a part of the structure each.
        """
        (n, s), t = (V.shape[1], W.shape[1]), len(self.terms)
        whole = np.zeros((t, n + s, n + s))
        whole[:, :n, :n] = self.whole
        for out, term in zip(whole, self.terms, strict=True):
            rows = np.flatnonzero(np.diff(term.matrix.indptr))
            some = slice(None) if len(rows) == len(V) else rows
            X = np.asarray(term.matrix[some] @ W)
            out[:n, n:] = V[some].T @ X
            out[n:, :n] = out[:n, n:].T
            out[n:, n:] = W[some].T @ X
        return ReducedSum(self.terms, whole)

    def and_also(self, other: ReducedSum) -> ReducedSum:
        """Return the sum with the terms of another, both on the basis as it was made."""
        return ReducedSum(self.terms + other.terms, np.concatenate([self.whole, other.whole]))

    def plus(self, change: Floats, parameter: int | None = None) -> ReducedSum:
        """Return the sum with a matrix (r, r) on the basis more, times p - 1 of a `parameter`."""
        none = sp.csr_matrix(self.terms[0].matrix.shape)
        factors = () if parameter is None else (Factor(parameter, (0.0, 1.0), 0.0, 2.0),)
        return ReducedSum((*self.terms, Term(none, factors)), np.stack([*self.matrices, change]))


def reduced_sum(terms: tuple[Term, ...], V: Floats) -> ReducedSum:
    """Return the sum of `terms` on the vectors V (n_free, r)."""
    return ReducedSum(terms, projected(terms, V))


def projected(terms: Sequence[Term], Q: Floats) -> Floats:
    """Return Q^T A_t Q of each term A_t, (n_term, n_basis, n_basis)."""
    out = np.zeros((len(terms), Q.shape[1], Q.shape[1]))
    for k, term in enumerate(terms):
        half = sp.triu(term.matrix, 1) + 0.5 * sp.diags(term.matrix.diagonal())
        half = half.tocoo()
        rows, at = np.unique(np.concatenate([half.row, half.col]), return_inverse=True)
        part = sp.csr_matrix((half.data, at.reshape(2, -1)), shape=(len(rows), len(rows)))
        q = np.ascontiguousarray(Q[rows])
        product = q.T @ (part @ q)
        out[k] = product + product.T
    return out
