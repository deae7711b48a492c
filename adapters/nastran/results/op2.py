"""Eigenvectors from OP2 files (MSC, NX, OptiStruct, MYSTRAN), through pyNastran."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from ....core.arrays import Floats, Ints, Numbers
from .op2file import read_op2_file
from .table import ModeTable

_GRID, _SCALAR = 1, 2
_REAL, _COMPLEX = 2, 9  # analysis codes of normal and of complex modes
_SUPERELEMENT = re.compile(r"SUPERELEMENT (\d+)")
_KINDS = ("eigenvectors", "ROUGV1.eigenvectors", "eigenvectors_structure")
_SUMMARY = "eigenvalues"


def read_op2_tables(path: Path) -> tuple[list[ModeTable], tuple[str, ...]]:
    """Read all eigenvectors of an OP2 file.

    Frequencies come from the eigenvalues (in the header of each eigenvector, where the LAMA table
    may be missing), never from what the file calls cycles: that is rad/s in some.

    Returns
    -------
    tables : list of ModeTable
    names : tuple of str
        All tables of the file, for inspection.

    Raises
    ------
    InputError
        The file cannot be read as OP2.
    """
    model = read_op2_file(path, (*_KINDS, _SUMMARY))
    tables: list[ModeTable] = []
    for kind in _KINDS:
        found = model.get_result(kind)
        modal = {k: v for k, v in found.items() if int(v.analysis_code) in (_REAL, _COMPLEX)}
        tables += [_table(key, v, model.eigenvalues) for key, v in modal.items()]
        if found:
            break
    names = [t.decode("latin-1") if isinstance(t, bytes) else str(t) for t in model.table_names]
    return tables, tuple(dict.fromkeys(n.strip() for n in names))


def _table(key: Any, vectors: Any, summaries: Any) -> ModeTable:
    kind = vectors.node_gridtype[:, 1]
    rows = np.flatnonzero((kind == _GRID) | (kind == _SCALAR))
    numbers = np.asarray(vectors.modes, np.int64)
    eigenvalues = _eigenvalues(vectors)
    shapes = np.moveaxis(vectors.data[:, rows, :], 0, 2)
    name = vectors.table_name
    name = name.decode("latin-1") if isinstance(name, bytes) else str(name)
    return ModeTable(
        subcase=int(key[0] if isinstance(key, tuple) else key),
        superelement=_superelement(key),
        points=vectors.node_gridtype[rows, 0].astype(np.int64),
        scalar=kind[rows] == _SCALAR,
        numbers=numbers,
        eigenvalues=eigenvalues,
        shapes=shapes.astype(np.complex128 if np.iscomplexobj(shapes) else np.float64),
        generalized_mass=_generalized_mass(summaries, numbers, eigenvalues),
        basic=name.startswith("B"),
    )


def _eigenvalues(vectors: Any) -> Numbers:
    """Return what the headers of the eigenvectors hold: lambda, or the real and imaginary root."""
    if int(vectors.analysis_code) == _COMPLEX:
        roots = np.asarray(vectors.eigrs, float) + 1j * np.asarray(vectors.eigis, float)
        return np.asarray(roots)
    real = getattr(vectors, "eigns", None)
    return np.asarray(vectors.eigrs if real is None else real, float)


def _superelement(key: Any) -> int:
    match = _SUPERELEMENT.search(str(key))
    return int(match[1]) if match else 0


def _generalized_mass(summaries: Any, numbers: Ints, eigenvalues: Numbers) -> Floats:
    """Return the masses of the LAMA table that lists these eigenvalues; NaN where none does."""
    for summary in summaries.values():
        mass = getattr(summary, "generalized_mass", None)
        if mass is None or np.iscomplexobj(eigenvalues):
            continue
        rows = {int(n): k for k, n in enumerate(summary.mode)}
        at = np.array([rows.get(int(n), -1) for n in numbers])
        if (at < 0).any():
            continue
        scale = np.abs(eigenvalues).max(initial=0.0)
        listed = np.asarray(summary.eigenvalues, float)[at]
        if np.allclose(listed, eigenvalues, rtol=1e-5, atol=1e-6 * scale):
            return np.asarray(np.asarray(mass, float)[at])
    return np.full(len(numbers), np.nan)
