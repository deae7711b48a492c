"""Errors that functions of one response or of one reference have in common."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats
from ..poles.moments import BandData, onto, turned
from ..poles.significance import residual_lines
from ..poles.variable_projection import Fit
from .uncertainty_numbers import UNCERTAINTY


def widened(
    poles: Floats, data: BandData, fit: Fit, F: Floats, T: Floats, inverse: Floats
) -> Floats:
    """Widen covariances of poles where responses or references contradict each other.

    Noise does not explain that each reference, or response, asks for another frequency (mass of
    a shaker or a roving sensor, a temperature, leakage). The change of the poles that each
    response asks for gives the cluster-robust covariance; it replaces the given one where it is
    larger. References are few, so theirs counts only where it is much larger.

    Parameters
    ----------
    poles : (n_mode, 2, 2) float
        Covariances from the noise.
    F : (2 n_line, 2, n_mode, 2) float
    T : (n_output, 2 n_mode, n_theta) float
        Change of the shapes with θ (sign reversed).
    inverse : (n_theta, n_theta) float
        Of the reduced normal matrix.

    References
    ----------
    Liang, Zeger (1986), Longitudinal data analysis using generalized linear models, Biometrika
    73, 13-22.
    """
    m, (n_output, n_input) = len(fit.poles), data.weight.shape
    left = residual_lines(data, fit, F)
    E = onto(left, F).reshape(n_output, n_input, 2, m, 2)
    r = fit.shapes[:, None, :] * fit.participation[None, :, :]
    of_shapes = np.einsum("ikaf,oikf->oika", turned(fit.participation), E[:, :, 0])
    score = -np.einsum("oxt,oix->oit", T, of_shapes.reshape(n_output, n_input, -1), optimize=True)
    score[..., : 2 * m] += np.einsum("oikaf,oikf->oika", turned(r), E[:, :, 1]).reshape(
        n_output, n_input, -1
    )
    of_part = np.einsum("okaf,oikf->oika", turned(fit.shapes), E[:, :, 0])
    rest = score[..., 2 * m :].reshape(n_output, n_input, m, 2, n_input)
    for i in range(n_input):
        rest[:, i, :, :, i] += of_part[:, i]
    change = score @ inverse[:, : 2 * m]
    result = poles
    if n_output >= UNCERTAINTY.enough:
        result = _larger(result, change.sum(axis=1), m, 1.0)
    if n_input > 1:
        result = _larger(result, change.sum(axis=0), m, UNCERTAINTY.disagree)
    return result


def _larger(given: Floats, change: Floats, m: int, limit: float) -> Floats:
    """Scale the covariances to the variances of a sum of changes, (n, 2 m), where larger."""
    n = len(change)
    variance = (np.sum(change**2, axis=0) * n / (n - 1.0)).reshape(m, 2)
    old = np.diagonal(given, axis1=1, axis2=2)
    ratio = variance / np.maximum(old, 1e-300)
    scale = np.sqrt(np.where(ratio > limit, ratio, 1.0))
    return np.asarray(given * scale[:, :, None] * scale[:, None, :])
