"""A matrix as Nastran exports it, and what its rows are."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from ....core.arrays import Ints, hold
from ....core.data.dofs import Dofs
from ....core.noun import Noun

if TYPE_CHECKING:
    import scipy.sparse as sp

SQUARE, RECTANGULAR, SYMMETRIC = 1, 2, 6
_COLUMNS = 1 << 14


@dataclass(frozen=True, eq=False)
class DofMap(Noun):
    """Which points and components the rows or columns of a matrix are.

    Parameters
    ----------
    point : (n,) int
        Grid or scalar point.
    component : (n,) int
        1 to 6 in the displacement system of a grid, 0 for a scalar point.
    """

    point: Ints
    component: Ints

    def __post_init__(self) -> None:
        hold(self, "point", np.int64)
        hold(self, "component", np.int64, self.point.shape)

    def __len__(self) -> int:
        return len(self.point)

    @property
    def keys(self) -> Ints:
        """One number a degree of freedom, increasing in Nastran's internal order, (n,)."""
        return np.asarray(8 * self.point + self.component, np.int64)

    @property
    def dofs(self) -> Dofs:
        """The same as neutral degrees of freedom; a scalar point has component 1 and no axis."""
        scalar = self.component == 0
        axis = np.array(Dofs(self.point, np.maximum(self.component, 1)).axis)
        axis[scalar] = 0.0
        return Dofs(self.point, np.maximum(self.component, 1), axis)

    @classmethod
    def of_dofs(cls, dofs: Dofs) -> Self:
        """Make a map from what `dofs` gave."""
        return cls(dofs.node, np.where(dofs.axis.any(axis=1), dofs.component, 0))

    @classmethod
    def of_keys(cls, keys: Ints) -> Self:
        """Make a map from `keys`."""
        return cls(keys // 8, keys % 8)

    @classmethod
    def of_labels(cls, labels: Iterable[str]) -> Self:
        """Make a map from the labels ``POINT:COMPONENT`` of a model's free dofs."""
        pairs = np.array([[int(w) for w in label.split(":")] for label in labels], np.int64)
        return cls(*pairs.reshape(-1, 2).T)


@dataclass(frozen=True, eq=False)
class NastranMatrix(Noun):
    """One matrix of an export.

    Parameters
    ----------
    name : str
        In capitals, as in the file.
    matrix : (n_row, n_column) sparse csc
        Real or complex; of a symmetric matrix both triangles.
    form : int
        Nastran's: 1 square, 2 rectangular, 6 symmetric, others as in the file.
    rows, columns : DofMap or None
        None where the file does not tell.
    single : bool
        Whether the file holds it in single precision.
    """

    name: str
    matrix: sp.csc_matrix
    form: int = RECTANGULAR
    rows: DofMap | None = None
    columns: DofMap | None = None
    single: bool = False

    @classmethod
    def of_file(
        cls,
        name: str,
        matrix: sp.csc_matrix,
        form: int,
        there: DofMap | None = None,
        single: bool = False,
    ) -> Self:
        """Return a matrix as a file holds it: a symmetric one may have one triangle only."""
        if form == SYMMETRIC and matrix.shape[0] == matrix.shape[1]:
            matrix = symmetrised(matrix)
        return cls(name, matrix, form, there, there, single)


def symmetrised(matrix: sp.csc_matrix) -> sp.csc_matrix:
    """Fill in the entries of a symmetric matrix that are given on one side of the diagonal only."""
    import scipy.sparse as sp  # slow to import, and not needed to know a file

    upper, lower = _sides(matrix)
    if upper == lower and _is_symmetric(matrix):
        return matrix
    if not upper or not lower:
        diagonal = sp.diags_array(matrix.diagonal(), format="csc")
        return sp.csc_matrix(matrix + matrix.T.tocsc() - diagonal)
    other = matrix.T.tocsc()
    held = sp.csc_matrix((np.ones(matrix.nnz), matrix.indices, matrix.indptr), matrix.shape)
    missing = (other - other.multiply(held)).tocsc()
    return (matrix + missing).tocsc() if missing.count_nonzero() else matrix


def _is_symmetric(matrix: sp.csc_matrix) -> bool:
    """Whether a matrix and its transpose do the same to a vector of no special direction."""
    vector = np.random.default_rng(0).standard_normal(matrix.shape[0])
    size = abs(matrix.data).max(initial=0.0) * matrix.shape[0]
    return bool(np.abs(matrix @ vector - matrix.T @ vector).max(initial=0.0) <= 1e-7 * size)


def _sides(matrix: sp.csc_matrix) -> tuple[int, int]:
    """Count the entries above and below the diagonal, a part of the columns at a time."""
    upper = lower = 0
    for first in range(0, matrix.shape[1], _COLUMNS):
        bounds = matrix.indptr[first : first + _COLUMNS + 1].astype(np.int64)
        rows = matrix.indices[bounds[0] : bounds[-1]]
        columns = np.repeat(np.arange(first, first + len(bounds) - 1), np.diff(bounds))
        upper += int(np.count_nonzero(rows < columns))
        lower += int(np.count_nonzero(rows > columns))
    return upper, lower


def guessed_form(matrix: sp.spmatrix) -> int:
    """Return 6 for a symmetric, 1 for another square, 2 for a rectangular matrix."""
    if matrix.shape[0] != matrix.shape[1]:
        return RECTANGULAR
    return SQUARE if (matrix != matrix.T).nnz else SYMMETRIC


RUNS_SCHEMA = "trueup/export-runs/1"


def is_runs(head: bytes) -> bool:
    """Whether the start of a file is that of a ``runs.json`` of export-runs."""
    return head.lstrip()[:1] == b"{" and f'"{RUNS_SCHEMA}"'.encode() in head
