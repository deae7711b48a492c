"""Formatted OUTPUT4 files: dense, bigmat and nonbigmat, exponents with E, D or no letter."""

import re
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ....core.arrays import Floats
from ....core.errors import InputError, Place
from .exported_matrix import NastranMatrix
from .op4_binary import Header, Names
from .packed_columns import Filler, Strings

_FORMAT = re.compile(r"(\d+)\s*[EDGF](\d+)\.\d+", re.IGNORECASE)
_NO_LETTER = re.compile(rb"(?<=[\d.])([+-]\d+)$")
_BIGMAT_FROM = 65536
_BATCH = 1 << 20


@dataclass(frozen=True)
class _Print:
    """How numbers are printed: values a line, columns a value, columns a whole number."""

    per_line: int
    width: int
    integer: int


class _Lines:
    """The lines of a file, one after another; only a part of it is in memory."""

    def __init__(self, path: Path, stream: BinaryIO) -> None:
        self.path = path
        self.size = path.stat().st_size
        self.at = 0
        self._stream = stream
        self._ahead: bytes | None = None

    def more(self) -> bool:
        """Whether anything but blank lines is left."""
        while self._ahead is None:
            line = self._stream.readline()
            if not line:
                return False
            if line.strip():
                self._ahead = line
            else:
                self.at += 1
        return True

    def next(self, what: str) -> bytes:
        line = self._ahead if self._ahead is not None else self._stream.readline()
        self._ahead = None
        if not line:
            raise Place(self.path).fault(f"is cut short: it ends where {what} is expected")
        self.at += 1
        return line.rstrip(b"\r\n")

    def wrong(self, why: str) -> InputError:
        return Place(self.path, self.at).error(f"{why}")

    def integers(self, what: str, count: int, width: int) -> list[int]:
        line = self.next(what)
        try:
            if count == 2:
                return [int(line[:width]), int(line[width : 2 * width])]
            return [int(line[k * width : (k + 1) * width]) for k in range(count)]
        except ValueError:
            words = line.split()
            if len(words) == count and all(w.lstrip(b"+-").isdigit() for w in words):
                return [int(w) for w in words]
            raise self.wrong(f"{what} is expected, not {_quoted(line)}") from None

    def fields(self, count: int, form: _Print) -> bytes:
        """Return the fields of some values one after another, each of its full width."""
        if count <= form.per_line:  # most strings of a sparse matrix
            self.at += 1
            width = count * form.width
            line = self._stream.readline()
            text = line[:width]
            if len(text) == width and text[-1] > 32:
                return text
            if not line:
                raise self._cut_short()
            return text.rstrip(b"\r\n").ljust(width)
        n_line = -(-count // form.per_line)
        lines = list(islice(self._stream, n_line))
        self.at += len(lines)
        if len(lines) < n_line:
            raise self._cut_short()
        full = form.per_line * form.width
        last = (count - (n_line - 1) * form.per_line) * form.width
        parts = [line.rstrip(b"\r\n")[:full].ljust(full) for line in lines[:-1]]
        return b"".join([*parts, lines[-1].rstrip(b"\r\n")[:last].ljust(last)])

    def _cut_short(self) -> InputError:
        return Place(self.path).fault("is cut short: it ends in the values of a matrix")


def _quoted(line: bytes) -> str:
    return repr(line[:60].decode("latin-1").strip())


def is_ascii_op4(head: bytes) -> bool:
    """Whether a file starts with the header of a formatted OP4 matrix."""
    return _header_fields(head.split(b"\n", 1)[0]) is not None


def _header_fields(line: bytes) -> tuple[list[int], bytes, int] | None:
    """Return NCOL, NROW, FORM, TYPE, then the rest of the line, and the width of an integer."""
    for width in (8, 16):
        fields = [line[k * width : (k + 1) * width].strip() for k in range(4)]
        rest = line[4 * width :]
        if all(f.lstrip(b"-").isdigit() for f in fields) and rest[:1].isalpha():
            return [int(f) for f in fields], rest, width
    return None


def read_ascii(path: Path, wanted: Names = None) -> Iterator[NastranMatrix | Header]:
    """Read the matrices of a formatted OP4 file in turn.

    Of those not `wanted` only the headers are given; the numbers are stepped over.

    Raises
    ------
    InputError
        A file that is cut short or damaged: the line.
    """
    with path.open("rb") as stream:
        lines = _Lines(path, stream)
        while lines.more():
            header, form = _header(lines)
            values = wanted is None or header.name in wanted
            complex_ = header.kind in (3, 4)
            dtype = np.complex128 if complex_ else np.float64
            most = lines.size // form.width if values else 0
            filler = Filler(header.shape, most, dtype)
            for strings, fields in _batches(lines, header, form):
                if not values:
                    continue
                numbers = _numbers(fields, form, lines)
                found = numbers.view(np.complex128) if complex_ else numbers
                try:
                    filler.add(strings, found)
                except ValueError:
                    raise lines.wrong(f"matrix {header.name} has too many values") from None
            if not values:
                yield header
                continue
            single = header.kind in (1, 3)
            yield NastranMatrix.of_file(header.name, filler.matrix(), header.form, single=single)


def _header(lines: _Lines) -> tuple[Header, _Print]:
    line = lines.next("a matrix")
    found = _header_fields(line)
    if found is None:
        raise lines.wrong(f"the header of a matrix is expected, not {_quoted(line)}")
    (ncol, nrow, form, kind), rest, width = found
    name = rest[:8].decode("latin-1").strip().upper()
    printed = _FORMAT.search(rest[8:].decode("latin-1"))
    if kind not in (1, 2, 3, 4) or ncol < 0:
        raise lines.wrong(f"matrix {name} has a type {kind} that is not known")
    per_line, columns = (int(printed[1]), int(printed[2])) if printed else (5, 16)
    if not per_line or not columns:
        raise lines.wrong(f"the number format of matrix {name} is not known")
    bigmat = nrow < 0 or nrow >= _BIGMAT_FROM
    return Header(name, (abs(nrow), ncol), form, kind, bigmat), _Print(per_line, columns, width)


def _batches(lines: _Lines, header: Header, form: _Print) -> Iterator[tuple[Strings, list[bytes]]]:
    """Yield some strings and their numbers as text."""
    per_value = 2 if header.kind in (3, 4) else 1
    runs = array("q")
    fields: list[bytes] = []
    size = 0
    for column, row, count in _runs(lines, header, form):
        runs.extend((column - 1, row - 1, count))
        number = count * per_value
        text = lines.fields(number, form)
        fields.append(text)
        size += len(text)
        if size > _BATCH:
            yield _strings(runs), fields
            runs, fields, size = array("q"), [], 0
    yield _strings(runs), fields


def _strings(runs: "array[int]") -> Strings:
    column, row, count = np.array(runs, np.int64).reshape(-1, 3).T
    return Strings(column, row, count, np.zeros_like(count))


def _runs(lines: _Lines, header: Header, form: _Print) -> Iterator[tuple[int, int, int]]:
    """Yield column, first row and number of values of each string; all from 1."""
    complex_ = 2 if header.kind in (3, 4) else 1
    words = complex_ * (2 if header.kind in (2, 4) else 1)
    last = 0

    def sound(column: int, row: int, count: int) -> tuple[int, int, int]:
        if count < 1 or row < 1 or row + count - 1 > header.shape[0]:
            raise lines.wrong(
                f"matrix {header.name} ({header.shape[0]} by {header.shape[1]}) has no {count} "
                f"values from row {row} of column {column} on"
            )
        return column, row, count

    while True:
        column, row, left = lines.integers(f"a column of {header.name}", 3, form.integer)
        if column > header.shape[1]:
            lines.fields(left, form)
            return
        if column <= last or row < 0 or left < 0:
            raise lines.wrong(f"column {column} of matrix {header.name} follows column {last}")
        last = column
        if row > 0:  # counted in numbers; in words of single precision by some programs
            room = (header.shape[0] - row + 1) * complex_
            yield sound(column, row, left // (complex_ if left <= room else words))
            continue
        while left > 0:
            if header.bigmat:
                length, row = lines.integers("a string of values", 2, form.integer)
                length, left = length - 1, left - 2
            else:
                (said,) = lines.integers("a string of values", 1, max(form.integer, 12))
                length, row, left = (said >> 16) - 1, said & 0xFFFF, left - 1
            if length % words:
                raise lines.wrong(f"a string of {length} words is no whole number of values")
            yield sound(column, row, length // words)
            left -= length


def _numbers(texts: list[bytes], form: _Print, lines: _Lines) -> Floats:
    """Read fields of one width."""
    fields = np.frombuffer(b"".join(texts).replace(b"D", b"E"), f"S{form.width}")
    try:
        return np.asarray(fields.astype(np.float64))
    except ValueError:
        pass
    try:
        return np.array([float(_NO_LETTER.sub(rb"E\1", f.strip())) for f in fields.tolist()])
    except ValueError:
        raise Place(lines.path).error(
            f"a number before line {lines.at + 1} cannot be read; write the matrix again in binary"
        ) from None
