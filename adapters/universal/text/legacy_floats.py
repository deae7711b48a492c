"""Floating-point numbers of 58b blocks: IEEE 754, and the DEC VAX and IBM/370 formats."""

import numpy as np
import numpy.typing as npt

from ....core.arrays import Floats

VAX, IEEE, IBM = 1, 2, 3


def decode(raw: npt.NDArray[np.uint8], big: bool, form: int) -> Floats:
    """Decode numbers of 4 or 8 bytes to binary64, (n,).

    Parameters
    ----------
    raw : (n, 4 or 8) uint8
        Bytes as in the file.
    big : bool
        Most significant byte first; VAX numbers have an order of their own.
    form : {1, 2, 3}
        VAX (F and D floating), IEEE 754, IBM System/370 hexadecimal.
    """
    width = raw.shape[1]
    if form == IEEE:
        numbers = np.ascontiguousarray(raw).view(f"{'>' if big else '<'}f{width}")[:, 0]
        with np.errstate(invalid="ignore"):  # a signalling NaN stays a NaN
            return numbers.astype(np.float64)
    if form == VAX:
        # 16-bit words, most significant word first, each least significant byte first.
        raw = raw.reshape(len(raw), -1, 2)[:, :, ::-1].reshape(len(raw), width)
    elif not big:
        raw = raw[:, ::-1]
    bits = np.ascontiguousarray(raw).view(f">u{width}")[:, 0].astype(np.uint64)
    return _vax(bits, 8 * width) if form == VAX else _ibm(bits, 8 * width)


def _vax(bits: npt.NDArray[np.uint64], size: int) -> Floats:
    """F or D floating: sign, 8-bit exponent excess 128, hidden bit, 0.1fff... mantissa."""
    fraction_bits = size - 9
    exponent = ((bits >> np.uint64(fraction_bits)) & np.uint64(255)).astype(np.int64)
    hidden = np.uint64(1 << fraction_bits)
    fraction = ((bits & (hidden - np.uint64(1))) | hidden).astype(np.float64)
    value = np.ldexp(fraction, exponent - 128 - fraction_bits - 1)
    return np.where(exponent == 0, 0.0, value) * _sign(bits, size)


def _ibm(bits: npt.NDArray[np.uint64], size: int) -> Floats:
    """Hexadecimal: sign, 7-bit exponent of 16 excess 64, 0.hhh... mantissa."""
    fraction_bits = size - 8
    exponent = ((bits >> np.uint64(fraction_bits)) & np.uint64(127)).astype(np.int64)
    fraction = (bits & np.uint64((1 << fraction_bits) - 1)).astype(np.float64)
    return np.ldexp(fraction, 4 * (exponent - 64) - fraction_bits) * _sign(bits, size)


def _sign(bits: npt.NDArray[np.uint64], size: int) -> Floats:
    return 1.0 - 2.0 * ((bits >> np.uint64(size - 1)) & np.uint64(1)).astype(np.float64)
