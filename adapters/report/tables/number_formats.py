"""Numbers as an engineer writes them; a missing one is a dash."""

from __future__ import annotations

from collections.abc import Sequence

from .reading import number

MISSING = "–"


def fixed(value: object, digits: int) -> str:
    """Return the number with so many decimals; a dash when there is none."""
    v = number(value)
    return MISSING if v is None else f"{v:.{digits}f}".replace("-", "−")


def signed(value: object, digits: int) -> str:
    """Return the number with its sign; zero carries none."""
    v = number(value)
    if v is None:
        return MISSING
    text = f"{v:+.{digits}f}"
    return (text if float(text) else text[1:]).replace("-", "−")


def hz(value: object) -> str:
    """Return a frequency, two decimals where it is ordinary; a rigid-body mode's is 0.000."""
    v = number(value)
    if v is None:
        return MISSING
    size = abs(v)
    for least, digits in ((1000.0, 1), (1.0, 2), (0.1, 4), (0.001, 5)):
        if size >= least:
            return f"{v:.{digits}f}"
    return "0.000"


def percent(value: object, digits: int = 0) -> str:
    """Return a fraction 0..1 as a percentage without its sign."""
    v = number(value)
    return MISSING if v is None else fixed(100.0 * v, digits)


def general(value: object, digits: int = 4) -> str:
    """Return a value of unknown size with so many significant figures."""
    v = number(value)
    if v is None:
        return MISSING if value is None or isinstance(value, float) else str(value)
    text = f"{v:.{digits}g}"
    if "e" in text and 1.0 <= abs(v) < 1e6:
        text = f"{v:.0f}"
    if "e" in text:
        mantissa, exponent = text.split("e")
        text = f"{mantissa}e{int(exponent)}"
    return text.replace("-", "−")


def counted(count: int, noun: str, plural: str | None = None) -> str:
    """Return ``1 pair``, ``2 pairs``."""
    return f"{count} {noun if count == 1 else plural or noun + 's'}"


def listed(items: Sequence[object], most: int = 6) -> str:
    """Return ``a, b and c``; a long list is cut and says by how much."""
    words = [str(i) for i in items]
    if len(words) > most:
        words = [*words[: most - 1], f"{len(words) - most + 1} more"]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
