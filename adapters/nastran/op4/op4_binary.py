"""Binary OUTPUT4 files: 32 and 64 bit words, both byte orders, dense, bigmat and nonbigmat.

A file is a sequence of Fortran records. The first of a matrix holds NCOL, NROW, FORM, TYPE and
NAME; one for each column holds ICOL, IROW, NW and NW words: with IROW > 0 the values from that
row on, with IROW = 0 strings, each led by its length and first row (two words where NROW < 0 or
NROW > 65535, "bigmat"; both in one word otherwise). A column NCOL + 1 ends the matrix (MSC Nastran
DMAP Programmer's Guide, OUTPUT4).
"""

import mmap
import struct
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....core.arrays import Ints, Numbers
from ....core.errors import InputError, Place
from ....core.files import release
from .exported_matrix import NastranMatrix
from .packed_columns import Filler, Strings, gather

_BIGMAT_FROM = 65536
_FEW = 64
"""Strings of fewer columns than these are found column by column, else side by side."""
_BATCH, _MOST_COLUMNS = 1 << 20, 1 << 15
"""Bytes and numbers of columns that are looked at together."""
_MOST_ROWS = 500_000_000
"""More than any model has; a damaged header says more."""
_HEADER = {24: 4, 48: 8}
"""Bytes of a matrix header record: bytes of a word."""


@dataclass(frozen=True)
class Layout:
    """Byte order (``<`` or ``>``), bytes of a word and of a record mark."""

    order: str
    word: int
    mark: int = 4


def layout_of(head: bytes) -> Layout | None:
    """Tell the layout by the first record mark; None when this is no binary OP4."""
    for order in "<>":
        for mark, code in ((4, "i"), (8, "q")):
            if len(head) < mark:
                continue
            size = struct.unpack(order + code, head[:mark])[0]
            if size in _HEADER and head[mark + size : 2 * mark + size] == head[:mark]:
                return Layout(order, _HEADER[size], mark)
    return None


@dataclass(frozen=True)
class Header:
    """The first record of a matrix; `bigmat` as its strings are led."""

    name: str
    shape: tuple[int, int]
    form: int
    kind: int
    bigmat: bool


class _File:
    """Fortran records over the bytes of a file."""

    def __init__(self, path: Path, layout: Layout) -> None:
        with path.open("rb") as stream:
            self.data = mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ)
        word, shift = layout.word, layout.mark % layout.word
        count = (len(self.data) - shift) // word
        self.words = np.frombuffer(self.data, f"u{word}", count, shift)
        self.integers = self.words.view(f"{layout.order}i{word}")
        self.layout, self.path = layout, path
        self._mark = struct.Struct(layout.order + ("i" if layout.mark == 4 else "q"))
        self._three = struct.Struct(layout.order + ("3i" if layout.word == 4 else "3q"))
        self._released = 0

    def release(self, until: int) -> None:
        """Let the system take back the memory of what has been read."""
        release(self.data, self._released, until)
        self._released = until // mmap.PAGESIZE * mmap.PAGESIZE

    def record(self, at: int) -> tuple[int, int]:
        """Return where the content of a record starts and ends."""
        mark = self.layout.mark
        if at + mark > len(self.data):
            raise self.cut_short(at)
        size = self._mark.unpack_from(self.data, at)[0]
        if size < 0:
            raise Place(self.path).error(
                f"a record at byte {at} is split into parts or damaged; write the "
                "matrix again in smaller parts"
            )
        end = at + mark + size
        if end + mark > len(self.data):
            raise self.cut_short(at)
        if self._mark.unpack_from(self.data, end)[0] != size:
            raise Place(self.path).fault(f"is damaged: the record at byte {at} does not close")
        return at + mark, end

    def cut_short(self, at: int) -> InputError:
        return Place(self.path).fault(f"is cut short: it ends in the record at byte {at}")

    def damaged_strings(self, header: Header) -> InputError:
        return Place(self.path).fault(
            f"is damaged: matrix {header.name} ({header.shape[0]} by "
            f"{header.shape[1]}) has a string of values that does not fit"
        )

    def column(self, start: int) -> tuple[int, int, int]:
        """Return ICOL, IROW, NW at the start of a record."""
        found: tuple[int, int, int] = self._three.unpack_from(self.data, start)
        return found

    def header(self, start: int, end: int) -> Header:
        word, order = self.layout.word, self.layout.order
        if end - start != 6 * word:
            raise Place(self.path).fault(
                f"is damaged: a matrix is expected at byte {start}, but the record "
                f"has {end - start} bytes"
            )
        four = order + ("4q" if word == 8 else "4i")
        ncol, nrow, form, kind = struct.unpack_from(four, self.data, start)
        raw = bytes(self.data[start + 4 * word : end])
        if word == 8:  # each of the two words of a name holds four characters
            raw = raw[:4] + raw[8:12]
        name = raw.decode("latin-1").strip(" \0").upper()
        if kind not in (1, 2, 3, 4) or ncol < 0:
            raise Place(self.path).error(f"matrix {name!r} has a type {kind} that is not known")
        if max(abs(nrow), ncol) > _MOST_ROWS:
            raise Place(self.path).fault(
                f"is damaged: matrix {name!r} says that it has {abs(nrow)} rows and {ncol} columns"
            )
        return Header(name, (abs(nrow), ncol), form, kind, nrow < 0 or nrow >= _BIGMAT_FROM)


Names = frozenset[str] | None
"""Matrices whose numbers are wanted; None: all."""


