"""Strings of values, as Nastran packs the columns of a sparse matrix, to a sparse matrix."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Ints, Numbers


@dataclass(frozen=True, eq=False)
class Strings:
    """Runs of consecutive rows of columns.

    Parameters
    ----------
    column, row : (n_string,) int
        From 0: column, first row.
    length : (n_string,) int
        Number of values.
    at : (n_string,) int
        Where the first value stands, in units of the caller.
    """

    column: Ints
    row: Ints
    length: Ints
    at: Ints


def expand(starts: Ints, lengths: Ints) -> Ints:
    """Return ``start, start + 1, ...`` of each run, one after another."""
    total = int(lengths.sum())
    before = np.cumsum(lengths) - lengths
    return np.asarray(np.arange(total) + np.repeat(starts - before, lengths))


def assemble(strings: Strings, values: Numbers, shape: tuple[int, int]) -> sp.csc_matrix:
    """Make a sparse matrix; `values` are those of all strings in turn. Zeros are not stored."""
    rows = expand(strings.row, strings.length)
    columns = np.repeat(strings.column, strings.length)
    held = values != 0
    if not held.all():
        rows, columns, values = rows[held], columns[held], values[held]
    matrix = sp.coo_matrix((values, (rows, columns)), shape=shape).tocsc()
    matrix.sort_indices()
    return matrix


def runs_of(matrix: sp.csc_matrix) -> Strings:
    """Cut the columns of a sparse matrix with sorted indices into runs; `at` counts its data."""
    columns = np.repeat(np.arange(matrix.shape[1]), np.diff(matrix.indptr))
    rows = matrix.indices.astype(np.int64)
    breaks = np.ones(len(rows), bool)
    breaks[1:] = (np.diff(rows) != 1) | (np.diff(columns) != 0)
    start = np.flatnonzero(breaks)
    length = np.diff(np.append(start, len(rows)))
    return Strings(columns[start], rows[start], length, start)
