"""Modal damping ratios, for the damping of equation (1c) of the source paper."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats
from ...errors import InputError
from ...reduction.damped_poles import ratio_slopes, ratios
from ..updating_numbers import UPDATING
from .declaration import DampedPairs, Residual, Seen, Slopes, Target


def _of(seen: Seen) -> tuple[DampedPairs, Floats]:
    """Return the damped pairs, and the ratios of the test, infinite where it says none."""
    pairs = seen.damped
    if pairs is None or pairs.measured is None or not np.any(pairs.measured > 0.0):
        raise InputError("the residual 'damping' needs damping ratios, and the test tells none")
    if not seen.model.damped:
        raise InputError(
            "the residual 'damping' needs a deck with damping: PARAM G, GE of materials or "
            "springs, dashpots, B2GG or SDAMPING"
        )
    return pairs, np.where(pairs.measured > 0.0, pairs.measured, np.inf)


def _value(seen: Seen) -> Floats:
    """(ζ_a − ζ_t)/ζ_t of each pair; 0 where the test says no ratio."""
    pairs, known = _of(seen)
    found = ratios(pairs.model.poles(pairs.turned))
    return np.asarray((found / known - np.isfinite(known))[:, None])


def _derivative(seen: Seen, slopes: Slopes) -> Floats:
    pairs, known = _of(seen)
    poles = pairs.model.poles(pairs.turned)
    moved = ratio_slopes(poles, pairs.model.slopes(pairs.turned, slopes.parameters))
    return np.asarray((moved / known[:, None])[:, None, :])


def _readings(seen: Seen) -> int:
    return int(np.isfinite(_of(seen)[1]).sum())


def _error(target: Target) -> Floats | None:
    if target.damping_std is None or target.damping is None:
        return None
    known = target.damping > 0.0
    return np.asarray(np.where(known, target.damping_std, 0.0) / np.where(known, target.damping, 1))


DAMPING = Residual(
    name="damping",
    weight="damping_sigma",
    sigma=UPDATING.damping,
    value=_value,
    derivative=_derivative,
    readings=_readings,
    unpaired=lambda _: 1.0,
    error=_error,
    damped=True,
)
"""Relative differences of damping ratios, those of complex modes of the analysis."""
