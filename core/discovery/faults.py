"""Sensors that do not read what they should, and what they should have read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats


@dataclass(frozen=True, eq=False)
class Fault:
    """A sensor that does not read what it should.

    Parameters
    ----------
    kind : str
        ``sensor_polarity``, ``sensor_gain``, ``sensor_swap``, ``sensor_axis`` or ``doubled``.
    sensors : tuple of int
        Rows concerned.
    reads : (n, n) float or None
        What these rows read of what they should; None where that cannot be undone.
    factor, deviation : float
        What is read over what should be, of a turned sensor the angle [deg]; its standard
        deviation.
    axis : tuple of float
        About which a sensor is turned, in the frame of the analysis.
    confidence : float
        Chance that this is what is wrong.
    """

    kind: str
    sensors: tuple[int, ...]
    reads: Floats | None
    factor: float
    deviation: float
    axis: tuple[float, ...]
    confidence: float


def corrected(shapes: Floats, faults: Sequence[Fault]) -> Floats:
    """Return the shapes as sound sensors would have read them.

    What cannot be known of a sensor that is turned away stays as it is; see `lost`.
    """
    out = np.array(shapes)
    for f in faults:
        if f.reads is not None:
            rows = list(f.sensors)
            out[rows] = np.linalg.solve(f.reads, out[rows])
    return out


def lost(faults: Sequence[Fault], n: int) -> Bools:
    """Return the sensors whose right readings cannot be had from what they read, (n,)."""
    out = np.zeros(n, bool)
    for f in faults:
        if f.reads is None:
            out[list(f.sensors)] = True
    return out
