"""DMIG matrices in the MATPOOL data block of an OP2 file (``PARAM,EXTOUT,DMIGOP2``).

After three words that tell the card, each matrix has nine: its name (two), one unused, form, type
as read, type as kept, two unused, number of columns. Columns follow as GJ, CJ and then GI, CI and
a value for each entry, ended by -1, -1; another -1, -1 ends the matrix (MSC Nastran Quick
Reference Guide, MATPOOL).
"""

from collections.abc import Iterator

import numpy as np

from ....core.arrays import Ints
from ..op4.exported_matrix import NastranMatrix
from ..results.op2_records import Op2Block, Op2File, Op2Record
from .dmig import Entries, matrix_of_entries

_DMIG = (114, 1, 120)
_HEAD = 9
_TYPES = {1: "f4", 2: "f8", 3: "c8", 4: "c16"}
_WIDE = {1: "f8", 2: "f8", 3: "c16", 4: "c16"}


def is_pool(block: Op2Block) -> bool:
    """Whether a data block holds matrices as DMIG cards do."""
    return block.name == "MATPOOL" or (
        bool(block.records) and len(block.trailer) > 2 and not any(block.trailer[2:])
        and block.name[:1] in "KMB" and not block.n_column
    )  # fmt: skip


def pool_matrices(file: Op2File, block: Op2Block) -> Iterator[NastranMatrix]:
    """Read the matrices of a MATPOOL.

    Raises
    ------
    InputError
        Entries that cannot be told apart.
    """
    for record in block.records:
        words = file.integers(record)
        if tuple(words[:3].tolist()) == _DMIG:
            yield from _matrices(file, record, words, block.name)


def _matrices(file: Op2File, record: Op2Record, words: Ints, block: str) -> Iterator[NastranMatrix]:
    raw = file.raw(record)
    at = 3
    while at + _HEAD <= len(words):
        name = file.text(record, at, 2).upper()
        form, kind = int(words[at + 3]), int(words[at + 4])
        if kind not in _TYPES:
            raise file.damaged(record.parts[0][0], f"{block} has a matrix of type {kind}")
        start = at + _HEAD
        # doubles stand there even for matrices that call themselves single
        kinds = (_TYPES[kind], _WIDE[kind]) if file.word == 4 else (_WIDE[kind],)
        for number in kinds:  # the one that leads to the end of the matrix
            size = np.dtype(number).itemsize // file.word
            if (found := _columns(words, start, size)) is not None:
                break
        else:
            raise file.damaged(record.parts[0][0], f"the entries of {name} in {block} do not end")
        (columns, at), entries = found, Entries(form, kind)
        for gj, cj, first, count in columns:
            table = np.frombuffer(
                raw[first * file.word : (first + count * (2 + size)) * file.word],
                np.dtype([("p", f"{file.order}i{file.word}"), ("c", f"{file.order}i{file.word}"),
                          ("v", file.order + number)]),
            )  # fmt: skip
            entries.columns.append(np.full(count, 8 * gj + cj, np.int64))
            entries.rows.append(8 * table["p"].astype(np.int64) + table["c"])
            entries.values.append(table["v"].astype(np.complex128 if kind > 2 else np.float64))
        yield matrix_of_entries(name, entries)


_Columns = list[tuple[int, int, int, int]]


def _columns(words: Ints, at: int, size: int) -> tuple[_Columns, int] | None:
    """Return GJ, CJ, first word and number of entries of each column, and what follows.

    None where entries of this many words do not lead to the end of the matrix.
    """
    found: _Columns = []
    while at + 2 <= len(words):
        gj, cj = int(words[at]), int(words[at + 1])
        at += 2
        if gj == cj == -1:
            return found, at
        if gj < 1 or not 0 <= cj <= 6:
            return None
        first = at
        while at + 2 <= len(words) and not words[at] == words[at + 1] == -1:
            if words[at] < 1 or not 0 <= words[at + 1] <= 6:
                return None
            at += 2 + size
        if at + 2 > len(words):
            return None
        found.append((gj, cj, first, (at - first) // (2 + size)))
        at += 2
    return None
