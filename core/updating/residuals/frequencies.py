"""The eigenvalue residual, equation (5) of the source paper."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats
from ..updating_numbers import UPDATING
from .declaration import Residual, Seen, Slopes


def _value(seen: Seen) -> Floats:
    """(λ_a − λ_t)/(2 λ_t) of each pair: to first order the relative difference of frequency."""
    return (seen.eigenvalues / seen.test_eigenvalues - 1.0)[:, None] / 2.0


def _derivative(seen: Seen, slopes: Slopes) -> Floats:
    return (slopes.eigenvalues / seen.test_eigenvalues[:, None])[:, None, :] / 2.0


def _size(seen: Seen) -> Floats:
    """By the frequencies that are reported: of the modes, not of their combinations."""
    ratio = np.array([(q.analysis_hz / q.test_hz) ** 2 for q in seen.pairs])
    return ((ratio - 1.0) / 2.0) ** 2


FREQUENCIES = Residual(
    name="frequencies",
    weight="frequency_sigma",
    sigma=UPDATING.frequency,
    value=_value,
    derivative=_derivative,
    size=_size,
    unpaired=lambda criteria: criteria.frequency_tolerance**2,
    error=lambda target: target.frequency_std,
)
"""Relative differences of frequency; σ is that of a relative frequency."""
