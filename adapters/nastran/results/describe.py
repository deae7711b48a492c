"""What a results file holds, in one screen."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..matrices.op2 import read_op2_matrices
from .modes import OP2, READERS, kind_of_results
from .table import ModeTable


def describe_results(path: Path | str) -> dict[str, Any]:
    """Say what an OP2, a Nastran HDF5, a punch or an F06 file holds.

    Returns
    -------
    dict
        ``path``, ``format``, ``contents`` (modes by subcase and superelement) and ``skipped``
        (what, line, why): tables that are not read.

    Raises
    ------
    InputError
        A file that cannot be read.
    """
    path = Path(path)
    kind = kind_of_results(path)
    tables, names = READERS[kind](path)
    matrices = read_op2_matrices(path) if kind == OP2 else ()
    read = {m.name for m in matrices}
    contents: dict[str, Any] = {"modes": [_modes(t) for t in tables]}
    if matrices:
        contents["matrices"] = {
            m.name: f"{m.matrix.shape[0]} x {m.matrix.shape[1]}" for m in matrices
        }
    return {
        "path": str(path),
        "format": kind,
        "contents": {**contents, "tables": list(names)},
        "skipped": [
            {"what": name, "line": None, "why": "neither modes nor their eigenvalues"}
            for name in names
            if not _is_read(name) and name not in read
        ],
    }


def _modes(table: ModeTable) -> dict[str, Any]:
    return {
        "subcase": table.subcase,
        "superelement": table.superelement,
        "modes": len(table.numbers),
        "complex": table.is_complex,
        "frequencies_hz": table.frequencies_hz.tolist(),
        "grids": int((~table.scalar).sum()),
        "scalar_points": int(table.scalar.sum()),
        "axes": "basic" if table.basic else "displacement systems of the grids",
    }


def _is_read(name: str) -> bool:
    starts = ("OUG", "BOUG", "OPHIG", "BOPHIG", "ROUG", "LAMA", "BLAMA", "CLAMA")
    read = (
        "EIGENVECTOR",
        "DISPLACEMENTS",
        "real eigenvalues",
        "real eigenvectors",
        "NODAL/EIGENVECTOR",
        "NODAL/EIGENVECTOR_CPLX",
        "SUMMARY/EIGENVALUE",
        "DOMAINS",
    )
    return name.startswith(starts) or name in read
