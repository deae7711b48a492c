"""Write OUTPUT4 files that Nastran reads with INPUTT4: sparse, double precision."""

from collections.abc import Iterable, Iterator

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Floats, Ints
from ....core.errors import InputError
from ..op4.exported_matrix import NastranMatrix
from ..op4.packed_columns import expand, runs_of

_REAL, _COMPLEX = 2, 4
_WORD = 4
_ENTRIES = 1 << 18
_HEAD = 3
"""Words before the strings of a column: ICOL, IROW, NW."""
_LONGEST_NAME = 8
_PER_LINE, _WIDTH = 3, 23


def op4_binary(matrices: Iterable[NastranMatrix]) -> Iterator[bytes]:
    """Yield the bytes of a binary file (bigmat, 32 bit words, little endian).

    Raises
    ------
    InputError
        A name that Nastran does not take.
    """
    for m in matrices:
        matrix, kind = _prepared(m)
        header = np.zeros(8, "<i4")
        header[1:5] = m.matrix.shape[1], -m.matrix.shape[0], m.form, kind
        header[0] = header[7] = 24
        name = _name(m).ljust(_LONGEST_NAME).encode("ascii")
        yield header[:5].tobytes() + name + header[7:].tobytes()
        for first, stop in _parts(matrix):
            yield _binary_columns(matrix[:, first:stop], first, kind).tobytes()
        end = (5 * _WORD, matrix.shape[1] + 1, 1, 2, 0, 0x3FF00000, 5 * _WORD)
        yield np.array(end, "<i4").tobytes()


def op4_formatted(matrices: Iterable[NastranMatrix]) -> Iterator[bytes]:
    """Yield the lines of a formatted file (bigmat, 16 digits).

    Raises
    ------
    InputError
        A name that Nastran does not take, a matrix that is too large for the format.
    """
    for m in matrices:
        matrix, kind = _prepared(m)
        if max(matrix.shape) > 9_999_999:
            raise InputError(f"matrix {m.name} is too large for formatted OP4: write it in binary")
        head = "".join(f"{n:8d}" for n in (matrix.shape[1], -matrix.shape[0], m.form, kind))
        yield f"{head}{_name(m):8}1P,{_PER_LINE}E{_WIDTH}.16\n".encode()
        for first, stop in _parts(matrix):
            yield from _formatted_columns(matrix[:, first:stop], first, kind)
        yield f"{matrix.shape[1] + 1:8d}{1:8d}{1:8d}\n{1.0:{_WIDTH}.16E}\n".encode()


def _name(m: NastranMatrix) -> str:
    plain = m.name.replace("_", "")
    if not (m.name.isascii() and m.name[:1].isalpha() and plain.isalnum()):
        raise InputError(
            f"{m.name!r} is no name for a matrix in Nastran: letters and digits, a letter first"
        )
    if len(m.name) > _LONGEST_NAME:
        raise InputError(f"{m.name!r} is longer than the 8 characters of a matrix name in Nastran")
    return m.name.upper()


def _prepared(m: NastranMatrix) -> tuple[sp.csc_matrix, int]:
    matrix = sp.csc_matrix(m.matrix, copy=True)
    matrix.sum_duplicates()
    matrix.eliminate_zeros()
    matrix.sort_indices()
    complex_ = np.iscomplexobj(matrix.data)
    return matrix, _COMPLEX if complex_ else _REAL


def _reals(matrix: sp.csc_matrix, kind: int) -> Floats:
    dtype = "<c16" if kind == _COMPLEX else "<f8"
    return np.asarray(np.ascontiguousarray(matrix.data, dtype).view("<f8"))


def _parts(matrix: sp.csc_matrix) -> Iterator[tuple[int, int]]:
    """Cut the columns into parts of about as many entries; columns without any are passed over."""
    first = 0
    while first < matrix.shape[1]:
        until = int(matrix.indptr[first]) + _ENTRIES
        stop = int(np.searchsorted(matrix.indptr, until, "right")) - 1
        stop = min(max(stop, first + 1), matrix.shape[1])
        if matrix.indptr[stop] > matrix.indptr[first]:
            yield first, stop
        first = stop


def _binary_columns(matrix: sp.csc_matrix, shift: int, kind: int) -> Ints:
    """Return records of some columns as words, those before counted by `shift`."""
    strings = runs_of(matrix)
    per_value = 4 if kind == _COMPLEX else 2
    words_of_string = 2 + strings.length * per_value
    held, first = np.unique(strings.column, return_index=True)
    words = np.add.reduceat(words_of_string, first) if len(held) else np.zeros(0, np.int64)
    record = words + _HEAD + 2  # two marks
    start = np.cumsum(record) - record
    total = int(record.sum())
    out = np.zeros(total, "<i4")
    size = (words + _HEAD) * _WORD
    out[start] = out[start + record - 1] = size
    out[start + 1], out[start + 3] = held + 1 + shift, words
    # strings stand one after another in their record, two marks and three words between columns
    number = np.searchsorted(held, strings.column)
    at = np.cumsum(words_of_string) - words_of_string + (_HEAD + 2) * number + 1 + _HEAD
    out[at], out[at + 1] = strings.length * per_value + 1, strings.row + 1
    out[expand(at + 2, strings.length * per_value)] = _reals(matrix, kind).view("<i4")
    return out


def _formatted_columns(matrix: sp.csc_matrix, shift: int, kind: int) -> Iterator[bytes]:
    strings = runs_of(matrix)
    complex_ = 2 if kind == _COMPLEX else 1
    text = _printed(_reals(matrix, kind))
    lines: list[str] = []
    last = -1
    words = np.bincount(strings.column, 2 + 2 * complex_ * strings.length).astype(np.int64).tolist()
    for column, row, length, at in zip(
        strings.column.tolist(),
        strings.row.tolist(),
        strings.length.tolist(),
        strings.at.tolist(),
        strict=True,
    ):
        if column != last:
            lines.append(f"{column + 1 + shift:8d}{0:8d}{words[column]:8d}\n")
            last = column
        lines.append(f"{2 * complex_ * length + 1:8d}{row + 1:8d}\n")
        stop = _WIDTH * complex_ * (at + length)
        for k in range(_WIDTH * complex_ * at, stop, _WIDTH * _PER_LINE):
            lines += (text[k : min(k + _WIDTH * _PER_LINE, stop)], "\n")
    yield "".join(lines).encode()


def _printed(values: Floats) -> str:
    """Print numbers one after another, each in its columns; three-digit exponents with one less."""
    text = f"%{_WIDTH}.16E" * len(values) % tuple(values.tolist())
    if len(text) == _WIDTH * len(values):
        return text
    fields = (f"{v:{_WIDTH}.16E}" for v in values.tolist())
    pairs = zip(fields, values.tolist(), strict=True)
    return "".join(f if len(f) == _WIDTH else f"{v:{_WIDTH}.15E}" for f, v in pairs)
