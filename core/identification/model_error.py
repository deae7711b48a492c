"""What the fitted model is wrong by, besides the noise; it does not average out."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats, Numbers
from .moments import BandData
from .refinement import Fit
from .significance import memory_of_residual

CHAIN = 1e-3
"""Relative error over the width of a mode that the best measuring chain has.

Of the decay rate for poles, of the largest component for shapes. Functions may be cleaner than
that (computed ones are); what is measured is not known better.
"""
_WINDOW = 1.0 / 3.0  # variance of a Hann window's kernel, squared lines: (1, 4, 1)/6
_MEMORY = 1.1  # of the residual, above which it is not the noise of single lines
_SURE = 3.0  # standard deviations beyond that
_MANY = 8.0  # lines across the half-power band, above which a window hardly matters


def pole_errors(data: BandData, f: Floats, fit: Fit) -> tuple[Floats, Numbers]:
    """Covariances of Re λ, Im λ from what is wrong with the model rather than noisy.

    A window blurs functions over neighbouring lines. Where the residual shows that the model does
    not describe the lines around a narrow mode, its decay rate may be too large by about what a
    Hann window adds, σ²/(decay) with σ² the variance of its kernel.

    Returns
    -------
    covariance : (n_mode, 2, 2) float
        (rad/s)².
    blurred : (n_mode,) bool
        Modes narrower than a few lines whose residual is not noise.
    """
    ratio, scatter = memory_of_residual(data, f, fit)
    spacing = 2.0 * np.pi * float(np.median(np.diff(f)))
    decay = np.abs(fit.poles.real)
    blurred = (ratio > _MEMORY + _SURE * scatter) & (2.0 * decay < _MANY * spacing)
    blur = np.where(blurred, np.minimum(_WINDOW * spacing**2 / decay, decay), 0.0)
    covariance = np.zeros((len(decay), 2, 2))
    covariance[:, 0, 0] = (CHAIN * decay) ** 2 + blur**2
    covariance[:, 1, 1] = (CHAIN * decay) ** 2
    return covariance, np.asarray(blurred)
