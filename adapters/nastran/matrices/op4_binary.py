"""Binary OUTPUT4 files: 32 and 64 bit words, both byte orders, dense, bigmat and nonbigmat.

A file is a sequence of Fortran records. The first of a matrix holds NCOL, NROW, FORM, TYPE and
NAME; one for each column holds ICOL, IROW, NW and NW words: with IROW > 0 the values from that
row on, with IROW = 0 strings, each led by its length and first row (two words where NROW < 0 or
NROW > 65535, "bigmat"; both in one word otherwise). A column NCOL + 1 ends the matrix (MSC Nastran
DMAP Programmer's Guide, OUTPUT4).
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....core.arrays import Ints, Numbers
from ....core.errors import InputError
from .columns import Strings, assemble, expand
from .content import SYMMETRIC, NastranMatrix, symmetrised

_BIGMAT_FROM = 65536
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
        raw = np.memmap(path, np.uint8, "r")
        word, shift = layout.word, layout.mark % layout.word
        usable = raw[shift : shift + (len(raw) - shift) // word * word]
        self.words = usable.view(f"u{word}")
        self.integers = usable.view(f"{layout.order}i{word}")
        self.data, self.layout, self.path = memoryview(raw.data), layout, path
        self._mark = struct.Struct(layout.order + ("i" if layout.mark == 4 else "q"))
        self._three = struct.Struct(layout.order + ("3i" if layout.word == 4 else "3q"))

    def record(self, at: int) -> tuple[int, int]:
        """Return where the content of a record starts and ends."""
        mark = self.layout.mark
        if at + mark > len(self.data):
            raise self.cut_short(at)
        size = self._mark.unpack_from(self.data, at)[0]
        if size < 0:
            raise InputError(
                f"{self.path}: a record at byte {at} is split into parts or damaged; write the "
                "matrix again in smaller parts"
            )
        end = at + mark + size
        if end + mark > len(self.data):
            raise self.cut_short(at)
        if self._mark.unpack_from(self.data, end)[0] != size:
            raise InputError(f"{self.path} is damaged: the record at byte {at} does not close")
        return at + mark, end

    def cut_short(self, at: int) -> InputError:
        return InputError(f"{self.path} is cut short: it ends in the record at byte {at}")

    def damaged_strings(self, header: Header) -> InputError:
        return InputError(
            f"{self.path} is damaged: matrix {header.name} ({header.shape[0]} by "
            f"{header.shape[1]}) has a string of values that does not fit"
        )

    def column(self, start: int) -> tuple[int, int, int]:
        """Return ICOL, IROW, NW at the start of a record."""
        found: tuple[int, int, int] = self._three.unpack_from(self.data, start)
        return found

    def header(self, start: int, end: int) -> Header:
        word, order = self.layout.word, self.layout.order
        if end - start != 6 * word:
            raise InputError(
                f"{self.path} is damaged: a matrix is expected at byte {start}, but the record "
                f"has {end - start} bytes"
            )
        four = order + ("4q" if word == 8 else "4i")
        ncol, nrow, form, kind = struct.unpack_from(four, self.data, start)
        raw = bytes(self.data[start + 4 * word : end])
        if word == 8:  # each of the two words of a name holds four characters
            raw = raw[:4] + raw[8:12]
        name = raw.decode("latin-1").strip(" \0").upper()
        if kind not in (1, 2, 3, 4) or ncol < 0:
            raise InputError(f"{self.path}: matrix {name!r} has a type {kind} that is not known")
        return Header(name, (abs(nrow), ncol), form, kind, nrow < 0 or nrow >= _BIGMAT_FROM)


def read_binary(
    path: Path, layout: Layout, values: bool = True
) -> Iterator[NastranMatrix | Header]:
    """Read the matrices of a binary OP4 file in turn.

    With `values` False only their headers are given; the columns are stepped over.

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
        columns, at = _columns(file, end + layout.mark, header)
        yield _matrix(file, header, columns) if values else header


def _columns(file: _File, at: int, header: Header) -> tuple[Ints, int]:
    """Return ICOL, IROW, first and last byte of the values of each column, and the next record."""
    found: list[tuple[int, int, int, int]] = []
    head = 3 * file.layout.word
    while True:
        start, end = file.record(at)
        if end - start < head:
            raise InputError(f"{file.path} is damaged: no column of {header.name} at byte {at}")
        column, row, words = file.column(start)
        at = end + file.layout.mark
        if column > header.shape[1]:
            return np.array(found, np.int64).reshape(-1, 4), at
        last = found[-1][0] if found else 0
        fits = start + head + words * file.layout.word <= end
        if column <= last or row < 0 or words < 0 or not fits:
            raise InputError(
                f"{file.path} is damaged: matrix {header.name} has no column {column} of "
                f"{words} words from row {row}"
            )
        found.append((column, row, start + head, start + head + words * file.layout.word))


def _matrix(file: _File, header: Header, columns: Ints) -> NastranMatrix:
    kind, word = header.kind, file.layout.word
    per_value = (1 if word == 8 or kind in (1, 3) else 2) * (2 if kind in (3, 4) else 1)
    strings = _strings(file, header, columns, per_value)
    total = int(strings.length.sum())
    picked = file.words[expand(strings.at, strings.length * per_value)]
    bytes_of_real = 4 if word == 4 and kind in (1, 3) else 8
    letter = "f" if kind in (1, 2) else "c"
    size = bytes_of_real * (2 if letter == "c" else 1)
    values: Numbers = picked.view(f"{file.layout.order}{letter}{size}")
    values = values.astype(np.complex128 if letter == "c" else np.float64).reshape(total)
    matrix = assemble(strings, values, header.shape)
    if header.form == SYMMETRIC and header.shape[0] == header.shape[1]:
        matrix = symmetrised(matrix)
    return NastranMatrix(header.name, matrix, header.form, single=kind in (1, 3))


def _strings(file: _File, header: Header, columns: Ints, per_value: int) -> Strings:
    """Find all runs of values; `at` counts words of the file."""
    word, first_byte = file.layout.word, file.layout.mark % file.layout.word
    at, end = ((columns[:, k] - first_byte) // word for k in (2, 3))
    dense = columns[:, 1] > 0
    parts = [(columns[dense, 0], columns[dense, 1], (end - at)[dense], at[dense])]
    column, at, end = columns[~dense, 0], at[~dense], end[~dense]
    lead = 2 if header.bigmat else 1
    while len(column):  # the k-th string of every column at once
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
    column, row, length, at = (np.concatenate(p) for p in zip(*parts, strict=True))
    order = np.argsort(column, kind="stable")
    column, row, length, at = column[order], row[order], length[order], at[order]
    count = length // per_value
    if (length % per_value).any() or (row < 1).any() or (row + count - 1 > header.shape[0]).any():
        raise file.damaged_strings(header)
    return Strings(column - 1, row - 1, count, at)
