"""Complex shapes turned to their principal phase, and the real shapes closest to them."""

from __future__ import annotations

import numpy as np

from ...arrays import Bools, Floats, Numbers
from ...correlation.subspace_rotation import clusters_by_bandwidth
from .survey_numbers import SURVEY


def known_components(shapes: Numbers, covariance: Floats) -> Bools:
    """Tell which components of each shape are known: by themselves, or as well as its others.

    A sensor that was measured only with references which hardly drive a mode says nothing of it.

    Parameters
    ----------
    shapes : (n_output, n_mode) complex
    covariance : (n_output, n_mode, 2, 2) float
        Of real and imaginary parts, in a scale in which the sensors are alike.

    Returns
    -------
    (n_output, n_mode) bool
    """
    variance = np.trace(covariance, axis1=2, axis2=3)
    as_others = variance <= SURVEY.doubtful**2 * np.median(variance, axis=0)
    return np.asarray(as_others | (variance <= SURVEY.known**2 * np.abs(shapes) ** 2))


def turned_to_principal_phase(shapes: Numbers, known: Bools) -> Numbers:
    """Divide each column by the phase that makes what is known of it most real.

    The largest known component becomes positive.
    """
    phase = 0.5 * np.angle(np.sum(np.where(known, shapes, 0.0) ** 2, axis=0))
    turned = shapes * np.exp(-1j * phase)
    if len(turned):
        largest = np.argmax(np.abs(np.where(known, turned, 0.0)), axis=0)
        turned = turned * np.where(turned[largest, np.arange(turned.shape[1])].real < 0, -1, 1)
    return np.asarray(turned)


def real_shapes(frequencies_hz: Floats, shapes: Numbers, weight: Floats, known: Bools) -> Floats:
    """Real shapes of complex ones already turned to their principal phase.

    Modes that stand alone keep their real part. A close pair is a subspace: its complex shapes
    may be any mixture, even one whose real parts are parallel. Where that happens the real parts
    are replaced by the real basis of the subspace that lies closest to them.

    Parameters
    ----------
    frequencies_hz : (n_mode,) float
    shapes : (n_output, n_mode) complex
    weight : (n_output,) float
        One over the noise, for the subspace.
    known : (n_output, n_mode) bool
        Components that may say what is parallel.

    Returns
    -------
    (n_output, n_mode) float
    """
    real = np.array(shapes.real)
    for group in clusters_by_bandwidth(frequencies_hz, SURVEY.pair_width):
        columns = list(group)
        if len(columns) < 2 or len(shapes) <= len(columns):
            continue
        rows = known[:, columns].all(axis=1)
        if np.count_nonzero(rows) <= len(columns):
            continue
        Z = weight[:, None] * shapes[:, columns]
        size = np.linalg.norm(Z[rows], axis=0)
        parts = np.concatenate([(Z / size).real, (Z / size).imag], axis=1)
        _, sigma, v = np.linalg.svd(parts[rows], full_matrices=False)
        basis = parts @ (v[: len(columns)].T / sigma[: len(columns)])
        w, s, vt = np.linalg.svd(basis[rows].T @ parts[rows, : len(columns)])
        if s[-1] < SURVEY.parallel * s[0]:
            real[:, columns] = (basis @ (w @ vt)) * size / weight[:, None]
    return real
