"""From element matrices to sparse matrices over all degrees of freedom, chunk by chunk."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Ints, Matrices
from ..numerics.shared_pattern_sum import shared

CHUNK = 1024
"""Elements evaluated at a time: bounds memory and keeps a chunk's matrices in cache."""

Evaluate = Callable[[Ints, Floats, tuple[bool, bool]], Matrices]
"""``evaluate(rows, p, wanted)``: matrices of the elements of the given rows at the parameter
values p, (n_parameter,); what is not wanted (stiffness, mass) may be left None."""


@dataclass(frozen=True, eq=False)
class ElementBlock:
    """Elements of one kind and the routine that makes their matrices.

    Parameters
    ----------
    places : (n, w) int
        Where an element's matrix goes: each place is `width` consecutive degrees of freedom that
        start at ``width * place``.
    width : {1, 3, 6}
        Degrees of freedom a place.
    evaluate : callable
        ``evaluate(rows, p, wanted)`` returns stiffness and mass, each
        (len(rows), w * width, w * width).
    depends : tuple of tuple of int
        Sets of parameter numbers.
    depends_of : (n,) int
        Which of `depends` each element's matrices depend on.
    name : str
        For messages.
    shape_moves : bool
        Whether positions of nodes are among the parameters.
    """

    places: Ints
    width: int
    evaluate: Evaluate
    depends: tuple[tuple[int, ...], ...] = ((),)
    depends_of: Ints = None  # type: ignore[assignment]
    name: str = ""
    shape_moves: bool = False

    def __post_init__(self) -> None:
        if self.depends_of is None:
            object.__setattr__(self, "depends_of", np.zeros(len(self.places), dtype=np.int64))

    def __len__(self) -> int:
        return len(self.places)


@dataclass(frozen=True, eq=False)
class Members:
    """Some elements of a block."""

    block: ElementBlock
    rows: Ints


@dataclass(frozen=True, eq=False)
class Recipe:
    """Matrices wanted as combinations of element matrices at some parameter values.

    Parameters
    ----------
    points : (n_point, n_parameter) float
        Where the elements are evaluated.
    stiffness : (n_stiffness, n_point) float
        Weights of the stiffness matrices at the points, one row a matrix wanted.
    mass : (n_mass, n_point) float
        Likewise of the mass matrices.
    """

    points: Floats
    stiffness: Floats
    mass: Floats


def assemble(
    members: Sequence[Members], n_dof: int, recipe: Recipe
) -> tuple[list[sp.csr_matrix], list[sp.csr_matrix]]:
    """Sum weighted element matrices.

    Parameters
    ----------
    members : sequence of Members
        Elements to be summed.
    n_dof : int
        Size of the matrices.
    recipe : Recipe
        At which parameter values, with which weights.

    Returns
    -------
    stiffness, mass : list of (n_dof, n_dof) csr_matrix
        One a row of the recipe's weights.
    """
    stiffness = [sp.csr_matrix((n_dof, n_dof)) for _ in recipe.stiffness]
    masses = _EntrySum(len(recipe.mass), n_dof)
    for width in (6, 3, 1):
        same = [m for m in members if m.block.width == width and len(m.rows)]
        if same:
            blocks = _BlockSum(same, width, len(recipe.points))
            for number, member in enumerate(same):
                _add_member(blocks, masses, number, member, recipe)
            parts = blocks.matrices(n_dof, recipe.stiffness)
            added = any(a.nnz for a in stiffness) and any(b.nnz for b in parts)
            both = [a + b for a, b in zip(stiffness, parts, strict=True)] if added else []
            stiffness = both or (parts if any(b.nnz for b in parts) else stiffness)
    return stiffness, masses.matrices()


def _add_member(
    blocks: _BlockSum, masses: _EntrySum, number: int, member: Members, recipe: Recipe
) -> None:
    for start in range(0, len(member.rows), CHUNK):
        part = slice(start, min(start + CHUNK, len(member.rows)))
        rows = member.rows[part]
        for k, p in enumerate(recipe.points):
            wanted = (bool(recipe.stiffness[:, k].any()), bool(recipe.mass[:, k].any()))
            if not any(wanted):
                continue
            K, M = member.block.evaluate(rows, p, wanted)
            if K is not None and wanted[0]:
                blocks.add(number, part, K, k)
            if M is not None and wanted[1]:
                masses.add(member.block.places[rows], member.block.width, M, recipe.mass[:, k])


