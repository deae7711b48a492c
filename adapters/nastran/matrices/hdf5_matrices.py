"""Matrices of Nastran's HDF5 result files (``HDF5OUT MTX YES`` and a ``CRDB_MTX`` alter).

All matrices of a file stand one after another in three tables under
``NASTRAN/RESULT/MATRIX/GENERAL``: IDENTITY has one row a matrix (name, size, where its columns and
values begin), COLUMN the place of each column's first value, DATA the row and value of each entry.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Numbers
from ....core.errors import Place
from ..op4.exported_matrix import DofMap, NastranMatrix, guessed_form
from ..results.hdf5_modes import opened

_MATRICES = "NASTRAN/RESULT/MATRIX/GENERAL"
_GRIDS = "NASTRAN/INPUT/NODE/GRID"


def read_hdf5_matrices(path: Path | str) -> tuple[NastranMatrix, ...]:
    """Read all matrices of a Nastran HDF5 file.

    A square matrix with six rows a grid of the file gets its dof map from there.

    Raises
    ------
    InputError
        The file cannot be read, or its tables do not agree with each other.
    """
    path = Path(path)
    with opened(path) as file:
        grids = np.sort(np.asarray(file[_GRIDS]["ID"], np.int64)) if _GRIDS in file else ()
        return tuple(_matrix(file[_MATRICES], row, path, grids) for row in _identities(file))


def list_hdf5_matrices(path: Path | str) -> Iterator[tuple[str, tuple[int, int]]]:
    """Yield name, rows and columns of the matrices of a file without reading their values."""
    with opened(Path(path)) as file:
        for row in _identities(file):
            yield _name(row), (int(row["ROW"]), int(row["COLUMN"]))


def _identities(file: Any) -> Numbers:
    return np.asarray(file[_MATRICES]["IDENTITY"][()] if _MATRICES in file else ())


def _name(row: Any) -> str:
    raw = row["NAME"]
    return (raw.decode("latin-1") if isinstance(raw, bytes) else str(raw)).strip(" \0").upper()


def _matrix(tables: Any, row: Any, path: Path, grids: Any) -> NastranMatrix:
    name, shape = _name(row), (int(row["ROW"]), int(row["COLUMN"]))
    first, at, count = (int(row[k]) for k in ("COLUMN_POS", "DATA_POS", "NON_ZERO"))
    pointers = np.asarray(tables["COLUMN"].fields("POSITION")[first : first + shape[1] + 1]) - at
    pointers = np.append(pointers, count)[: shape[1] + 1].astype(np.int64)
    data = tables["DATA"][at : at + count]
    rows, values = np.asarray(data["ROW"], np.int64), _values(data)
    sound = len(pointers) == shape[1] + 1 and len(rows) == count and pointers[0] == 0
    if not sound or (np.diff(pointers) < 0).any() or pointers[-1] != count:
        raise Place(path).error(f"the columns of matrix {name} do not agree with its entries")
    if count and rows.max() == shape[0]:  # counted from one
        rows = rows - 1
    if count and not 0 <= rows.min() <= rows.max() < shape[0]:
        raise Place(path).error(f"matrix {name} has entries outside of its {shape[0]} rows")
    matrix = sp.csc_matrix((values, rows, pointers), shape=shape)
    matrix.sum_duplicates()
    matrix.eliminate_zeros()
    form = int(row["FORM"]) if "FORM" in row.dtype.names else guessed_form(matrix)
    there = None
    if shape == (6 * len(grids), 6 * len(grids)) and len(grids):
        there = DofMap.of_keys((8 * grids[:, None] + np.arange(1, 7)).reshape(-1))
    return NastranMatrix.of_file(name, matrix, form, there)


def _values(data: Numbers) -> Numbers:
    """Return the values of entries, real or complex (``VALUE``, or real and imaginary apart)."""
    names = data.dtype.names or ()
    if "VALUE" in names:
        value = data["VALUE"]
        if value.dtype.names:  # a compound of two reals
            return np.asarray(value[value.dtype.names[0]] + 1j * value[value.dtype.names[1]])
        kind = np.complex128 if np.iscomplexobj(value) else np.float64
        return np.asarray(value, kind)
    real, imaginary = (next(n for n in names if n in pair) for pair in _PAIRS)
    return np.asarray(data[real] + 1j * data[imaginary])


_PAIRS = (("REAL", "VALUE_R", "VR"), ("IMAG", "VALUE_I", "VI"))
