"""Entries of the inverse of a sparse symmetric matrix, from its factor.

The entries of A⁻¹ on the pattern of the factor follow from each other, the last column first
(Takahashi, Fagan and Chin 1973): with A = L D Lᵀ, columns J that have rows S below them in common
and G = L_SJ L_JJ⁻¹,

    Z_SJ = −Z_SS G,   Z_JJ = (L_JJ D_J L_JJᵀ)⁻¹ + Gᵀ Z_SS G,

and Z_SS is part of what is known where the first row of S is eliminated. That takes a few times
as long as the factorisation, not a solution for every column.
"""

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Ints


def selected_inverse(pattern: sp.csr_matrix, L: sp.csc_matrix, D: Floats) -> sp.csr_matrix:
    """Return A⁻¹ on the pattern of A, (n, n).

    `pattern` has both triangles, `L` (n, n) is the unit lower factor and `D` (n,) the pivots of A
    in that order, none exchanged.
    """
    n = len(D)
    low = sp.tril(pattern, format="csc")
    low.sort_indices()
    below = _below(low)
    ends = np.array([s[0] if len(s) else n for s in below])
    count = np.array([len(s) for s in below])
    apart = (ends[:-1] != np.arange(1, n)) | (count[:-1] != count[1:] + 1)
    first = np.append(0, np.flatnonzero(apart) + 1)
    last = np.append(first[1:], n)
    known: dict[int, tuple[Ints, Floats]] = {}
    number = np.repeat(np.arange(len(first)), last - first)
    waiting = np.bincount(number[ends[last - 1][ends[last - 1] < n]], minlength=len(first))
    values = np.empty(low.nnz)
    for k in range(len(first) - 1, -1, -1):
        a, b = first[k], last[k]
        rows = np.concatenate([np.arange(a, b), below[b - 1]])
        own = _dense(L, a, b, rows)
        m = b - a
        T = np.linalg.inv(own[:m])
        Z = np.empty((len(rows),) * 2)
        Z[:m, :m] = T.T @ (T / D[a:b, None])
        if m < len(rows):
            up = number[rows[m]]
            outer, whole = known[up]
            at = np.searchsorted(outer, rows[m:])
            Z[m:, m:] = whole[np.ix_(at, at)]
            G = own[m:] @ T
            Z[m:, :m] = -Z[m:, m:] @ G
            Z[:m, m:] = Z[m:, :m].T
            Z[:m, :m] -= G.T @ Z[m:, :m]
            waiting[up] -= 1
            if not waiting[up]:
                del known[up]
        if waiting[k]:
            known[k] = rows, Z
        part = slice(low.indptr[a], low.indptr[b])
        columns = np.repeat(np.arange(m), np.diff(low.indptr[a : b + 1]))
        values[part] = Z[np.searchsorted(rows, low.indices[part]), columns]
    half = sp.csc_matrix((values, low.indices, low.indptr), (n, n))
    return (half + sp.tril(half, -1).T).tocsr()


def _below(low: sp.csc_matrix) -> Sequence[Ints]:
    """Rows below the diagonal of each column of the factor of a matrix, its lower half given."""
    below = [s[1:] for s in np.split(low.indices, low.indptr[1:-1])]
    inside: list[list[Ints]] = [[] for _ in below]
    for j, parts in enumerate(inside):
        if parts:
            below[j] = np.unique(np.concatenate([below[j], *parts]))
        if len(below[j]):
            inside[below[j][0]].append(below[j][1:])
        parts.clear()
    return below


def _dense(L: sp.csc_matrix, a: int, b: int, rows: Ints) -> Floats:
    """Return columns a to b of a factor, the `rows` in which they have entries."""
    out = np.zeros((len(rows), b - a))
    part = slice(L.indptr[a], L.indptr[b])
    columns = np.repeat(np.arange(b - a), np.diff(L.indptr[a : b + 1]))
    out[np.searchsorted(rows, L.indices[part]), columns] = L.data[part]
    return out
