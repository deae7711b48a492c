"""Errors that functions of one response or of one reference have in common."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats, Numbers
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
    larger. References are few, so theirs counts only where it is much larger. What responses that
    follow each other ask for together, and what all ask for by as much as they move, is added.

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
        of_output = change.sum(axis=1)
        result = _larger(result, of_output, m, 1.0)
        result = result + _of_runs(of_output, m) + _of_amplitude(of_output, fit.shapes)
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


def _of_runs(change: Floats, m: int) -> Floats:
    """Add what changes have in common that outputs measured after each other ask for.

    Runs of a survey, and temperature, change slowly in the order of the file.

    References
    ----------
    Newey, West (1987), Econometrica 55, 703-708.
    """
    n = len(change)
    reach = n // UNCERTAINTY.run
    own = np.zeros(change.shape[1])
    for lag in range(1, reach + 1):
        taper = 1.0 - lag / (reach + 1.0)
        own += 2.0 * taper * np.sum(change[lag:] * change[:-lag], axis=0)
    return np.asarray(np.maximum(own, 0.0).reshape(m, 2)[:, :, None] * np.eye(2))


def _of_amplitude(change: Floats, shapes: Numbers) -> Floats:
    """Add the square of what changes would be where the mode does not move, where that is clear.

    The mass of a roving sensor lowers a frequency by as much as the mode moves there, and a joint
    that slips by as much as it is driven: the mean over all outputs is off by that.
    """
    square = np.abs(shapes) ** 2
    total = np.zeros((shapes.shape[1], 2, 2))
    for k, a in enumerate(square.T):
        share = a / a.sum()
        terms = np.column_stack([np.ones(len(a)), a / a.mean()])
        inverse = np.linalg.pinv(terms.T @ (share[:, None] * terms))
        for part in range(2):
            own = change[:, 2 * k + part]
            value = inverse @ (terms.T @ own)
            left = own - share * (terms @ value)
            spread = inverse @ (terms.T * left**2 @ terms) @ inverse
            if abs(value[0]) > UNCERTAINTY.sure * np.sqrt(spread[0, 0]):
                total[k, part, part] = value[0] ** 2
    return total
