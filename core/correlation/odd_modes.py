"""Modes of a test that cannot be used as they are, in words."""

from __future__ import annotations

import numpy as np

from ..arrays import Bools, Ints
from ..data.modes import Modes
from ..errors import InputError

_ROUNDING = 1e-10
"""What the figures of a text file leave of equal numbers."""


def said_of_odd(modes: Modes) -> tuple[str, ...]:
    """Say which modes are at rest, zero at every sensor or a repetition of one before.

    Raises
    ------
    InputError
        A frequency that is none.
    """
    hz = modes.frequencies_hz
    wrong = np.flatnonzero(~np.isfinite(hz) | (hz < 0.0))
    if len(wrong):
        raise InputError(
            f"mode {wrong[0] + 1} of the test has a frequency of {hz[wrong[0]]:g} Hz; a frequency "
            "is zero or above: correct it in the test file"
        )
    zero = ~np.any(modes.shapes, axis=0)
    found = (
        (hz == 0.0, ": the frequency is 0 Hz or blank in the file, so nothing can pair"),
        (zero, ": the shape is zero at every sensor, so nothing can pair"),
        (
            repeated(modes) & ~zero,
            ": the same frequency and shape as of a mode before; a mode that is given twice "
            "weighs twice and one of the two stays without a partner: leave it out",
        ),
    )
    return tuple(
        f"test {_numbered(np.flatnonzero(which))}{why}" for which, why in found if which.any()
    )


def repeated(modes: Modes) -> Bools:
    """Return which modes are equal, but for rounding and scale, to one before, (n_mode,)."""
    length = np.linalg.norm(modes.shapes, axis=0)
    unit = modes.shapes / np.where(length > 0.0, length, 1.0)
    alike = np.isclose(np.abs(unit.conj().T @ unit), 1.0, rtol=0.0, atol=_ROUNDING)
    hz = modes.frequencies_hz
    same = np.isclose(hz[:, None], hz, rtol=_ROUNDING, atol=0.0)
    return np.asarray(np.tril(alike & same, -1).any(axis=1))


def _numbered(rows: Ints) -> str:
    return f"mode{'s' if len(rows) > 1 else ''} {', '.join(str(k + 1) for k in rows)}"
