"""Noise that all points share: one shape all over the band, where modes have one at their lines.

A resonance that a fit has not found stands at its own lines; what a running machine, the ground or
a common cable adds to all points at once, as one shape, stands at all of them.
"""

from __future__ import annotations

import numpy as np

from ...arrays import Bools, Floats, Numbers
from .moments import BandData, basis, unstacked
from .pole_numbers import POLES
from .significance import residual_lines, significance
from .variable_projection import Fit


def without_shared_noise(residual: Numbers) -> Numbers:
    """Take out of a residual (n_output, n_input, n_line), in place, what all points share."""
    shape = _shared_shape(residual)
    if shape.any():
        along = np.tensordot(shape.conj(), residual, axes=1)
        for function, part in zip(residual, shape, strict=True):
            function -= part * along
    return residual


def is_shared_noise(data: BandData, f: Floats, fit: Fit) -> Bools:
    """Tell which roots have the shape of the noise that all points share, (n_mode,) bool.

    Roots beyond doubt have not: noise that was found to be noise is weaker.
    """
    left = residual_lines(data, fit, basis(data, fit.poles, derivative=False))
    shape = _shared_shape(unstacked(left))
    along = np.abs(shape.conj() @ fit.shapes) ** 2
    alike = along > POLES.shared_shape * np.sum(np.abs(fit.shapes) ** 2, axis=0)
    if alike.any():
        alike &= significance(data, f, fit) < POLES.beyond_doubt
    return np.asarray(alike)


def _shared_shape(residual: Numbers) -> Numbers:
    """Return the strongest shape of a residual if it stands all over the band, otherwise nil."""
    n_output = len(residual)
    lines = residual.reshape(n_output, -1)
    power = sum(np.einsum("on,on->n", part, part) for part in (lines.real, lines.imag))
    shape = lines[:, int(np.argmax(power))]
    for _ in range(POLES.start_rounds):
        shape = lines @ (shape.conj() @ lines).conj()
        shape = shape / max(float(np.linalg.norm(shape)), 1e-300)
    energy = np.sum(np.abs((shape.conj() @ lines).reshape(residual.shape[1:])) ** 2, axis=0)
    spread = energy.sum() ** 2 / max(len(energy) * float(np.sum(energy**2)), 1e-300)
    few = n_output < POLES.responses_enough
    return np.zeros(n_output) if few or spread < POLES.shared_spread else shape
