"""Numbers as universal files print them.

Fortran programs glue fields together (``-1.0E-001-2.0E-001``), print D exponents and drop the
letter of a three-digit exponent (``1.0-114``), leave fields blank, or print stars where a number
did not fit. Whatever is not a number is an error here, never a zero.
"""

import re
from collections.abc import Iterable, Sequence
from contextlib import suppress
from itertools import accumulate, pairwise

import numpy as np

from ....core.arrays import Floats, Ints

_TO_E = bytes.maketrans(b"Dd", b"EE")
_NUMBER = rb"[+-]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][+-]?\d+|[+-]\d{2,3}(?![\d.]))?"
_ONE = re.compile(_NUMBER)
_GLUED = re.compile(_NUMBER + rb"(?:(?=[+-])" + _NUMBER + rb")*")
_LETTERLESS = re.compile(rb"(?<=[\d.])([+-]\d{2,3})$")


class NotANumber(Exception):
    """A field that holds no number; `row` is the 0-based line within the block."""

    def __init__(self, row: int, text: str) -> None:
        super().__init__(text)
        self.row = row
        self.text = text


def floats(lines: Sequence[bytes]) -> Floats:
    """All numbers of a block of lines, in order.

    Raises
    ------
    NotANumber
        A field that holds something else.
    """
    tokens = b" ".join(lines).split()
    try:
        return np.array(list(map(float, tokens)), np.float64)
    except ValueError:
        pass
    found: list[float] = []
    for row, line in enumerate(lines):
        for token in line.split():
            found.extend(_repaired(token, row))
    return np.array(found, np.float64)


def numbers_of(line: bytes, widths: Sequence[int], row: int = 0) -> list[float]:
    """Numbers of one line of fields, told apart by blanks, signs and letters, else by columns."""
    try:
        return _tokens(line, row)
    except NotANumber:
        return [value for f in _fields(line, widths) if f for value in _repaired(f, row)]


def table(lines: Sequence[bytes], widths: Sequence[int]) -> Floats:
    """Numbers of lines that all hold the same fields, (n_line, n_field).

    Fields are told apart by blanks where that gives the right number on every line, else by
    their columns; a field that is blank in its columns is an error.
    """
    n = len(widths)
    try:
        values = floats(lines)
        if len(values) == n * len(lines) and all(len(line.split()) == n for line in lines):
            return values.reshape(-1, n)
    except NotANumber:
        pass
    return np.array([_row(line, widths, row) for row, line in enumerate(lines)]).reshape(-1, n)


def integers(line: bytes) -> list[int]:
    """All integers of a line; stops at the first word that is none (vendors add comments).

    Words longer than ten digits are fields of ten columns that touch.
    """
    words = line.split()
    if any(len(word) > 10 and word.isdigit() for word in words):
        words = [line[k : k + 10] for k in range(0, len(line), 10)]
    found = []
    for token in words:
        try:
            found.append(int(token))
        except ValueError:
            break
    return found


def node_numbers(lines: Iterable[bytes]) -> Ints:
    """Return the integer that each line starts with, (n,)."""
    found = []
    for row, line in enumerate(lines):
        word = line.split(None, 1)[:1]
        try:
            found.append(int(word[0]))
        except (ValueError, IndexError):
            raise NotANumber(row, text(line)) from None
    return np.array(found, np.int64)


def text(line: bytes) -> str:
    """Return a line as text: UTF-8 if it is, else Latin-1."""
    try:
        return line.decode("utf-8").strip(" \t\x00")
    except UnicodeDecodeError:
        return line.decode("latin-1").strip(" \t\x00")


def _repaired(token: bytes, row: int) -> list[float]:
    try:
        return [float(token)]
    except ValueError:
        pass
    if not _GLUED.fullmatch(token):
        raise NotANumber(row, text(token))
    return [float(_LETTERLESS.sub(rb"E\1", part).translate(_TO_E)) for part in _ONE.findall(token)]


def _tokens(line: bytes, row: int) -> list[float]:
    try:
        return [float(token) for token in line.split()]
    except ValueError:
        return [value for token in line.split() for value in _repaired(token, row)]


def _fields(line: bytes, widths: Sequence[int]) -> list[bytes]:
    stops = list(accumulate(widths, initial=0))
    return [line[a:b].strip() for a, b in pairwise(stops)]


def _row(line: bytes, widths: Sequence[int], row: int) -> list[float]:
    with suppress(NotANumber):
        values = _tokens(line, row)
        if len(values) == len(widths):
            return values
    found = [_repaired(field, row) if field else [] for field in _fields(line, widths)]
    if any(len(numbers) != 1 for numbers in found):
        raise NotANumber(row, text(line))
    return [numbers[0] for numbers in found]
