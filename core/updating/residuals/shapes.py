"""The shape residual, equation (6) of the source paper."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats
from ..updating_numbers import UPDATING
from .declaration import Residual, Seen, Slopes


def _value(seen: Seen) -> Floats:
    """Part of each normalised analysis shape outside its test shape, whatever the test's scaling.

    Its squared length is 1 − MAC.
    """
    a, t = (s / np.linalg.norm(s, axis=0) for s in (seen.analysis, seen.test))
    return np.asarray((a - t * np.sum(t * a, axis=0)).T)


def _derivative(seen: Seen, slopes: Slopes) -> Floats:
    assert slopes.analysis is not None
    norm = np.linalg.norm(seen.analysis, axis=0)
    a, t = seen.analysis / norm, seen.test / np.linalg.norm(seen.test, axis=0)
    slope = slopes.analysis / norm[:, None]
    for unit in (a, t):
        slope = slope - unit[:, :, None] * np.einsum("sj,sjp->jp", unit, slope)[None]
    return np.asarray(slope.transpose(1, 0, 2))


def _size(seen: Seen) -> Floats:
    return np.array([1.0 - q.mac for q in seen.pairs])


SHAPES = Residual(
    name="shapes",
    weight="shape_sigma",
    sigma=UPDATING.shape,
    value=_value,
    derivative=_derivative,
    needs_shapes=True,
    size=_size,
    unpaired=lambda criteria: 1.0 - criteria.mac_min,
    error=lambda target: target.shape_std,
    tells_pairs=True,
)
"""What the test's shapes do not explain of the analysis'; σ is that of √(1 − MAC)."""
