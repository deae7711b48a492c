"""Poly-reference least-squares complex frequency estimation of poles and participation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from ...arrays import Floats, Numbers
from .pole_numbers import POLES


@dataclass(frozen=True, eq=False)
class PoleSet:
    """Poles of one model order inside the band, upper half plane.

    Parameters
    ----------
    order : int
        Order of the denominator matrix polynomial.
    values : (n_pole,) complex
        Poles λ in rad/s; unstable ones (Re λ ≥ 0) included.
    participation : (n_pole, n_input) complex
        Unit vectors l of the residues ψ lᵀ.
    """

    order: int
    values: Numbers
    participation: Numbers


def poles_by_order(
    frequencies_hz: Floats, values: Numbers, orders: Sequence[int]
) -> tuple[PoleSet, ...]:
    """Estimate poles for each of several model orders.

    The right matrix-fraction model H(ω) = B(z) A(z)⁻¹ with z = exp(jπ(f − f₁)/(f₂ − f₁)), real
    coefficients and A₀ = I (which turns poles that only describe noise unstable) is fitted to
    the equation error H A − B by linear least squares, the numerators eliminated response by
    response. All orders share one set of numerators of the highest order, so one normal matrix
    serves them all.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
        Lines of the band, even or not.
    values : (n_output, n_input, n_line) complex
    orders : sequence of int

    Returns
    -------
    tuple of PoleSet
        In the sequence of `orders`.

    References
    ----------
    Guillaume, Verboven, Vanlanduit, Van der Auweraer, Peeters (2003), A poly-reference
    implementation of the least-squares complex frequency-domain estimator, IMAC XXI.
    Cauberghe, Guillaume, Verboven, Vanlanduit, Parloo (2005), On the influence of the parameter
    constraint on the stability of the poles and the discrimination capabilities of the
    stabilisation diagrams, MSSP 19, 989-1014.
    """
    n_input = values.shape[1]
    top = max(orders)
    M = _normal_matrix(frequencies_hz, values, top)
    n = n_input * top
    ridge = POLES.ridge * np.trace(M) / len(M) * np.eye(n)
    factor = np.linalg.cholesky(M[n_input:, n_input:] + ridge)
    return tuple(_poles(M, factor, q, n_input, frequencies_hz) for q in orders)


def _normal_matrix(f: Floats, values: Numbers, order: int) -> Floats:
    """Reduced normal matrix M = Σ_o T_o − S_oᵀ R⁻¹ S_o, (n_input (order+1), same)."""
    n_output, n_input, n_line = values.shape
    angle = np.pi * (f - f[0]) / (f[-1] - f[0])
    lags = np.arange(-order, order + 1)
    E = np.exp(1j * np.outer(angle, lags))
    r = E.sum(axis=0).real
    s = (values.reshape(-1, n_line) @ E).real.reshape(n_output, n_input, -1)
    by_line = np.ascontiguousarray(values.transpose(2, 0, 1))
    power = by_line.conj().transpose(0, 2, 1) @ by_line
    t = np.einsum("fij,fl->ijl", power, E).real
    step = np.arange(order + 1)
    lag = step[None, :] - step[:, None] + order
    size = n_input * (order + 1)
    T = t[:, :, lag].transpose(2, 0, 3, 1).reshape(size, size)
    S = s[:, :, lag].transpose(2, 0, 3, 1).reshape(order + 1, n_output * size)
    R = r[lag]
    factor = np.linalg.cholesky(R + POLES.ridge * R[0, 0] * np.eye(order + 1))
    Y = scipy.linalg.solve_triangular(factor, S, lower=True).reshape(-1, size)
    return np.asarray(T - Y.T @ Y)


def _poles(M: Floats, factor: Floats, q: int, n_input: int, f: Floats) -> PoleSet:
    n = n_input * q
    lower = factor[:n, :n]
    half = scipy.linalg.solve_triangular(lower, -M[n_input : n + n_input, :n_input], lower=True)
    A = scipy.linalg.solve_triangular(lower.T, half, lower=False).reshape(q, n_input, n_input)
    # A(z) = I + A_1 z + ... + A_q z^q; left null vectors w: companion matrix of Aᵀ in 1/z
    C = np.zeros((n, n))
    C[: n - n_input, n_input:] = np.eye(n - n_input)
    C[n - n_input :] = -A[::-1].transpose(2, 0, 1).reshape(n_input, n)
    inverse, vectors = np.linalg.eig(C)
    keep = (inverse.imag < 0.0) & (np.abs(inverse) > 0.0)
    z = 1.0 / inverse[keep]
    w = vectors[:n_input, keep].T
    per_second = 2.0 * (f[-1] - f[0])
    poles = np.log(z) * per_second + 2j * np.pi * f[0]
    w = w / np.linalg.norm(w, axis=1, keepdims=True)
    order = np.argsort(poles.imag, kind="stable")
    return PoleSet(q, poles[order], w[order])
