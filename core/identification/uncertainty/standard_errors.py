"""Standard errors of a fit, robust against noise that changes from line to line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.optimize

from ...arrays import Floats, Ints, Numbers
from ..poles.moments import BandData, Normal, normal, turned
from ..poles.significance import residual_lines
from ..poles.variable_projection import Fit, free_columns, solve_shapes, system_at
from .clustered_errors import widened
from .uncertainty_numbers import UNCERTAINTY


@dataclass(frozen=True, eq=False)
class Errors:
    """Covariances of a fit.

    Parameters
    ----------
    poles : (n_mode, 2, 2) float
        Of Re λ, Im λ, (rad/s)².
    participation : (n_input, n_mode) float
        Standard error of each value (real and imaginary part together); 0 for the one set to 1.
    shapes : (n_output, n_mode, 2, 2) float
        Of Re ψ, Im ψ, an error of the scale and phase common to a shape left out.
    """

    poles: Floats
    participation: Floats
    shapes: Floats


def errors(data: BandData, fit: Fit) -> Errors:
    """Return the covariances of poles, participation and shapes of a converged fit.

    The sandwich estimator S⁻¹ (Σ Jᵀ C J) S⁻¹, S the reduced normal matrix: C is taken from the
    residual, as a variance per function times a level per line (corrected for what the fit
    takes out of each line), with the correlation that neighbouring lines of the residual have.
    The poles' errors are widened where responses or references contradict each other.

    References
    ----------
    White (1980), A heteroskedasticity-consistent covariance matrix estimator, Econometrica 48,
    817-838. Newey, West (1987), Econometrica 55, 703-708.
    """
    m, n_input = len(fit.poles), data.weight.shape[1]
    n, F, _ = system_at(data, fit)
    T = solve_shapes(n.shape_shape, n.shape_common)
    size = T.shape[2]
    flat = T.reshape(-1, size)
    S = n.common_common - n.shape_common.reshape(-1, size).T @ flat
    columns = free_columns(fit.participation)
    noisy = _noisy(data, fit, n, F, len(columns))
    meat = noisy.common_common - flat.T @ noisy.shape_common.reshape(-1, size)
    meat -= noisy.shape_common.reshape(-1, size).T @ flat
    meat += flat.T @ (noisy.shape_shape @ T).reshape(-1, size)
    inverse = np.zeros((size, size))
    inverse[np.ix_(columns, columns)] = _inverse(S[np.ix_(columns, columns)])
    cov = inverse @ meat @ inverse
    poles = np.stack([cov[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] for k in range(m)])
    poles = widened(poles, data, fit, F, T, inverse)
    part = np.diag(cov)[2 * m :].reshape(m, 2, n_input).sum(axis=1).T
    shapes = _shape_errors(fit, n, noisy, T, inverse, cov)
    return Errors(poles, np.sqrt(np.maximum(part, 0.0)), shapes)


def _noisy(data: BandData, fit: Fit, n: Normal, F: Floats, n_theta: int) -> Normal:
    """Weight the normal matrices with the noise (Σ Jᵀ C J), the noise taken mode by mode.

    Around each mode the variance of a function times a level per line stands for C, so noise
    that follows the response (as most measured noise does) is met as well as an even one.
    """
    n_line = len(data.s)
    left = residual_lines(data, fit, F)
    free = 1.0 - np.minimum(_leverage(data, fit, n, F), 1.0 - UNCERTAINTY.least_left)
    free *= max(1.0 - n_theta / (data.weight.sum() * free.sum()), UNCERTAINTY.least_left)
    both = free[:n_line] + free[n_line:]
    level = _level(data, left, both)
    variances = [
        np.einsum("oin,oin,n->oi", r, r, 1.0 / np.concatenate([level[part]] * 2)) / both[part].sum()
        for part in _parts(fit, data)
        for r in [left[..., np.concatenate([part, part + n_line])]]
    ]
    rho = _correlation(left, np.sqrt(level), variances, _parts(fit, data))
    total: Normal | None = None
    for part, variance in zip(_parts(fit, data), variances, strict=True):
        here = np.zeros(n_line)
        here[part] = level[part]
        G = _weighted_gram(F, np.concatenate([here, here]), rho)
        one = normal(G, fit.participation, fit.shapes, variance)
        total = one if total is None else _sum(total, one)
    assert total is not None
    return total


def _sum(a: Normal, b: Normal) -> Normal:
    return Normal(
        a.shape_shape + b.shape_shape,
        a.shape_common + b.shape_common,
        a.common_common + b.common_common,
    )


def _parts(fit: Fit, data: BandData) -> list[Ints]:
    """Lines by the mode they lie nearest to, in half bandwidths."""
    omega = np.abs(data.s)
    distance = np.abs(omega[:, None] - fit.poles.imag) / np.abs(fit.poles.real)
    nearest = np.argmin(distance, axis=1)
    parts = [np.flatnonzero(nearest == k) for k in range(len(fit.poles))]
    return [p for p in parts if len(p)]


def _level(data: BandData, left: Floats, free: Floats) -> Floats:
    """Level of the noise at each line, (n_line,): even part, part that follows the response."""
    n_line = len(free)
    functions = data.weight.sum()

    def by_line(y: Floats) -> Floats:
        power = np.einsum("oin,oin,oi->n", y, y, data.weight) / functions
        return np.asarray(power[:n_line] + power[n_line:])

    residual, response = by_line(left), by_line(data.y - left)
    scale = max(float(residual.mean()), 1e-300)
    design = np.stack([free, free * response / max(float(response.mean()), 1e-300)], axis=1)
    typical = design.sum(axis=1, keepdims=True)
    coefficients, _ = scipy.optimize.nnls(design / typical, residual / scale / typical[:, 0])
    even, following = coefficients
    model = even + following * design[:, 1] / free + UNCERTAINTY.level_ridge
    ratio = residual / scale / free / model
    width = min(UNCERTAINTY.smoothed, n_line)
    window = np.ones(width)
    smooth = np.convolve(ratio, window, "same") / np.convolve(np.ones(n_line), window, "same")
    return np.asarray(scale * model * np.maximum(smooth, UNCERTAINTY.least_level))


def _leverage(data: BandData, fit: Fit, n: Normal, F: Floats) -> Floats:
    """Part of each line that residual terms and shapes take, on average, (2 n_line,)."""
    m = len(fit.poles)
    own = np.sum(data.residual_terms**2, axis=1)
    L = turned(fit.participation)
    typical = solve_shapes(
        n.shape_shape.mean(axis=0, keepdims=True), np.eye(2 * m)[None]
    )[0]  # fmt: skip
    share = data.weight.mean(axis=0)
    for i in range(len(L)):
        Phi = np.einsum("nkf,kaf->nka", F[:, 0], L[i]).reshape(len(F), 2 * m)
        own = own + share[i] / share.sum() * np.einsum("na,ab,nb->n", Phi, typical, Phi)
    return np.asarray(own)


def _correlation(left: Floats, level: Floats, variances: list[Floats], parts: list[Ints]) -> Floats:
    """Correlation of neighbouring lines of the residual, as long as it is positive."""
    n_line = len(level)
    white = left.reshape(*left.shape[:2], 2, n_line) / np.maximum(level, 1e-300)
    for part, variance in zip(parts, variances, strict=True):
        scale = np.sqrt(np.where(variance > 0.0, variance, np.inf))
        white[..., part] /= scale[:, :, None, None]
    power = max(float(np.sum(white**2)), 1e-300)
    rho = [1.0]
    for lag in range(1, min(UNCERTAINTY.lags, n_line // UNCERTAINTY.lags_share)):
        value = float(np.sum(white[..., lag:] * white[..., :-lag])) / power
        if value < max(UNCERTAINTY.noticed / np.sqrt(white.size), UNCERTAINTY.correlated):
            break
        rho.append(value)
    taper = 1.0 - np.arange(len(rho)) / (len(rho) + 1.0)
    return np.asarray(np.array(rho) * np.maximum(taper, 0.5))


def _weighted_gram(F: Floats, level: Floats, rho: Floats) -> Floats:
    """F' C F with C the level and correlation of the lines."""
    n_line = len(F) // 2
    scaled = (F.reshape(len(F), -1) * np.sqrt(level)[:, None]).reshape(2, n_line, -1)
    spread = rho[0] * scaled
    for lag in range(1, len(rho)):
        spread[:, lag:] += rho[lag] * scaled[:, :-lag]
        spread[:, :-lag] += rho[lag] * scaled[:, lag:]
    size = scaled.shape[2]
    G = scaled.reshape(-1, size).T @ spread.reshape(-1, size)
    return np.asarray((0.5 * (G + G.T)).reshape(F.shape[1:] + F.shape[1:]))


