"""Write matrices to OP4 or DMIG; the file takes its name only when it is whole."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from ....core.files import replacing
from .dmig_write import dmig_text
from .exported_matrix import RECTANGULAR, DofMap, NastranMatrix
from .op4_write import op4_binary, op4_formatted

MAP = "DOFMAP"
"""Name of the matrix (n, 2) of points and components that stands in an OP4 for a dof map."""
USE = "DOFUSE"
"""Name of the matrix (n_matrix, 2) of the map's number, from 1, of rows and columns; 0: none."""


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
    """Write DMIG cards in large field, as Nastran punches them.

    Raises
    ------
    InputError
        A matrix without dof map, a file that cannot be written.
    """
    _write(path, dmig_text(matrices))


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