def read_binary(
    path: Path, layout: Layout, wanted: Names = None
) -> Iterator[NastranMatrix | Header]:
    """Read the matrices of a binary OP4 file in turn.

    Of those not `wanted` only the headers are given; the columns are stepped over.

    Raises
    ------
    InputError
        A file that is cut short or damaged.
    """
    file = _File(path, layout)
    at = 0
    while at < len(file.data):
        start, end = file.record(at)
        header = file.header(start, end)
        columns = _Columns(file, end + layout.mark, header)
        if wanted is None or header.name in wanted:
            yield _matrix(file, header, columns)
        else:
            for _ in columns.batches():  # stepped over
                pass
            yield header
        at = columns.at


class _Columns:
    """The columns of a matrix in turn; `at` is the record after them when all have been met."""

    def __init__(self, file: _File, at: int, header: Header) -> None:
        self.file, self.at, self.header = file, at, header

    def batches(self) -> Iterator[Ints]:
        """Yield ICOL, IROW, first and last byte of the values, (n, 4), of some columns at once."""
        found = array("q")
        limit = self.at + _BATCH
        for entry in self._each():
            found.extend(entry)
            if self.at > limit or len(found) > _MOST_COLUMNS:
                yield np.array(found, np.int64).reshape(-1, 4)
                self.file.release(self.at)
                found = array("q")
                limit = self.at + _BATCH
        yield np.array(found, np.int64).reshape(-1, 4)
        self.file.release(self.at)

    def _each(self) -> Iterator[tuple[int, int, int, int]]:
        file, header = self.file, self.header
        word, mark = file.layout.word, file.layout.mark
        head, last = 3 * word, 0
        while True:
            start, end = file.record(self.at)
            if end - start < head:
                raise Place(file.path).fault(
                    f"is damaged: no column of {header.name} at byte {self.at}"
                )
            column, row, words = file.column(start)
            self.at = end + mark
            if column > header.shape[1]:
                return
            stop = start + head + words * word
            if column <= last or row < 0 or words < 0 or stop > end:
                raise Place(file.path).fault(
                    f"is damaged: matrix {header.name} has no column {column} of "
                    f"{words} words from row {row}"
                )
            last = column
            yield column, row, start + head, stop


def _matrix(file: _File, header: Header, columns: _Columns) -> NastranMatrix:
    kind, word = header.kind, file.layout.word
    per_value = (1 if word == 8 or kind in (1, 3) else 2) * (2 if kind in (3, 4) else 1)
    bytes_of_real = 4 if word == 4 and kind in (1, 3) else 8
    letter = "f" if kind in (1, 2) else "c"
    size = bytes_of_real * (2 if letter == "c" else 1)
    most = (len(file.data) - columns.at) // size
    filler = Filler(header.shape, most, np.complex128 if letter == "c" else np.float64)
    for batch in columns.batches():
        strings = _strings(file, header, batch, per_value)
        picked = gather(file.words, strings.at, strings.length * per_value)
        values: Numbers = picked.view(f"{file.layout.order}{letter}{size}")
        try:
            filler.add(strings, values)
        except ValueError:
            raise file.damaged_strings(header) from None
    return NastranMatrix.of_file(header.name, filler.matrix(), header.form, single=kind in (1, 3))


def _strings_of_column(
    file: _File, header: Header, column: int, span: tuple[int, int]
) -> tuple[Ints, Ints, Ints, Ints]:
    """Find the runs of one column, one after another: column, row, words and place of each."""
    at, end = span
    words = file.integers[at:end].astype(np.int64).data
    found, k, stop = array("q"), 0, end - at
    lead = 2 if header.bigmat else 1
    while k + lead <= stop:
        if header.bigmat:
            length, row = words[k] - 1, words[k + 1]
        else:
            length, row = (words[k] >> 16) - 1, words[k] & 0xFFFF
        k += lead
        if length < 1 or k + length > stop:
            raise file.damaged_strings(header)
        found.extend((column, row, length, at + k))
        k += length
    column_of, row_of, length_of, at_of = np.array(found, np.int64).reshape(-1, 4).T
    return column_of, row_of, length_of, at_of


def _strings(file: _File, header: Header, columns: Ints, per_value: int) -> Strings:
    """Find all runs of values; `at` counts words of the file."""
    word, first_byte = file.layout.word, file.layout.mark % file.layout.word
    at, end = ((columns[:, k] - first_byte) // word for k in (2, 3))
    dense = columns[:, 1] > 0
    parts = [(columns[dense, 0], columns[dense, 1], (end - at)[dense], at[dense])]
    column, at, end = columns[~dense, 0], at[~dense], end[~dense]
    lead = 2 if header.bigmat else 1
    while len(column) >= _FEW:  # the k-th string of every column at once
        inside = at + lead <= end
        column, at, end = column[inside], at[inside], end[inside]
        said = file.integers[at].astype(np.int64)
        if header.bigmat:
            length, row = said - 1, file.integers[at + 1].astype(np.int64)
        else:
            length, row = (said >> 16) - 1, said & 0xFFFF
        parts.append((column, row, length, at + lead))
        if (length < 1).any() or (at + lead + length > end).any():
            raise file.damaged_strings(header)
        at = at + lead + length
    for one, start, stop in zip(column.tolist(), at.tolist(), end.tolist(), strict=True):
        parts.append(_strings_of_column(file, header, one, (start, stop)))
    column, row, length, at = (np.concatenate(p) for p in zip(*parts, strict=True))
    order = np.argsort(column, kind="stable")
    column, row, length, at = column[order], row[order], length[order], at[order]
    count = length // per_value
    if (length % per_value).any() or (row < 1).any() or (row + count - 1 > header.shape[0]).any():
        raise file.damaged_strings(header)
    return Strings(column - 1, row - 1, count, at)
