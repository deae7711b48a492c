"""Write matrices to OP4 or DMIG; the file takes its name only when it is whole."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from ....core.errors import InputError
from ....core.files import replacing
from ..op4.exported_matrix import RECTANGULAR, SQUARE, SYMMETRIC, DofMap, NastranMatrix
from ..text.real_numbers import format_real
from .op4_write import op4_binary, op4_formatted

MAP = "DOFMAP"
"""Name of the matrix (n, 2) of points and components that stands in an OP4 for a dof map."""
USE = "DOFUSE"
"""Name of the matrix (n_matrix, 2) of the map's number, from 1, of rows and columns; 0: none."""
_RECTANGULAR = 9
"""Form of a rectangular matrix in DMIG."""


def write_op4(path: Path | str, matrices: Sequence[NastranMatrix], formatted: bool = False) -> None:
    """Write an OP4 file, sparse ("bigmat") and in double precision.

    OP4 has no place for dof maps: each is added as a matrix DOFMAP (DOFMAP2, ...) of two columns,
    point and component (0: scalar point); DOFUSE says which map belongs to the rows and columns
    of which matrix, in the order of the file. By these `read_matrices` gives them back.

    Parameters
    ----------
    path : path
        Replaced if it exists.
    matrices : sequence of NastranMatrix
    formatted : bool
        As text with 16 decimals instead of binary (32 bit words, little endian).

    Raises
    ------
    InputError
        A name that Nastran does not take, a file that cannot be written.
    """
    write = op4_formatted if formatted else op4_binary
    _write(path, write([*matrices, *_maps(matrices)]))


def write_dmig(path: Path | str, matrices: Sequence[NastranMatrix]) -> None:
    """Write DMIG cards in large field, as Nastran punches them; of a symmetric matrix one triangle.

    Raises
    ------
    InputError
        A matrix without dof map, which DMIG has to name; a name that is too long for Nastran; a
        file that cannot be written.
    """
    _write(path, (part for m in matrices for part in _dmig(m)))


def _dmig(m: NastranMatrix) -> Iterator[bytes]:
    """Yield DMIG cards; numbers have as many digits as 16 columns take (11 to 14)."""
    if m.rows is None:
        raise InputError(
            f"matrix {m.name} has no dof map and DMIG needs one: name the deck as a source too"
        )
    if len(m.name) > 8:
        raise InputError(f"{m.name!r} is longer than the 8 characters of a matrix name in Nastran")
    complex_ = np.iscomplexobj(m.matrix.data)
    form = SYMMETRIC if m.form == SYMMETRIC else _RECTANGULAR
    square = m.matrix.shape[0] == m.matrix.shape[1]
    if form != SYMMETRIC and square and m.columns is not None:
        form = SQUARE if np.array_equal(m.rows.keys, m.columns.keys) else _RECTANGULAR
    number = np.arange(1, m.matrix.shape[1] + 1)
    columns = m.columns or DofMap(number, np.zeros_like(number))
    matrix = sp.csc_matrix(sp.triu(m.matrix) if form == SYMMETRIC else m.matrix)
    matrix.sort_indices()
    kind = 4 if complex_ else 2
    yield f"DMIG    {m.name:8}{0:8d}{form:8d}{kind:8d}{0:8d}{'':16}{len(columns):8d}\n".encode()
    point, component = m.rows.point.tolist(), m.rows.component.tolist()
    for j in range(matrix.shape[1]):
        at = slice(matrix.indptr[j], matrix.indptr[j + 1])
        rows, values = matrix.indices[at].tolist(), matrix.data[at].tolist()
        if not rows:
            continue
        lines = [f"DMIG*   {m.name:16}{columns.point[j]:16d}{columns.component[j]:16d}"]
        for i, value in zip(rows, values, strict=True):
            parts = (value.real, value.imag) if complex_ else (value,)
            numbers = "".join(f"{format_real(part):>16}" for part in parts)
            lines.append(f"*       {point[i]:16d}{component[i]:16d}{numbers}")
        yield ("\n".join(lines) + "\n").encode()


def _maps(matrices: Sequence[NastranMatrix]) -> list[NastranMatrix]:
    """Return the maps as matrices, and which of them belongs to the rows and columns of which."""
    found: list[DofMap] = []

    def number(one: DofMap | None) -> int:
        if one is None:
            return 0
        for k, known in enumerate(found, 1):
            if np.array_equal(known.keys, one.keys):
                return k
        found.append(one)
        return len(found)

    uses = np.array([[number(m.rows), number(m.columns)] for m in matrices], float)
    if not found:
        return []
    maps = [
        NastranMatrix(
            MAP if not k else f"{MAP}{k + 1}",
            sp.csc_matrix(np.column_stack([m.point, m.component]).astype(np.float64)),
            RECTANGULAR,
        )
        for k, m in enumerate(found)
    ]
    return [*maps, NastranMatrix(USE, sp.csc_matrix(uses), RECTANGULAR)]


def _write(path: Path | str, parts: Iterator[bytes]) -> None:
    with replacing(Path(path)) as fresh, fresh.open("wb") as stream:
        stream.writelines(parts)
