"""Long blocks of numbers in columns, read by array arithmetic instead of number by number.

A Fortran or C program prints every number of a block in the same layout, for example
`` -1.23456e-03``: sign, digit, point, digits, letter, sign, digits. Where a whole column of fields
keeps the layout of its first field, the digits become integers column by column, and
``mantissa / 10**k`` with both exact in binary64 is the correctly rounded value (D. Clinger, *How
to read floating point numbers accurately*, 1990). Fields in any other layout are read one by one.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ....core.arrays import Floats
from .number_fields import numbers_of

Read = Callable[[int, int], bytes]
Bytes = npt.NDArray[np.uint8]

_POWERS = 10.0 ** np.arange(23)
_ROWS = 1 << 13
_ODD_SHARE = 0.2


@dataclass(frozen=True)
class _Layout:
    """Where the parts of a number stand within its field."""

    point: int
    letter: int
    stop: int

    @staticmethod
    def of(field: bytes) -> "_Layout | None":
        """Return the layout of one field, None if it is not of the kind that repeats."""
        lower = field.lower().replace(b"d", b"e")
        point, letter = lower.find(b"."), lower.find(b"e")
        stop = len(field.rstrip())
        if not 1 <= point < letter <= stop - 3 or letter - point > 16 or stop - letter > 5:
            return None
        return _Layout(point, letter, stop)


def block(
    read: Read, begin: int, end: int, widths: Sequence[int], n_value: int
) -> tuple[Floats, int]:
    """Read `n_value` numbers printed in lines of fields of the given widths.

    Parameters
    ----------
    read : callable
        Gives the bytes of the file between two offsets.
    begin, end : int
        Offsets of the block.
    widths : sequence of int
        Columns of the fields on a full line.
    n_value : int
        How many numbers are wanted; the last line may hold more (padding).

    Returns
    -------
    values : (n,) float
        The numbers, fewer than `n_value` where the block holds fewer.
    surplus : int
        How many more numbers stand behind them.

    Raises
    ------
    NotANumber
        A field that holds something else.
    """
    values = np.empty(n_value)
    done, at, row = _fast(read, begin, end, widths, values)
    rest: list[float] = []
    for line in read(at, end).splitlines():
        rest += numbers_of(line, widths, row)
        row += 1
    take = min(len(rest), n_value - done)
    values[done : done + take] = rest[:take]
    return values[: done + take], len(rest) - take


def _fast(
    read: Read, begin: int, end: int, widths: Sequence[int], values: Floats
) -> tuple[int, int, int]:
    """Fill `values` from full lines of equal length; return (values, bytes, lines) consumed."""
    total, per_line = sum(widths), len(widths)
    first = read(begin, min(end, begin + total + 200))
    head = first.splitlines(keepends=True)[0] if first else b""
    pitch = len(head)
    if len(head.rstrip(b"\r\n")) < total or head[-1:] not in (b"\n", b"\r"):
        return 0, begin, 0
    n_line = min(len(values) // per_line, (end - begin) // pitch)
    for start in range(0, n_line, _ROWS):
        stop = min(start + _ROWS, n_line)
        chunk = read(begin + start * pitch, begin + stop * pitch)
        rows = np.frombuffer(chunk, np.uint8).reshape(-1, pitch)
        if np.any(rows[:, -1] != head[-1]) or np.any(rows[:, total:-1] > 32):
            return start * per_line, begin + start * pitch, start
        out = values[start * per_line : stop * per_line].reshape(-1, per_line)
        if not _lines(rows[:, :total], widths, out, start):
            return start * per_line, begin + start * pitch, start
    return n_line * per_line, begin + n_line * pitch, n_line


def _lines(rows: Bytes, widths: Sequence[int], out: Floats, first_row: int) -> bool:
    """Read lines of fields into `out`, (n_line, n_field); False when a layout does not hold."""
    n = len(widths)
    if len(set(widths)) == 1:
        return _column(rows.reshape(-1, widths[0]), out.reshape(-1), first_row, n)
    at = 0
    for j, width in enumerate(widths):
        column = np.empty(len(out))
        if not _column(rows[:, at : at + width], column, first_row, 1):
            return False
        out[:, j] = column
        at += width
    return True


def _column(field: Bytes, out: Floats, first_row: int, per_row: int) -> bool:
    """Read fields (n, width) into `out`, (n,); False when they do not share a layout."""
    layout = _Layout.of(field[0].tobytes())
    if layout is None:
        return False
    chars = np.ascontiguousarray(field.T)
    digits = chars - np.uint8(48)
    point, letter = layout.point, layout.letter
    lead, sign = chars[point - 1], chars[point - 2] if point > 1 else np.uint8(32)
    leading = digits[point - 1] < 10
    odd = chars[point] != 46
    odd |= ((chars[letter] | 32) - np.uint8(100)) > 1
    odd |= ~(leading | _is_sign(lead)) | ~_is_sign(sign) | (~leading & (sign != 32))
    if point > 2:
        odd |= np.any(chars[: point - 2] != 32, axis=0)
    if layout.stop < len(chars):
        odd |= np.any(chars[layout.stop :] != 32, axis=0)
    mantissa = np.where(leading, digits[point - 1], 0).astype(np.int64)
    for k in range(point + 1, letter):
        odd |= digits[k] > 9
        mantissa *= 10
        mantissa += digits[k]
    power = np.zeros(len(out), np.int64)
    for k in range(letter + 2, layout.stop):
        odd |= digits[k] > 9
        power *= 10
        power += digits[k]
    power_sign = chars[letter + 1]
    odd |= (power_sign != 43) & (power_sign != 45)
    np.negative(power, out=power, where=power_sign == 45)
    power -= letter - point - 1
    odd |= (np.abs(power) > 22) & (mantissa != 0)
    odd |= mantissa > 1 << 53
    if np.count_nonzero(odd) > _ODD_SHARE * len(odd):
        return False
    scale = _POWERS[np.minimum(np.abs(power), 22)]
    np.copyto(out, mantissa)
    np.divide(out, scale, out=out, where=power < 0)
    np.multiply(out, scale, out=out, where=power > 0)
    np.negative(out, out=out, where=(sign == 45) | (lead == 45))
    for row in np.flatnonzero(odd):
        found = numbers_of(field[row].tobytes(), (field.shape[1],), first_row + int(row) // per_row)
        if len(found) != 1:
            return False
        out[row] = found[0]
    return True


def _is_sign(chars: Bytes | np.uint8) -> npt.NDArray[np.bool_]:
    """Whether a character is a blank, + or -."""
    return np.asarray((chars == 32) | (chars == 45) | (chars == 43))