def _shape_errors(
    fit: Fit, n: Normal, noisy: Normal, T: Floats, inverse: Floats, cov: Floats
) -> Floats:
    m = len(fit.poles)
    n_output = len(fit.shapes)
    half = solve_shapes(n.shape_shape, noisy.shape_shape)
    own = solve_shapes(n.shape_shape, half.transpose(0, 2, 1))
    index = np.arange(m)
    result = own.reshape(n_output, m, 2, m, 2)[:, index, :, index, :].transpose(1, 0, 2, 3)
    # the part that comes through poles and participation, without the common complex scale
    t = T.reshape(n_output, m, 2, -1)
    z = t[:, :, 0] + 1j * t[:, :, 1]
    # which is that of the components that are known
    psi = fit.shapes
    weight = 1.0 / np.maximum(np.trace(result, axis1=2, axis2=3), 1e-300)
    share = weight * np.abs(psi) ** 2
    common = (
        np.einsum("ok,okt->kt", weight * psi.conj(), z)
        / np.maximum(np.sum(share, axis=0), 1e-300)[:, None]
    )
    z = z - psi[:, :, None] * common
    root = _root(cov)
    zr = z @ root
    parts = np.stack([zr.real, zr.imag], axis=2)
    return np.asarray(result + np.einsum("okat,okbt->okab", parts, parts))


