"""How well a mode is what it is taken for."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats, Numbers
from .identification_numbers import IDENTIFICATION


def phase_collinearity(shapes: Numbers) -> Floats:
    """Modal phase collinearity of each column, 1 for a normal mode, 0 for one wholly complex.

    Parameters
    ----------
    shapes : (n_dof, n_mode) complex

    References
    ----------
    Pappa, Elliott, Schenk (1993), Consistent-mode indicator for the eigensystem realization
    algorithm, J. Guidance 16, 852-858.
    """
    xx = np.sum(shapes.real**2, axis=0)
    yy = np.sum(shapes.imag**2, axis=0)
    xy = np.sum(shapes.real * shapes.imag, axis=0)
    total = np.maximum(xx + yy, 1e-300)
    return np.asarray(((xx - yy) ** 2 + 4.0 * xy**2) / total**2)


def phase_deviation(shapes: Numbers) -> Floats:
    """Mean phase deviation of each column [degrees], weighted by magnitude; 0 for a normal mode.

    Parameters
    ----------
    shapes : (n_dof, n_mode) complex

    References
    ----------
    Heylen, Lammens, Sas (1997), Modal Analysis Theory and Testing, KU Leuven, section A.2.
    """
    straight = shapes * np.exp(-0.5j * np.angle(np.sum(shapes**2, axis=0)))
    size = np.abs(shapes)
    angle = np.arctan2(np.abs(straight.imag), np.maximum(np.abs(straight.real), 1e-300))
    return np.asarray(np.degrees((size * angle).sum(axis=0) / np.maximum(size.sum(axis=0), 1e-300)))


def multivariate_indicator(values: Numbers) -> Floats:
    """Multivariate mode indicator function; it dips towards 0 at a normal mode.

    Parameters
    ----------
    values : (n_output, n_input, n_line) complex
        Accelerations.

    Returns
    -------
    (n_line,) float
        Smallest eigenvalue of the in-phase energy over the total, 0..1.

    References
    ----------
    Williams, Crowley, Vold (1985), The multivariate mode indicator function in modal analysis,
    IMAC III.
    """
    lines = values.transpose(2, 0, 1)
    a = lines.real.transpose(0, 2, 1) @ lines.real
    b = a + lines.imag.transpose(0, 2, 1) @ lines.imag
    value, vector = np.linalg.eigh(b)
    excited = value > IDENTIFICATION.excited * value[:, -1:]
    root = np.where(excited, 1.0 / np.sqrt(np.where(excited, value, 1.0)), 0.0)
    turned = root[:, :, None] * vector.transpose(0, 2, 1)
    ratio = turned @ a @ turned.transpose(0, 2, 1)
    idle = np.eye(b.shape[1]) * ~excited[:, :, None]
    return np.asarray(np.clip(np.linalg.eigvalsh(ratio + idle)[:, 0], 0.0, 1.0))


def correlation(measured: Numbers, synthesised: Numbers) -> float:
    """Squared correlation |Σ H* Ĥ|² / (Σ|H|² Σ|Ĥ|²) of measured and synthesised functions."""
    cross = abs(np.vdot(measured, synthesised)) ** 2
    scale = float(np.sum(np.abs(measured) ** 2) * np.sum(np.abs(synthesised) ** 2))
    return float(cross / scale) if scale > 0.0 else 0.0
