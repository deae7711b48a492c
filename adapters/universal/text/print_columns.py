"""Print long blocks of numbers in columns by array arithmetic.

``%20.12E`` of a million numbers costs Python a quarter of a second; here the decimal digits of
all numbers are found at once: the exponent from the logarithm, the digits as an integer
``round(|x| * 10**k)``, then four digits at a time from a table of characters. Where the product
lies so close to the middle between two integers that its rounding error (one unit in the 16th
digit) could decide, and for three-digit exponents, the number is printed one by one. So the
result is the correctly rounded one that ``%E`` gives.
"""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from ....core.arrays import Floats, Ints

_LARGEST = 99  # three-digit exponents take another column: they are printed one by one
_POWERS = np.array([float(f"1e{k}") for k in range(-120, 121)])  # correctly rounded
_EPS = float(np.finfo(np.float64).eps)
_FOUR = np.frombuffer("".join(f"{k:04d}" for k in range(10_000)).encode(), "<u4")
_EXPONENT = np.frombuffer(
    "".join(f"E{k:+03d}" for k in range(-_LARGEST, _LARGEST + 1)).encode(), "<u4"
)
_LINES = 1 << 12


def print_lines(values: Floats, width: int, decimals: int, per_line: int) -> Iterator[bytes]:
    """Print numbers as ``%width.decimalsE``, `per_line` on a line; the last may be shorter.

    Parameters
    ----------
    values : (n,) float
        Finite numbers.
    width : int
        Columns of each number, at least decimals + 7.
    decimals : {5, 12}
        Digits after the point.
    """
    full = len(values) // per_line
    for start in range(0, full, _LINES):
        stop = min(start + _LINES, full)
        table = values[start * per_line : stop * per_line].reshape(-1, per_line)
        text = np.full((stop - start, per_line * width + 1), 32, np.uint8)
        text[:, -1] = 10
        for k in range(per_line):
            _column(text, k * width, np.ascontiguousarray(table[:, k]), width, decimals)
        yield text.tobytes()
    rest = values[full * per_line :].tolist()
    if rest:
        yield ("".join(f"{v:{width}.{decimals}E}" for v in rest) + "\n").encode("ascii")


def _column(
    text: npt.NDArray[np.uint8], at: int, values: Floats, width: int, decimals: int
) -> None:
    """Print `values` into the columns of `text` from `at` on, one a row."""
    size = np.abs(values)
    plain = (size < 10.0**_LARGEST) & ((size >= 10.0**-_LARGEST) | (size == 0.0))
    size = np.where(plain & (size > 0.0), size, 1.0)
    power = np.floor(np.log10(size)).astype(np.int64)
    scaled = _scaled(size, power, decimals)
    # Too close to the middle between two integers to call, or printed wider: one by one.
    apart = ~plain | _close(scaled)
    for limit, step in ((10.0 ** (decimals + 1) - 0.5, 1), (10.0**decimals - 0.05, -1)):
        wrong = np.flatnonzero(scaled >= limit if step > 0 else scaled < limit)
        power[wrong] += step
        scaled[wrong] = _scaled(size[wrong], power[wrong], decimals)
    mantissa = np.rint(scaled)
    apart |= _close(scaled) | (mantissa >= 10.0 ** (decimals + 1)) | (mantissa < 10.0**decimals)
    mantissa = mantissa.astype(np.int64)
    mantissa[values == 0.0] = 0
    last = at + width
    pitch = text.shape[1]

    def chars(column: int, kind: str) -> npt.NDArray[np.generic]:
        return np.ndarray((len(values),), kind, text, column, (pitch,))

    text[:, last - decimals - 7] = np.where(np.signbit(values), 45, 32)
    text[:, last - decimals - 5] = 46
    chars(last - 4, "<u4")[:] = _EXPONENT[power + _LARGEST]
    for column in range(last - 8, last - decimals - 5, -4):
        mantissa, four = np.divmod(mantissa, 10_000)
        chars(column, "<u4")[:] = _FOUR[four]
    if decimals % 4:
        mantissa, digit = np.divmod(mantissa, 10)
        text[:, last - decimals - 4] = digit + 48
    text[:, last - decimals - 6] = mantissa + 48
    for row in np.flatnonzero(apart):
        printed = f"{values[row]:{width}.{decimals}E}".encode("ascii")
        text[row, at:last] = np.frombuffer(printed, np.uint8)


def _close(scaled: Floats) -> npt.NDArray[np.bool_]:
    """Whether rounding errors could carry a number over the middle between two integers."""
    return np.asarray(np.abs(np.abs(scaled - np.rint(scaled)) - 0.5) <= 1.5 * _EPS * scaled)


def _scaled(size: Floats, power: Ints, decimals: int) -> Floats:
    """``size * 10**(decimals - power)``, its relative error at most one unit of rounding."""
    return np.asarray(size * _POWERS[decimals - power + 120])
