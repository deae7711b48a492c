"""K or M of a model on a basis, at any parameter values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import prod

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Ints
from ..data.parametric_model import Factor, Term
from ..numerics.products import product, sparse_product

_Kept = dict[tuple[int, ...] | None, tuple[bytes, Floats]]


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
    _last: _Kept = field(default_factory=dict, init=False)

    @cached_property
    def matrices(self) -> Floats:
        """The matrices on the basis, (n_term, r, r), made when first asked for."""
        if self.turn is None:
            return self.whole
        return np.asarray(np.matmul(self.turn.T, np.matmul(self.whole, self.turn)))

    def at(self, p: Floats) -> Floats:
        """Return the sum at the parameter values `p`, (r, r), read only."""
        return self._added(None, p, lambda: np.array([t.coefficient(p) for t in self.terms]))

    def _added(
        self, what: tuple[int, ...] | None, p: Floats, weights: Callable[[], Floats]
    ) -> Floats:
        """Return the matrices added up by weights; the last of each kind is kept.

        Many hypotheses are looked at with the same values of the parameters.
        """
        same = p.tobytes()
        if what not in self._last or self._last[what][0] != same:
            c, parts = weights(), self.matrices
            one = parts.shape[1:]
            found = (c @ parts.reshape(len(parts), prod(one))).reshape(c.shape[:-1] + one)
            found.flags.writeable = False
            self._last[what] = same, found
        return self._last[what][1]

    def applied(self, p: Floats, X: Floats) -> Floats:
        """Return the full sum at `p` times vectors X (n_free, k), whatever the basis."""
        out, by_rows = np.zeros(X.shape), np.ascontiguousarray(X)  # as sparse products want
        for term in self.terms:
            some, own = own_part(term.matrix)
            part = sparse_product(own, by_rows)
            part *= term.coefficient(p)
            out[some] += part
        return out

    def slopes(self, p: Floats, parameters: Sequence[int]) -> Floats:
        """Return its derivatives by some parameters, (len(parameters), r, r), read only."""
        return self._added(tuple(parameters), p, lambda: self._slopes(p, parameters))

    def _slopes(self, p: Floats, parameters: Sequence[int]) -> Floats:
        """Return the derivatives of the terms' weights, (len(parameters), n_term)."""
        c = np.zeros((len(parameters), len(self.terms)))
        for row, k in zip(c, parameters, strict=True):
            for i in self.moved_by.get(k, ()):
                row[i] = self.terms[i].coefficient_derivative(p, k)
        return c

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

    def widened(self, parts: Sequence[Floats], W: Floats) -> ReducedSum:
        """Return the sum on W (n_free, s), too, side by side with the parts it is made on.

        Term by term, each on the rows that it has, of many terms of a part of the structure each.
        """
        n, s, t = sum(V.shape[1] for V in parts), W.shape[1], len(self.terms)
        whole = np.zeros((t, n + s, n + s))
        whole[:, :n, :n] = self.whole
        by_rows = np.ascontiguousarray(W)
        for out, term in zip(whole, self.terms, strict=True):
            some, own = own_part(term.matrix)
            X = sparse_product(own, by_rows).T
            if n:
                out[n:, :n] = np.hstack([product(X, V[some]) for V in parts])
            out[:n, n:] = out[n:, :n].T
            out[n:, n:] = product(X, W[some])
        return ReducedSum(self.terms, whole)

    def ending(self, n: int, last: Floats) -> ReducedSum:
        """Return the sum on the first n vectors and combinations of all, `last` (r, s)."""
        size = n + last.shape[1]
        whole = np.empty((len(self.terms), size, size))
        half = np.matmul(self.whole, last)
        whole[:, :n, :n], whole[:, :n, n:] = self.whole[:, :n, :n], half[:, :n]
        whole[:, n:, :n] = half[:, :n].swapaxes(1, 2)
        whole[:, n:, n:] = np.matmul(last.T, half)
        return ReducedSum(self.terms, whole)

    def and_also(self, other: ReducedSum) -> ReducedSum:
        """Return the sum with the terms of another, both on the basis as it was made."""
        return ReducedSum(self.terms + other.terms, np.concatenate([self.whole, other.whole]))

    def plus(self, changes: Sequence[Floats], factors: Sequence[Factor] = ()) -> ReducedSum:
        """Return the sum with matrices (r, r) on the basis more, times `factors` if any."""
        none = sp.csr_matrix(self.terms[0].matrix.shape)
        each = [(f,) for f in factors] if factors else [()] * len(changes)
        terms = (Term(none, own) for own in each)
        return ReducedSum((*self.terms, *terms), np.stack([*self.matrices, *changes]))


def reduced_sum(terms: tuple[Term, ...], V: Floats) -> ReducedSum:
    """Return the sum of `terms` on the vectors V (n_free, r)."""
    return ReducedSum(terms, projected(terms, V))


def projected(terms: Sequence[Term], Q: Floats) -> Floats:
    """Return Q^T A_t Q of each term A_t, (n_term, n_basis, n_basis)."""
    out = np.zeros((len(terms), Q.shape[1], Q.shape[1]))
    for k, term in enumerate(terms):
        some, own = own_part(term.matrix)
        part = own[:, some]
        half = sp.triu(part, 1, "csr") + 0.5 * sp.diags(part.diagonal())
        q = np.ascontiguousarray(Q[some])
        upper = product(q.T, sparse_product(half, q))
        out[k] = upper + upper.T
    return out


def own_part(matrix: sp.csr_matrix) -> tuple[slice | Ints, sp.csr_matrix]:
    """Find the rows of a matrix that have entries, as `own_rows`, and the matrix of these alone.

    A slice of rows shares the entries of the whole.
    """
    rows = own_rows(matrix)
    if not isinstance(rows, slice):
        return rows, matrix[rows]
    ends = matrix.indptr[rows.start : rows.stop + 1]
    stored = slice(ends[0], ends[-1])
    parts = matrix.data[stored], matrix.indices[stored], ends - ends[0]
    return rows, sp.csr_matrix(parts, (len(ends) - 1, matrix.shape[1]), copy=False)


def own_rows(matrix: sp.csr_matrix) -> slice | Ints:
    """Find the rows of a matrix that have entries: a slice where these fill most of one."""
    rows = np.flatnonzero(np.diff(matrix.indptr))
    if not len(rows):
        return rows
    low, high = int(rows[0]), int(rows[-1]) + 1
    return slice(low, high) if 2 * len(rows) > high - low else rows