class _EntrySum:
    """Accumulates the entries of element matrices that are mostly zero: lumped masses."""

    def __init__(self, count: int, n_dof: int) -> None:
        self._n_dof = n_dof
        self._entries: list[list[tuple[Ints, Ints, Floats]]] = [[] for _ in range(count)]

    def add(self, places: Ints, width: int, values: Floats, weights: Floats) -> None:
        e, i, j = np.nonzero(values)
        if not len(e):
            return
        dofs = (places[:, :, None] * width + np.arange(width)).reshape(len(places), -1)
        rows, columns, found = dofs[e, i], dofs[e, j], values[e, i, j]
        for k in np.flatnonzero(weights):
            self._entries[k].append((rows, columns, weights[k] * found))

    def matrices(self) -> list[sp.csr_matrix]:
        shape = (self._n_dof, self._n_dof)
        out = []
        for entries in self._entries:
            if not entries:
                out.append(sp.csr_matrix(shape))
                continue
            rows, columns, values = (np.concatenate(part) for part in zip(*entries, strict=True))
            matrix = sp.coo_matrix((values, (rows, columns)), shape=shape).tocsr()
            matrix.eliminate_zeros()
            out.append(matrix)
        return out


class _BlockSum:
    """Sums element matrices of equal width, evaluated at several points, on one pattern."""

    def __init__(self, members: Sequence[Members], width: int, n_point: int) -> None:
        self._width = width
        self._members = members
        self._pattern: tuple[Ints, list[Ints]] | None = None
        self._data: list[Floats | None] = [None] * n_point

    def _find_pattern(self) -> tuple[Ints, list[Ints]]:
        """Return the sorted keys (row place, column place) and each member's positions in them."""
        keys = []
        for m in self._members:
            places = m.block.places[m.rows].astype(np.int64)
            keys.append(((places[:, :, None] << 32) + places[:, None, :]).reshape(-1))
        every = np.concatenate(keys)
        unique, inverse = np.unique(every, return_inverse=True)
        cuts = np.cumsum([len(k) for k in keys])[:-1]
        return unique, np.split(inverse, cuts)

    def add(self, member: int, part: slice, values: Floats, point: int) -> None:
        if not values.any():
            return
        if self._pattern is None:
            self._pattern = self._find_pattern()
        data = self._data[point]
        if data is None:
            data = self._data[point] = np.zeros((len(self._pattern[0]), self._width**2))
        n, m, _ = values.shape
        b = self._width
        w = m // b
        blocks = values.reshape(n, w, b, w, b).transpose(0, 1, 3, 2, 4).reshape(n * w * w, b * b)
        position = self._pattern[1][member][part.start * w * w : part.stop * w * w]
        order = np.argsort(position, kind="stable")
        ordered = position[order]
        starts = np.flatnonzero(np.diff(ordered, prepend=-1))
        data[ordered[starts]] += np.add.reduceat(blocks[order], starts, axis=0)

    def matrices(self, n_dof: int, weights: Floats) -> list[sp.csr_matrix]:
        """Weighted sums over the points, one a row of `weights`, (n, n_point)."""
        if self._pattern is None:
            return [sp.csr_matrix((n_dof, n_dof)) for _ in weights]
        position, pattern = self._to_csr(n_dof)
        totals = []
        total, scaled = np.empty((2, self._pattern[0].size * self._width**2))
        for row in weights:
            total.fill(0.0)
            for weight, data in zip(row, self._data, strict=True):
                if weight != 0.0 and data is not None:
                    total += np.multiply(data.reshape(-1), weight, out=scaled)
            totals.append(total[position])
        return _trimmed(totals, pattern)

    def _to_csr(self, n_dof: int) -> tuple[Ints, sp.csr_matrix]:
        """Where the entries of a csr matrix stand among those of the blocks, and its pattern."""
        assert self._pattern is not None
        keys, b = self._pattern[0], self._width
        rows, columns = keys >> 32, (keys & 0xFFFFFFFF).astype(np.int32)
        n_places = n_dof // b
        start = np.searchsorted(rows, np.arange(n_places + 1)).astype(np.int32)
        number = np.arange(keys.size * b * b, dtype=np.float64).reshape(-1, b, b)
        size = n_places * b
        matrix = sp.bsr_matrix((number, columns, start), shape=(size, size)).tocsr()
        if size < n_dof:
            matrix.resize(n_dof, n_dof)
        return matrix.data.astype(np.int64), matrix


def _trimmed(totals: list[Floats], pattern: sp.csr_matrix) -> list[sp.csr_matrix]:
    """Matrices on one pattern without the entries that are zero in all of them."""
    used = np.zeros(pattern.nnz, dtype=bool)
    for total in totals:
        used |= total != 0.0
    if not used.all():
        counts = np.concatenate([[0], np.cumsum(used)])
        indptr = counts[pattern.indptr].astype(pattern.indptr.dtype)
        totals = [total[used] for total in totals]
        empty = np.zeros(int(counts[-1]))
        pattern = sp.csr_matrix((empty, pattern.indices[used], indptr), shape=pattern.shape)
    return shared(totals, pattern)
