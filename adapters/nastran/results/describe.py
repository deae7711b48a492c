"""What a results file holds, in one screen."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from .hdf5 import read_hdf5_tables
from .modes import is_hdf5_file
from .op2 import read_op2_tables
from .table import ModeTable


def describe_results(path: Path | str) -> dict[str, Any]:
    """Say what an OP2 or Nastran HDF5 file holds.

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
    is_hdf5 = is_hdf5_file(path)
    tables, names = (read_hdf5_tables if is_hdf5 else read_op2_tables)(path)
    return {
        "path": str(path),
        "format": "Nastran HDF5" if is_hdf5 else "Nastran OP2",
        "contents": {"modes": [_modes(t) for t in tables], "tables": list(names)},
        "skipped": [
            {"what": name, "line": None, "why": "no modes, eigenvalues or geometry of them"}
            for name in names
            if not _is_read(name)
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
    read = ("NODAL/EIGENVECTOR", "NODAL/EIGENVECTOR_CPLX", "SUMMARY/EIGENVALUE", "DOMAINS")
    return name.startswith(starts) or name in read
