"""Reals as the bulk data writes them: within 8 or 16 columns, read back without loss."""

import math
import re

from ....core.errors import InputError

SMALL = 8
LARGE = 16

_REAL = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[EeDd]?([+-]\d+)|[EeDd](\d+))?", re.ASCII)


def parse_real(text: str) -> float:
    """Return a Nastran number: ``2.1+5``, ``2.1D5``, ``.3``, ``7.85E-9``, ``12``.

    Raises
    ------
    ValueError
        The text is no number.
    """
    try:
        value = float(text)
    except ValueError:
        match = _REAL.fullmatch(text.strip())
        if not match:
            raise ValueError(f"{text!r} is not a number") from None
        mantissa, signed, unsigned = match.groups()
        value = float(f"{mantissa}e{signed or unsigned or 0}")
    if not math.isfinite(value) or "_" in text:
        raise ValueError(f"{text!r} is not a number")
    return value


def format_exact(value: float, width: int) -> str | None:
    """Return the text that reads back as exactly `value`, or None where `width` is too narrow."""
    if not math.isfinite(value):
        raise InputError(f"{value} cannot be written to a deck: it is not a finite number")
    return _fitting(repr(float(value)), width)


def format_real(value: float, width: int = LARGE) -> str:
    """Return the text of at most `width` columns that reads back closest to `value`."""
    text = format_exact(value, width)
    digits = 16
    while text is None:
        text = _fitting(f"{value:.{digits - 1}e}", width)
        digits -= 1
    return text


def writable(value: float) -> float:
    """Return the value that a deck will hold for this one: the nearest of 16 columns.

    The relative difference is below 1e-12 for exponents of one digit and 1e-11 for two.
    """
    return parse_real(format_real(value, LARGE))


def justified(value: float, error: float) -> float:
    """Return a value with as many figures as its standard error justifies.

    That error has two figures then, and the value no more decimals than it (Guide to the expression
    of uncertainty in measurement, JCGM 100:2008, 7.2.6). An error that is not known says nothing.
    """
    if not (math.isfinite(error) and error > 0.0):
        return value
    return round(value, 1 - math.floor(math.log10(error))) or value


def format_field(value: float | int | str | None, width: int) -> str | None:
    """Return a field's text, or None where a real does not fit in `width` without loss.

    At 16 columns a real is rounded to the nearest that fits, which `writable` returns.

    Raises
    ------
    InputError
        Text or an integer longer than the field.
    """
    if value is None:
        return ""
    if isinstance(value, float):
        return format_real(value, width) if width >= LARGE else format_exact(value, width)
    text = str(value)
    if len(text) > SMALL:
        raise InputError(f"{text!r} is longer than the eight columns of a field")
    return text


def _fitting(text: str, width: int) -> str | None:
    """Write the digits of a Python float the first way that fits; None where none does."""
    mantissa, _, exponent = text.lstrip("-").partition("e")
    whole, _, fraction = mantissa.partition(".")
    digits = (whole + fraction).lstrip("0")
    point = len(digits) - len(fraction) + int(exponent or 0)
    digits = digits.rstrip("0")
    if not digits:
        return "0.0"
    sign = "-" if text.startswith("-") else ""
    plain = _plain(digits, point)
    powers = _powers(digits, point)
    forms = (*plain, *powers) if -2 <= point <= 9 else (*powers, *plain)
    return next((sign + f for f in forms if len(sign + f) <= width), None)


def _plain(digits: str, point: int) -> tuple[str, ...]:
    if abs(point) > LARGE:
        return ()
    if point <= 0:
        tail = "." + "0" * -point + digits
        return ("0" + tail, tail)
    if point >= len(digits):
        return (digits + "0" * (point - len(digits)) + ".",)
    return (digits[:point] + "." + digits[point:],)


def _powers(digits: str, point: int) -> tuple[str, ...]:
    head, exponent = f"{digits[0]}.{digits[1:]}", point - 1
    return (f"{digits[0]}.{digits[1:] or '0'}E{exponent:+d}", f"{head}{exponent:+d}")
