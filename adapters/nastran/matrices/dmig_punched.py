"""Many DMIG columns in the form in which Nastran punches them, read by array arithmetic."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ....core.arrays import Bools, Ints, Numbers

_PART, _FIRST = 1 << 21, 1 << 12
_HEAD, _FIELD, _FIELDS = 8, 16, 4
_HEADER_CARD = re.compile(rb"(?m)^(DMIG    [^\n]{8} *0 [^\n]*\n)(?=DMIG\*)")
"""The card that begins a matrix, of a form of its own among its columns."""
_COLUMN, _ROW = b"DMIG*   ", b"*       "


def parts(path: Path) -> Iterator[tuple[int, bytes]]:
    """Yield a file in parts that end before a line that starts with DMIG, with their first line.

    Lines are numbered from 0 and end in LF.
    """
    number, kept = 0, b""
    with path.open("rb") as stream:
        while True:
            more = stream.read(_PART if number else _FIRST)
            kept += more
            cut = len(kept) if not more else kept.rfind(b"\nDMIG") + 1
            if cut:
                part, kept = kept[:cut], kept[cut:]
                part = part.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
                for piece in filter(None, _HEADER_CARD.split(part)):
                    yield number, piece
                    number += piece.count(b"\n")
            if not more:
                return


def punched_columns(
    part: bytes, complex_: dict[str, bool]
) -> dict[str, tuple[Ints, Ints, Numbers]] | None:
    """Read lines ``DMIG* NAME GJ CJ`` and ``* GI CI A [B]`` of sixteen columns a field.

    Parameters
    ----------
    part : bytes
        Whole cards, their lines ending in LF.
    complex_ : dict
        Whether the values of each matrix are complex; no others may occur.

    Returns
    -------
    dict or None
        Columns and rows as keys (8 * point + component) and values by matrix; None where any line
        is of another form.
    """
    raw = np.frombuffer(part, np.uint8)
    ends = np.flatnonzero(raw == 10)
    if not len(ends) or ends[-1] != len(raw) - 1:
        ends = np.append(ends, len(raw))
    starts = np.append(0, ends[:-1] + 1)
    if (raw == 9).any() or len(starts) == 0:
        return None
    block = _columns(raw, starts, ends, _HEAD + _FIELD * _FIELDS)
    heads = _text(block[:, :_HEAD])
    is_column, is_row = heads == _COLUMN, heads == _ROW
    if not (is_column | is_row).all() or not is_column[0]:
        return None
    try:
        fields = block[:, _HEAD:].reshape(len(block), _FIELDS, _FIELD)
        return _keys_and_values(fields, is_column, complex_)
    except ValueError:
        return None


def _keys_and_values(
    fields: Numbers, is_column: Bools, complex_: dict[str, bool]
) -> dict[str, tuple[Ints, Ints, Numbers]] | None:
    """Read fields (n_line, 4, 16) of characters."""
    heads, rows = fields[is_column], fields[~is_column]
    if (heads[:, 3] != 32).any():
        return None
    column_keys = 8 * _integers(heads[:, 1]) + _integers(heads[:, 2])
    if (column_keys < 8).any():
        return None
    names, which = np.unique(_text(heads[:, 0]), return_inverse=True)
    labels = [n.decode("latin-1").strip().upper() for n in names.tolist()]
    if any(label not in complex_ for label in labels) or len(set(labels)) < len(labels):
        return None
    of_row = np.cumsum(is_column)[~is_column] - 1
    row_keys = 8 * _integers(rows[:, 0]) + _integers(rows[:, 1])
    values = _reals(rows[:, 2])
    found = {}
    for k, label in enumerate(labels):
        mine: Bools | slice = which[of_row] == k if len(labels) > 1 else slice(None)
        numbers: Numbers = values[mine]
        if complex_[label]:
            numbers = numbers + 1j * _reals(rows[mine, 3])
        found[label] = (column_keys[of_row][mine], row_keys[mine], numbers)
    return found


def _columns(raw: Numbers, starts: Ints, ends: Ints, count: int) -> Numbers:
    """First columns of each line, blank past its end, (n_line, count)."""
    at = starts[:, None] + np.arange(count)
    inside = at < ends[:, None]
    return np.where(inside, raw[np.minimum(at, len(raw) - 1)], 32).astype(np.uint8)


def _text(chars: Numbers) -> Numbers:
    return np.ascontiguousarray(chars).view(f"S{chars.shape[1]}")[:, 0]


def _integers(chars: Numbers) -> Ints:
    """Read right- or left-adjusted whole numbers, (n, 16) characters; blank is zero."""
    digits = chars.astype(np.int64) - 48
    is_digit = (digits >= 0) & (digits <= 9)
    starts = np.count_nonzero(np.diff(is_digit.astype(np.int8), axis=1, prepend=0) == 1, axis=1)
    if not (is_digit | (chars == 32)).all() or (starts > 1).any():
        raise ValueError("no whole number")
    result = np.zeros(len(chars), np.int64)
    for column in range(chars.shape[1]):
        here = is_digit[:, column]
        result = np.where(here, 10 * result + digits[:, column], result)
    return result


def _reals(chars: Numbers) -> Numbers:
    """Read reals with E, D or no letter before the exponent, (n, 16) characters; blank is zero."""
    chars = np.where((chars == 68) | (chars == 100), 69, chars).astype(np.uint8)
    chars[(chars == 32).all(axis=1), 0] = 48
    sign = (chars == 43) | (chars == 45)
    before = np.zeros_like(chars)
    before[:, 1:] = chars[:, :-1]
    letterless = sign & (((before >= 48) & (before <= 57)) | (before == 46))
    if not letterless.any():
        return _text(chars).astype(np.float64)
    width = chars.shape[1]
    at = np.where(letterless.any(axis=1), np.argmax(letterless, axis=1), width + 1)[:, None]
    column = np.arange(width + 1)
    padded = np.pad(chars, ((0, 0), (0, 1)), constant_values=32)
    shifted = np.pad(chars, ((0, 0), (1, 0)), constant_values=32)
    wide = np.where(column < at, padded, np.where(column == at, 69, shifted)).astype(np.uint8)
    return _text(wide).astype(np.float64)
