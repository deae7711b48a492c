"""Frequency responses from modal parameters."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats, Numbers
from ...data.frfs import QUANTITIES
from ...errors import InputError


def derivative_order(quantity: str) -> int:
    """Return how often displacement is differentiated by time to give `quantity` (0, 1, 2).

    Raises
    ------
    InputError
        A quantity that is not displacement, velocity or acceleration.
    """
    if quantity not in QUANTITIES:
        raise InputError(
            f"the response quantity is {quantity!r}; it must be one of {', '.join(QUANTITIES)}"
        )
    return QUANTITIES.index(quantity)


def poles_from(frequencies_hz: Floats, damping: Floats) -> Numbers:
    """Return the poles λ = −ζω + jω√(1−ζ²) [rad/s] of undamped frequencies and damping ratios."""
    omega = 2.0 * np.pi * np.asarray(frequencies_hz, dtype=float)
    zeta = np.asarray(damping, dtype=float)
    return np.asarray(omega * (-zeta + 1j * np.sqrt(1.0 - zeta**2)))


def modal_response(
    frequencies_hz: Floats,
    poles: Numbers,
    shapes: Numbers,
    participation: Numbers,
    quantity: str = "acceleration",
) -> Numbers:
    """Sum of modal contributions, without residual terms.

    H(ω) = (jω)^d Σ_k [ψ_k l_kᵀ / (jω − λ_k) + conj(ψ_k l_kᵀ) / (jω − λ_k*)], with d = 0, 1, 2 for
    displacement, velocity, acceleration.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    poles : (n_mode,) complex
        In rad/s, upper half plane.
    shapes : (n_response, n_mode) complex
    participation : (n_reference, n_mode) complex
        Displacement per unit force when multiplied with the shapes.
    quantity : {"displacement", "velocity", "acceleration"}

    Returns
    -------
    (n_response, n_reference, n_line) complex

    References
    ----------
    Ewins (2000), Modal Testing, 2nd edition, section 2.7.
    """
    s = 2j * np.pi * np.asarray(frequencies_hz, dtype=float)
    d = derivative_order(quantity)
    near = s**d / (s - poles[:, None])
    far = s**d / (s - poles.conj()[:, None])
    n_function = len(shapes) * len(participation)
    residues = (shapes[:, None, :] * participation[None, :, :]).reshape(n_function, len(poles))
    by_part = np.concatenate([near + far, 1j * (near - far)])  # of its real and imaginary part
    values = np.hstack([residues.real, residues.imag]) @ by_part.view(float)
    return np.asarray(values.view(complex).reshape(len(shapes), len(participation), len(s)))
