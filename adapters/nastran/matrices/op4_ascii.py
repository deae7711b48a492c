"""Formatted OUTPUT4 files: dense, bigmat and nonbigmat, exponents with E, D or no letter."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....core.arrays import Floats, Ints
from ....core.errors import InputError
from .columns import Strings, assemble
from .content import SYMMETRIC, NastranMatrix, symmetrised
from .op4_binary import Header

_FORMAT = re.compile(r"(\d+)\s*[EDGF](\d+)\.\d+", re.IGNORECASE)
_NO_LETTER = re.compile(rb"(?<=[\d.])([+-]\d+)$")
_BIGMAT_FROM = 65536


@dataclass(frozen=True)
class _Print:
    """How numbers are printed: values a line, columns a value, columns a whole number."""

    per_line: int
    width: int
    integer: int


class _Lines:
    """The lines of a file, one after another."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.lines = path.read_bytes().replace(b"\r\n", b"\n").split(b"\n")
        while self.lines and not self.lines[-1].strip():
            self.lines.pop()
        self.at = 0

    def more(self) -> bool:
        return self.at < len(self.lines)

    def next(self, what: str) -> bytes:
        if not self.more():
            raise InputError(f"{self.path} is cut short: it ends where {what} is expected")
        self.at += 1
        return self.lines[self.at - 1]

    def wrong(self, why: str) -> InputError:
        return InputError(f"{self.path} line {self.at}: {why}")

    def integers(self, what: str, count: int, width: int) -> list[int]:
        line = self.next(what)
        try:
            return [int(line[k * width : (k + 1) * width]) for k in range(count)]
        except ValueError:
            words = line.split()
            if len(words) == count and all(w.lstrip(b"+-").isdigit() for w in words):
                return [int(w) for w in words]
            raise self.wrong(f"{what} is expected, not {_quoted(line)}") from None

    def skip(self, count: int, form: _Print) -> None:
        self.at += -(-count // form.per_line)
        if self.at > len(self.lines):
            raise InputError(f"{self.path} is cut short: it ends in the values of a matrix")

    def values(self, count: int, form: _Print) -> tuple[int, int]:
        """Step over the lines of some values; return their range of lines."""
        start = self.at
        self.skip(count, form)
        return start, self.at


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


def read_ascii(path: Path, values: bool = True) -> Iterator[NastranMatrix | Header]:
    """Read the matrices of a formatted OP4 file in turn.

    With `values` False only their headers are given; the numbers are stepped over.

    Raises
    ------
    InputError
        A file that is cut short or damaged: the line.
    """
    lines = _Lines(path)
    while lines.more():
        header, form = _header(lines)
        strings, ranges = _columns(lines, header, form)
        if not values:
            yield header
            continue
        per_value = 2 if header.kind in (3, 4) else 1
        numbers = _numbers(lines, ranges, strings.length * per_value, form)
        found = numbers.view(np.complex128) if per_value == 2 else numbers
        matrix = assemble(strings, found, header.shape)
        if header.form == SYMMETRIC and header.shape[0] == header.shape[1]:
            matrix = symmetrised(matrix)
        yield NastranMatrix(header.name, matrix, header.form, single=header.kind in (1, 3))


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


def _columns(lines: _Lines, header: Header, form: _Print) -> tuple[Strings, list[tuple[int, int]]]:
    complex_ = 2 if header.kind in (3, 4) else 1
    words = complex_ * (2 if header.kind in (2, 4) else 1)
    runs: list[tuple[int, int, int]] = []
    ranges: list[tuple[int, int]] = []

    def take(column: int, row: int, count: int) -> None:
        if count < 1 or row < 1 or row + count - 1 > header.shape[0]:
            raise lines.wrong(
                f"matrix {header.name} ({header.shape[0]} by {header.shape[1]}) has no {count} "
                f"values from row {row} of column {column} on"
            )
        runs.append((column - 1, row - 1, count))
        ranges.append(lines.values(count * complex_, form))

    while True:
        column, row, left = lines.integers(f"a column of {header.name}", 3, form.integer)
        if column > header.shape[1]:
            lines.skip(left, form)
            break
        if column <= (last := runs[-1][0] + 1 if runs else 0) or row < 0 or left < 0:
            raise lines.wrong(f"column {column} of matrix {header.name} follows column {last}")
        if row > 0:  # counted in numbers; in words of single precision by some programs
            room = (header.shape[0] - row + 1) * complex_
            take(column, row, left // (complex_ if left <= room else words))
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
            take(column, row, length // words)
            left -= length
    table = np.array(runs, np.int64).reshape(-1, 3)
    at = np.zeros(len(table), np.int64)
    return Strings(table[:, 0], table[:, 1], table[:, 2], at), ranges


def _numbers(lines: _Lines, ranges: list[tuple[int, int]], counts: Ints, form: _Print) -> Floats:
    """Read the numbers of some ranges of lines; each range ends in a line that may be short."""
    full = form.per_line * form.width
    parts: list[bytes] = []
    for (start, stop), count in zip(ranges, counts.tolist(), strict=True):
        last = (count - (stop - start - 1) * form.per_line) * form.width
        parts += [line[:full].ljust(full) for line in lines.lines[start : stop - 1]]
        parts.append(lines.lines[stop - 1][:last].ljust(last))
    fields = np.frombuffer(b"".join(parts).replace(b"D", b"E"), f"S{form.width}")
    try:
        return np.asarray(fields.astype(np.float64))
    except ValueError:
        pass
    try:
        return np.array([float(_NO_LETTER.sub(rb"E\1", f.strip())) for f in fields.tolist()])
    except ValueError:
        raise InputError(
            f"{lines.path}: a number between lines {ranges[0][0] + 1} and {ranges[-1][1]} cannot "
            "be read; write the matrix again in binary"
        ) from None
