"""Matrices of any of Nastran's files, with their dof maps as far as they are known."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ....core.errors import Place
from ..deck.read_deck import Deck
from ..op4.exported_matrix import DofMap, NastranMatrix
from ..op4.op4 import is_op4, kind_of, list_op4, read_op4
from ..op4.op4_binary import Header
from .dmig import read_dmig
from .dof_maps import deck_maps, map_of_size, read_extrn
from .hdf5_matrices import read_hdf5_matrices
from .op2_matrices import read_op2_matrices
from .write_matrices import MAP, USE

_PUNCH_SUFFIXES = (".pch", ".asm")
_HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_RESULTS = {"op2": read_op2_matrices, "hdf5": read_hdf5_matrices}


def read_matrices(path: Path | str, deck: Deck | None = None) -> tuple[NastranMatrix, ...]:
    """Read all matrices of an OP4, OP2, HDF5 or DMIG punch file; the kind is told by the contents.

    DMIG and OP2 files say what the rows of their matrices are. Those of an OP4 file are taken from
    the punch file of an external superelement beside it (same name, ``.pch``), or from the deck:
    its g-, a- or f-set, by size.

    Parameters
    ----------
    path : path
    deck : Deck, optional
        Of the run that exported the matrices.

    Raises
    ------
    InputError
        A file that cannot be read; stiffness and mass that fit no set of the deck.
    """
    path = Path(path)
    kind = matrix_file_kind(path)
    if kind == "op4":
        return _mapped(read_op4(path), path, deck)
    if kind in _RESULTS:
        found = _RESULTS[kind](path)
        if not found:
            raise Place(path).fault("holds no matrices")
        return _mapped(found, path, deck)
    found = read_dmig(path)
    if not found:
        raise Place(path).fault("holds no DMIG matrices")
    return found


def matrix_file_kind(path: Path) -> str:
    """Return ``op4``, ``op2``, ``hdf5`` or ``punch``."""
    if not path.is_file():
        raise Place(path).fault("does not exist or is not a file")
    if is_op4(path):
        return "op4"
    with path.open("rb") as stream:
        head = stream.read(1024)
    if head.startswith(_HDF5_SIGNATURE):
        return "hdf5"
    return "op2" if b"\0" in head else "punch"


def _mapped(
    matrices: Sequence[NastranMatrix], path: Path, deck: Deck | None
) -> tuple[NastranMatrix, ...]:
    """Give maps to the square stiffness, mass and damping matrices that have none."""
    matrices = _with_own_maps(matrices)
    if all(m.rows is not None or not _is_structural(m) for m in matrices):
        return tuple(matrices)
    beside = _extrn_beside(path)
    sets = {} if deck is None else deck_maps(deck)
    where = str(beside[0]) if beside else str(deck.path) if deck else ""
    if beside:
        sets = {"a": beside[1]}
    if not sets:
        return tuple(matrices)
    result = []
    for m in matrices:
        if m.rows is None and _is_structural(m):
            fitting = map_of_size(sets, m.matrix.shape[0], m.name, where)
            m = replace(m, rows=fitting, columns=fitting)
        result.append(m)
    return tuple(result)


def _with_own_maps(matrices: Sequence[NastranMatrix]) -> Sequence[NastranMatrix]:
    """Take up the maps that `write_op4` has put beside the matrices."""
    tables = [m for m in matrices if m.name.startswith(MAP) and m.matrix.shape[1] == 2]
    uses = next((m.matrix.toarray() for m in matrices if m.name == USE), None)
    others = [m for m in matrices if m not in tables and m.name != USE]
    if not tables or uses is None or uses.shape != (len(others), 2):
        return matrices
    maps: list[DofMap | None] = [None]
    for table in tables:
        point, component = table.matrix.toarray().astype(np.int64).T
        maps.append(DofMap(point, component))
    if uses.min() < 0 or uses.max() >= len(maps):
        return matrices
    result = []
    for m, (row, column) in zip(others, uses.astype(int).tolist(), strict=True):
        sides = zip((maps[row], maps[column]), m.matrix.shape, strict=True)
        rows, columns = (d if d is not None and len(d) == n else None for d, n in sides)
        result.append(replace(m, rows=rows, columns=columns))
    return result


def _is_structural(m: NastranMatrix) -> bool:
    rows, columns = m.matrix.shape
    return rows == columns > 1 and m.name[:1] in ("K", "M", "B") and m.name[-1:] in "XAGFL"


def _extrn_beside(path: Path) -> tuple[Path, DofMap] | None:
    for suffix in _PUNCH_SUFFIXES:
        for near in (path.with_suffix(suffix), path.with_suffix(suffix.upper())):
            if near.is_file() and b"EXTRN" in near.read_bytes():
                return near, read_extrn(near)
    return None


def describe_matrices(path: Path | str) -> dict[str, Any]:
    """Say which matrices an OP4 or punch file holds; the numbers of OP4 are not read.

    Raises
    ------
    InputError
        A file that cannot be read.
    """
    path = Path(path)
    if matrix_file_kind(path) == "op4":
        form, contents = f"OP4, {kind_of(path)}", [_header(h) for h in list_op4(path)]
    else:
        form, contents = "Nastran punch", [_matrix(m) for m in read_dmig(path)]
        if b"\nEXTRN" in path.read_bytes():
            contents.insert(0, _superelement(read_extrn(path)))
        if not contents:
            raise Place(path).fault("holds neither DMIG matrices nor an external superelement")
    return {"path": str(path), "format": form, "contents": contents, "skipped": []}


def _header(h: Header) -> dict[str, Any]:
    said = {"size": _size(h.shape), "form": _FORMS.get(h.form), "numbers": _KINDS[h.kind]}
    return {"what": "matrix", "name": h.name, **said}


def _matrix(m: NastranMatrix) -> dict[str, Any]:
    points = len(np.unique(m.rows.point)) if m.rows else None
    said = {"size": _size(m.matrix.shape), "form": _FORMS.get(m.form)}
    return {"what": "matrix", "name": m.name, **said, "nonzeros": m.matrix.nnz, "points": points}


def _superelement(there: DofMap) -> dict[str, Any]:
    return {
        "what": "external superelement",
        "dofs": len(there),
        "grids": len(np.unique(there.point[there.component > 0])),
        "scalar_points": int((there.component == 0).sum()),
    }


def _size(shape: tuple[int, int]) -> str:
    return f"{shape[0]} x {shape[1]}"


_FORMS = {1: "square", 2: "rectangular", 3: "diagonal", 6: "symmetric", 8: "identity",
          9: "rectangular"}  # fmt: skip
_KINDS = {1: "real, single", 2: "real, double", 3: "complex, single", 4: "complex, double"}
