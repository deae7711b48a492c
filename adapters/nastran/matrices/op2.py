"""Matrices of OP2 files (KGG, MGG, KHH, KELM, ...), through pyNastran."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

from ..results.op2file import read_op2_file
from .content import RECTANGULAR, SYMMETRIC, DofMap, NastranMatrix, symmetrised

_GRID = 1


def read_op2_matrices(path: Path | str) -> tuple[NastranMatrix, ...]:
    """Read all matrices of an OP2 file.

    A square matrix with one row for each degree of freedom of the g-set gets its dof map from the
    EQEXIN table of the same file; the others have none.

    Raises
    ------
    InputError
        The file cannot be read as OP2.
    """
    path = Path(path)
    model = read_op2_file(path, ("eqexin",))
    g_set = _g_set(model.op2_results.eqexin)
    return tuple(_matrix(m, g_set) for _, m in sorted(model.matrices.items()))


def _g_set(eqexin: Any) -> DofMap | None:
    """Return the rows of the g-set in internal order."""
    if eqexin is None:
        return None
    order = np.argsort(eqexin.dof, kind="stable")
    points = np.asarray(eqexin.nid, np.int64)[order]
    grid = np.asarray(eqexin.doftype)[order] == _GRID
    size = np.where(grid, 6, 1)
    point = np.repeat(points, size)
    within = np.arange(len(point)) - np.repeat(np.cumsum(size) - size, size)
    return DofMap(point, np.where(np.repeat(grid, size), within + 1, 0))


def _matrix(found: Any, g_set: DofMap | None) -> NastranMatrix:
    data = found.data
    matrix = sp.csc_matrix(data if sp.issparse(data) else np.atleast_2d(data))
    matrix.sum_duplicates()
    matrix.eliminate_zeros()
    name = found.name.decode("latin-1") if isinstance(found.name, bytes) else str(found.name)
    form = int(found.form or RECTANGULAR)
    square = matrix.shape[0] == matrix.shape[1]
    if form == SYMMETRIC and square:
        matrix = symmetrised(matrix)
    rows = g_set if g_set is not None and square and len(g_set) == matrix.shape[0] else None
    return NastranMatrix(name.strip().upper(), matrix, form, rows, rows)