def _inverse(S: Floats) -> Floats:
    """Inverse of a symmetric matrix, scaled; directions without information get a large one."""
    scale = 1.0 / np.sqrt(np.maximum(np.diag(S), 1e-300))
    value, vector = scipy.linalg.eigh(S * np.outer(scale, scale))
    value = np.maximum(value, UNCERTAINTY.least_curvature)
    return np.asarray((vector / value) @ vector.T * np.outer(scale, scale))


def _root(cov: Floats) -> Floats:
    scale = np.sqrt(np.maximum(np.diag(cov), 1e-300))
    value, vector = scipy.linalg.eigh(cov / np.outer(scale, scale))
    return np.asarray(scale[:, None] * vector * np.sqrt(np.maximum(value, 0.0)))


def frequency_and_damping_errors(poles: Numbers, covariance: Floats) -> tuple[Floats, Floats]:
    """Return standard errors of the undamped frequency [Hz] and of the damping ratio.

    Parameters
    ----------
    poles : (n_mode,) complex
    covariance : (n_mode, 2, 2) float
        Of Re λ, Im λ.
    """
    omega = np.abs(poles)
    d_omega = np.stack([poles.real, poles.imag], axis=1) / omega[:, None]
    d_zeta = poles.real[:, None] * d_omega / (omega**2)[:, None]
    d_zeta[:, 0] -= 1.0 / omega
    f = np.einsum("ka,kab,kb->k", d_omega, covariance, d_omega)
    z = np.einsum("ka,kab,kb->k", d_zeta, covariance, d_zeta)
    return np.sqrt(np.maximum(f, 0.0)) / (2.0 * np.pi), np.sqrt(np.maximum(z, 0.0))
