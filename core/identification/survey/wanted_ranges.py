"""The parts of the frequency axis that a user wants to use."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...errors import InputError


def wanted_ranges(
    fmin: float | None = None,
    fmax: float | None = None,
    bands: Sequence[tuple[float, float]] = (),
) -> tuple[tuple[float, float], ...]:
    """Return the parts of the bands between `fmin` and `fmax` [Hz], rising, overlaps joined.

    Without bands there is one part.

    Raises
    ------
    InputError
        A band, or the range, that is empty, reversed or below zero; a band outside of the range.
    """
    low = 0.0 if fmin is None else fmin
    high = np.inf if fmax is None else fmax
    if low >= high:
        raise InputError(f"the band asked for, {low:g} to {high:g} Hz, is empty")
    parts: list[tuple[float, float]] = []
    for a, b in sorted(bands) or [(low, high)]:
        if a < 0.0 or a >= b:
            why = "begins below 0 Hz" if a < 0.0 else "is empty" if a == b else "is reversed"
            raise InputError(f"the band {a:g}:{b:g} Hz {why}; give it from low to high")
        if a >= high or b <= low:
            limit = f"above fmax {high:g} Hz" if a >= high else f"below fmin {low:g} Hz"
            raise InputError(f"the band {a:g}:{b:g} Hz lies {limit}")
        a, b = max(a, low), min(b, high)
        if parts and a <= parts[-1][1]:
            parts[-1] = parts[-1][0], max(b, parts[-1][1])
        else:
            parts.append((a, b))
    return tuple(parts)


def named_ranges(ranges: Sequence[tuple[float, float]]) -> str:
    """Say ranges: "15 to 60 and 80 to 180 Hz"."""
    return f"{' and '.join(f'{a:.4g} to {b:.4g}' for a, b in ranges)} Hz"
