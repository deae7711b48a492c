"""What a results file holds, in one screen."""

from pathlib import Path
from typing import Any

from .matrices.hdf5_matrices import list_hdf5_matrices
from .matrices.op2_matrices import list_op2_matrices
from .results.eigenvector_table import ModeHead
from .results.op2_modes import unread_op2_blocks
from .results.read_modes import HDF5, HEAD_READERS, OP2, kind_of_results

_OTHER = "neither modes nor their eigenvalues"


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
    heads, names = HEAD_READERS[kind](path)
    matrices = dict(_LISTS[kind](path)) if kind in _LISTS else {}
    unread = unread_op2_blocks(path) if kind == OP2 else {}
    contents: dict[str, Any] = {"modes": [_modes(t) for t in heads]}
    if matrices:
        contents["matrices"] = {name: f"{n} x {m}" for name, (n, m) in matrices.items()}
    return {
        "path": str(path),
        "format": kind,
        "contents": {**contents, "tables": list(names)},
        "skipped": [
            {"what": name, "line": None, "why": unread.get(name, _OTHER)}
            for name in names
            if name in unread or (not _is_read(name) and name not in matrices)
        ],
    }


def _modes(table: ModeHead) -> dict[str, Any]:
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
    return name.startswith(_READ_STARTS) or name in _READ


_READ_STARTS = (
    "OUG",
    "BOUG",
    "OPHIG",
    "BOPHIG",
    "ROUG",
    "LAMA",
    "BLAMA",
    "CLAMA",
    "MATRIX/GENERAL/",
)
_READ = (
    *("EIGENVECTOR", "DISPLACEMENTS", "DOMAINS", "MATPOOL", "SUMMARY/EIGENVALUE"),
    *("real eigenvalues", "real eigenvectors", "complex eigenvectors"),
    *("NODAL/EIGENVECTOR", "NODAL/EIGENVECTOR_CPLX"),
)
_LISTS = {OP2: list_op2_matrices, HDF5: list_hdf5_matrices}
