"""Matrices of OP2 files: data blocks such as KGG and KELM, and the DMIG of a MATPOOL."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ..op4.exported_matrix import DofMap, NastranMatrix
from ..op4.packed_columns import Filler, Strings, gather
from ..results.op2_records import Op2Block, Op2File
from .op2_matpool import is_pool, pool_matrices

_GRID = 1
_RUNS = 1 << 14
_NAMED_ROWS = ("EQEXIN", "EQEXINS")
_FORMS = (1, 2, 3, 4, 5, 6, 8, 9, 10, 11, 13, 15)
_COMPLEX = (3, 4)
_DOUBLE = (2, 4)


def read_op2_matrices(path: Path | str) -> tuple[NastranMatrix, ...]:
    """Read all matrices of an OP2 file, 32 or 64 bit.

    A square matrix with one row for each degree of freedom of the g-set gets its dof map from the
    EQEXIN table of the same file; matrices of a MATPOOL (``PARAM,EXTOUT,DMIGOP2``) name their
    degrees of freedom themselves; the others have none.

    Raises
    ------
    InputError
        The file cannot be read as OP2.
    """
    with Op2File(Path(path)) as file:
        g_set = _g_set(file)
        found: dict[str, NastranMatrix] = {}
        for block in file.blocks:
            if is_pool(block):
                found |= {m.name: m for m in pool_matrices(file, block)}
            elif is_matrix(block):
                found[block.name] = _matrix(file, block, g_set)
        return tuple(found[name] for name in sorted(found))


def list_op2_matrices(path: Path | str) -> Iterator[tuple[str, tuple[int, int]]]:
    """Yield name, rows and columns of the matrices of an OP2 file without reading their values."""
    with Op2File(Path(path)) as file:
        for block in file.blocks:
            if is_pool(block):
                yield from ((m.name, m.matrix.shape) for m in pool_matrices(file, block))
            elif is_matrix(block):
                yield block.name, (block.trailer[2], block.trailer[1])


def is_matrix(block: Op2Block) -> bool:
    """Whether a data block is a matrix: its records are columns, its trailer that of a matrix."""
    return (
        block.n_column > 0
        and len(block.trailer) >= 5
        and block.trailer[3] in _FORMS
        and block.trailer[4] in (1, 2, 3, 4)
    )


def _g_set(file: Op2File) -> DofMap | None:
    """Return the rows of the g-set in internal order: pairs of point and 10 * place + kind."""
    block = next((b for b in file.blocks if b.name in _NAMED_ROWS and len(b.records) == 2), None)
    if block is None:
        return None
    words = file.integers(block.records[1])
    pairs = words[: len(words) // 2 * 2].reshape(-1, 2)
    order = np.argsort(pairs[:, 1] // 10, kind="stable")
    points, grid = pairs[order, 0], pairs[order, 1] % 10 == _GRID
    size = np.where(grid, 6, 1)
    point = np.repeat(points, size)
    within = np.arange(len(point)) - np.repeat(np.cumsum(size) - size, size)
    return DofMap(point, np.where(np.repeat(grid, size), within + 1, 0))


def _matrix(file: Op2File, block: Op2Block, g_set: DofMap | None) -> NastranMatrix:
    columns, rows, form, kind = block.trailer[1:5]
    single = file.word == 4 and kind not in _DOUBLE
    size = (4 if single else 8) * (2 if kind in _COMPLEX else 1)
    number = f"{file.order}{'c' if kind in _COMPLEX else 'f'}{size}"
    table = np.frombuffer(block.runs, np.int64).reshape(-1, 4)
    most = int((table[:, 3] - table[:, 2]).sum()) // size
    filler = Filler((rows, columns), most, np.complex128 if kind in _COMPLEX else np.float64)
    for first in range(0, len(table), _RUNS):
        column, row, start, stop = table[first : first + _RUNS].T
        count = (stop - start) // size
        wrong = (row < 0) | (row + count > rows) | (column >= columns) | ((stop - start) % size > 0)
        if wrong.any() or (start % 4).any():  # records begin at multiples of four bytes
            at = int(start[np.argmax(wrong)])
            raise file.damaged(at, f"a run of {block.name} does not fit its size")
        values = gather(file.words(), start // 4, (stop - start) // 4).view(number)
        try:
            filler.add(Strings(column, row, count, start), values)
        except ValueError:
            raise file.damaged(int(start[0]), f"{block.name} has too many values") from None
        file.release_between(int(start.min(initial=0)), int(stop.max(initial=0)))
    there = g_set if g_set is not None and len(g_set) == rows == columns else None
    return NastranMatrix.of_file(block.name.upper(), filler.matrix(), form, there, single)
