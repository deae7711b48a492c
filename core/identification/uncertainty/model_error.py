"""What the fitted model is wrong by, besides the noise; it does not average out."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats, Numbers
from ..poles.moments import BandData, basis
from ..poles.significance import energy_by_line, memory_of_residual
from ..poles.variable_projection import Fit
from .uncertainty_numbers import UNCERTAINTY


def pole_errors(data: BandData, f: Floats, fit: Fit) -> tuple[Floats, Numbers]:
    """Covariances of Re λ, Im λ from what is wrong with the model rather than noisy.

    A window blurs functions over neighbouring lines. Where the residual shows that the model does
    not describe the lines around a narrow mode, its decay rate may be too large by about what a
    Hann window adds, σ²/(decay) with σ² the variance of its kernel. Whatever else a residual
    holds that is not noise, such as modes not found, moved the pole by about as much as a change
    of the pole would have to be to make that residual.

    Returns
    -------
    covariance : (n_mode, 2, 2) float
        (rad/s)².
    blurred : (n_mode,) bool
        Modes narrower than a few lines whose residual is not noise.
    """
    memory = memory_of_residual(data, f, fit)
    spacing = 2.0 * np.pi * float(np.median(np.diff(f)))
    decay = np.abs(fit.poles.real)
    wrong = memory.ratio > UNCERTAINTY.memory + UNCERTAINTY.sure * memory.scatter
    blurred = wrong & (2.0 * decay < UNCERTAINTY.many * spacing)
    blur = np.where(blurred, np.minimum(UNCERTAINTY.window * spacing**2 / decay, decay), 0.0)
    slope = energy_by_line(data, fit, basis(data, fit.poles)[:, 1])
    moved = memory.systematic / np.maximum(np.sum(slope * memory.near, axis=0), 1e-300)
    common = (UNCERTAINTY.chain * decay) ** 2 + np.where(wrong, np.minimum(moved, decay**2), 0.0)
    covariance = common[:, None, None] * np.eye(2)
    covariance[:, 0, 0] += blur**2
    return covariance, np.asarray(blurred)
