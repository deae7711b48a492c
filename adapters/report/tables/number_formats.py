"""Numbers as an engineer writes them; a missing one (None or not finite) is a dash."""

import math
from collections.abc import Iterable, Sequence

MISSING = "–"


def _known(value: float | None) -> bool:
    return value is not None and math.isfinite(value)


def fixed(value: float | None, digits: int) -> str:
    """Return the number with so many decimals."""
    return f"{value:.{digits}f}".replace("-", "−") if _known(value) else MISSING


def signed(value: float | None, digits: int) -> str:
    """Return the number with its sign; zero carries none."""
    if not _known(value):
        return MISSING
    text = f"{value:+.{digits}f}"
    return (text if float(text) else text[1:]).replace("-", "−")


def hz(value: float | None) -> str:
    """Return a frequency, two decimals where it is ordinary; a rigid-body mode's is 0.000."""
    if value is None or not math.isfinite(value):
        return MISSING
    size = abs(value)
    for least, digits in ((1000.0, 1), (1.0, 2), (0.1, 4), (0.001, 5)):
        if size >= least:
            return f"{value:.{digits}f}"
    return "0.000"


def percent(value: float | None, digits: int = 0) -> str:
    """Return a fraction 0..1 as a percentage without its sign."""
    return MISSING if value is None else fixed(100.0 * value, digits)


def general(value: float | None, digits: int = 4) -> str:
    """Return a value of unknown size with so many significant figures."""
    if value is None or not math.isfinite(value):
        return MISSING
    text = f"{value:.{digits}g}"
    if "e" in text and 1.0 <= abs(value) < 1e6:
        text = f"{value:.0f}"
    if "e" in text:
        mantissa, exponent = text.split("e")
        text = f"{mantissa}e{int(exponent)}"
    return text.replace("-", "−")


def weighed(mass: float, kilograms: float | None) -> str:
    """Return a mass in kilograms, or as the deck has it where its unit is not known."""
    if kilograms is None:
        return f"{general(mass, 5)} (deck units)"
    return f"{general(kilograms, 5)} kg"


def placed(xyz: Iterable[float], unit: str | None) -> str:
    """Return coordinates with their unit; `None` are deck units."""
    size = max(map(abs, xyz := list(xyz)), default=0.0)
    return ", ".join(general(0.0 if abs(v) < 1e-6 * size else float(v), 4) for v in xyz) + (
        f" {unit}" if unit else " (deck units)"
    )


def counted(count: int, noun: str, plural: str | None = None) -> str:
    """Return ``1 pair``, ``2 pairs``."""
    return f"{count} {noun if count == 1 else plural or noun + 's'}"


def few(words: Sequence[str], most: int = 4) -> str:
    """Return ``a, b, c``; of many the first two, the last and how many they are."""
    if len(words) > most:
        return f"{words[0]}, {words[1]}, … {words[-1]} ({len(words)})"
    return ", ".join(words)


def listed(items: Sequence[object], most: int = 6) -> str:
    """Return ``a, b and c``; a long list is cut and says by how much."""
    words = [str(i) for i in items]
    if len(words) > most:
        words = [*words[: most - 1], f"{len(words) - most + 1} more"]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
