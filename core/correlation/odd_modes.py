"""Modes of a test that cannot be used as they are, in words."""

from __future__ import annotations

import numpy as np

from ..arrays import Ints
from ..data.modes import Modes
from ..errors import InputError


def said_of_odd(modes: Modes) -> tuple[str, ...]:
    """Say which modes are at rest, or zero at every sensor.

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
    found = (
        (hz == 0.0, ": the frequency is 0 Hz or blank in the file, so nothing can pair"),
        (~np.any(modes.shapes, axis=0), ": the shape is zero at every sensor, so nothing can pair"),
    )
    return tuple(
        f"test {_numbered(np.flatnonzero(which))}{why}" for which, why in found if which.any()
    )


def _numbered(rows: Ints) -> str:
    return f"mode{'s' if len(rows) > 1 else ''} {', '.join(str(k + 1) for k in rows)}"
