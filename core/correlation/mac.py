"""The modal assurance criterion and frequency deviations."""

import numpy as np

from ..arrays import Floats, Numbers
from ..errors import InputError


def mac(a: Numbers, b: Numbers) -> Floats:
    """Modal assurance criterion between the columns of two sets of shapes.

    Parameters
    ----------
    a : (n_sensor, n_a) float or complex
    b : (n_sensor, n_b) float or complex

    Returns
    -------
    (n_a, n_b) float
        |aᴴb|² / (aᴴa · bᴴb), 0 where a column is zero.

    Raises
    ------
    InputError
        When the two sets do not have the same sensors.

    References
    ----------
    Allemang, Brown (1982), A correlation coefficient for modal vector analysis; equation (7) of
    the source paper.
    """
    if a.ndim != 2 or b.ndim != 2 or len(a) != len(b):
        raise InputError(f"shapes of {a.shape} and {b.shape} are not at the same sensors")
    a, b = _unit_peak(a), _unit_peak(b)
    cross = np.abs(a.conj().T @ b) ** 2
    scale = np.outer(np.sum(np.abs(a) ** 2, axis=0), np.sum(np.abs(b) ** 2, axis=0))
    return np.asarray(np.divide(cross, scale, out=np.zeros_like(cross), where=scale > 0.0))


def _unit_peak(shapes: Numbers) -> Numbers:
    """Return columns of largest magnitude 1, whose squares cannot underflow; zero ones as are."""
    peak = np.max(np.abs(shapes), axis=0, initial=0.0)
    return np.asarray(shapes / np.where(peak > 0.0, peak, 1.0))


def deviation_percent(analysis_hz: Numbers, test_hz: Numbers) -> Floats:
    """Frequency deviation 100·(analysis − test)/test, broadcast."""
    return np.asarray(100.0 * (np.asarray(analysis_hz) - test_hz) / test_hz)


def principal(shapes: Numbers) -> Numbers:
    """Return complex columns (n_sensor, n_mode) turned to their principal phase, real as they are.

    The phase θ maximises |Re(φ e^{-iθ})|², i.e. θ = ½ arg Σ φ².
    """
    if not np.iscomplexobj(shapes):
        return np.asarray(shapes, dtype=float)
    phase = 0.5 * np.angle(np.sum(shapes**2, axis=0))
    return np.asarray(shapes * np.exp(-1j * phase))


def realised(shapes: Numbers) -> Floats:
    """Return shapes (n_sensor, n_mode) turned to their principal phase, real part kept."""
    return np.asarray(principal(shapes).real)
