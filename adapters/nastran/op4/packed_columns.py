"""Strings of values, as Nastran packs the columns of a sparse matrix, to a sparse matrix."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ....core.arrays import Ints, Numbers
from ....core.errors import InputError

if TYPE_CHECKING:
    import scipy.sparse as sp

_LONG = 256
"""Runs of so many words on average are copied one by one, shorter ones picked all at once."""


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


def gather(words: Numbers, starts: Ints, lengths: Ints) -> Numbers:
    """Return the words of each run, one after another."""
    if len(starts) and lengths.sum() >= _LONG * len(starts):
        pairs = zip(starts.tolist(), (starts + lengths).tolist(), strict=True)
        return np.concatenate([words[a:b] for a, b in pairs])
    return np.asarray(words[expand(starts, lengths)])


class Filler:
    """Puts a sparse matrix together column after column, in little more memory than it takes.

    Parameters
    ----------
    shape : (int, int)
    most : int
        No more values than these will come.
    dtype : float64 or complex128

    Raises
    ------
    InputError
        A size that no memory holds.
    """

    def __init__(self, shape: tuple[int, int], most: int, dtype: npt.DTypeLike) -> None:
        most = max(min(most, shape[0] * shape[1]), 0)
        index = np.int32 if max(*shape, most) < 2**31 - 1 else np.int64
        self._shape = shape
        try:  # memory is taken only when it is written
            self._data: Numbers = np.empty(most, dtype)
            self._rows: Numbers = np.empty(most, index)
            self._counts: Numbers = np.zeros(shape[1] + 1, index)
        except MemoryError:
            raise InputError(
                f"a matrix of {shape[0]} rows and {shape[1]} columns does not fit into memory, if "
                "its file is sound"
            ) from None
        self._n = 0

    def add(self, strings: Strings, values: Numbers) -> None:
        """Add the values of some strings, columns rising; zeros are not stored.

        Raises
        ------
        ValueError
            More values than were announced.
        """
        rows = expand(strings.row, strings.length)
        columns = np.repeat(strings.column, strings.length)
        held = values != 0
        if not held.all():
            rows, columns, values = rows[held], columns[held], values[held]
        stop = self._n + len(values)
        if stop > len(self._data):
            raise ValueError("more values than rows and columns")
        self._data[self._n : stop] = values
        self._rows[self._n : stop] = rows
        self._n = stop
        if len(columns):
            first = int(columns.min())
            found = np.bincount(columns - first)
            self._counts[first + 1 : first + 1 + len(found)] += found.astype(self._counts.dtype)

    def matrix(self) -> sp.csc_matrix:
        """Return the matrix; the filler is empty afterwards."""
        for array in (self._data, self._rows):
            array.resize(self._n, refcheck=False)
        np.cumsum(self._counts, out=self._counts)
        import scipy.sparse as sp  # slow to import, and not needed to know a file

        matrix = sp.csc_matrix((self._data, self._rows, self._counts), self._shape)
        self._data = self._rows = np.empty(0)
        if not matrix.has_sorted_indices:
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
