"""Variable projection: poles and participation by nonlinear least squares, shapes within."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Floats, Numbers
from .moments import (
    BandData,
    Normal,
    basis,
    normal,
    onto,
    paired,
    parts_of,
    reduced_normal,
    shape_normals,
)
from .pole_numbers import POLES


@dataclass(frozen=True, eq=False)
class Fit:
    """Poles, participation and shapes that explain a band.

    Parameters
    ----------
    poles : (n_mode,) complex
        rad/s.
    participation : (n_input, n_mode) complex
        Largest component 1, in the weighted inputs.
    shapes : (n_output, n_mode) complex
        In the weighted outputs.
    misfit : float
        Sum of squares left, of the weighted functions.
    iterations : int
    converged : bool
    """

    poles: Numbers
    participation: Numbers
    shapes: Numbers
    misfit: float
    iterations: int = 0
    converged: bool = True


def fit_shapes(data: BandData, poles: Numbers, participation: Numbers) -> Fit:
    """Least-squares shapes (and residual terms) at fixed poles and participation (LSFD)."""
    return _with_shapes(data, poles, participation)[0]


def refine(
    data: BandData,
    poles: Numbers,
    participation: Numbers,
    max_iterations: int = POLES.fit_steps,
) -> Fit:
    """Minimise the output error over poles and participation, the shapes being projected out.

    min over λ, l of Σ_oi ‖H_oi − (jω)² [Σ_k ψ_ok l_ik/(jω−λ_k) + conj. + LR_oi/(jω)² + UR_oi]‖²
    with ψ, LR, UR at their least-squares values for every λ, l. Gauss-Newton with the exact
    reduced (Schur complement) normal matrix and Levenberg-Marquardt damping; derivatives are
    analytic.

    Parameters
    ----------
    data : BandData
    poles : (n_mode,) complex
        Start values, rad/s.
    participation : (n_input, n_mode) complex
        Start values.
    max_iterations : int

    Returns
    -------
    Fit
        `converged` is False when the iterations ran out.

    References
    ----------
    Golub, Pereyra (1973), The differentiation of pseudo-inverses and nonlinear least squares
    problems whose variables separate, SIAM J. Numer. Anal. 10, 413-432.
    """
    fit, projections = _with_shapes(data, poles, participation)
    mu, count, converged = POLES.damping_first, 0, not len(poles)
    floor = POLES.misfit_least * data.power
    while count < max_iterations and not converged:
        count += 1
        columns = free_columns(fit.participation)
        S, gradient = _reduced_system(data, fit, projections)
        S, gradient = S[np.ix_(columns, columns)], gradient[columns]
        scale = np.sqrt(np.maximum(np.diag(S), 1e-300))
        S = S / np.outer(scale, scale)
        while True:
            step = np.zeros(2 * len(poles) * (1 + len(participation)))
            step[columns] = np.linalg.solve(S + mu * np.eye(len(S)), gradient / scale) / scale
            trial, of_trial = _moved(data, fit, step)
            if trial.misfit <= fit.misfit + floor or mu > POLES.damping_stuck:
                break
            mu *= POLES.damping_factor
        if mu > POLES.damping_stuck:
            converged = True
            break
        decrease = fit.misfit - trial.misfit
        converged = decrease <= POLES.converged * trial.misfit / data.y.size + floor
        fit, projections, mu = trial, of_trial, max(mu / POLES.damping_factor, POLES.damping_least)
    return Fit(fit.poles, fit.participation, fit.shapes, fit.misfit, count, bool(converged))


def free_columns(participation: Numbers) -> Numbers:
    """Positions in θ of what may move, the largest participation of each mode staying 1."""
    n_input, m = participation.shape
    pole, part = np.ones((m, 2), bool), np.ones((m, 2, n_input), bool)
    part[np.arange(m), :, np.argmax(np.abs(participation), axis=0)] = False
    return np.flatnonzero(np.concatenate([pole.ravel(), part.ravel()]))


def system_at(data: BandData, fit: Fit) -> tuple[Normal, Floats, Floats]:
    """Return normal matrices, F (2 n_line, 2, n_mode, 2) and F'F at a fit."""
    F = basis(data, fit.poles)
    G = _gram(F)
    return normal(G, fit.participation, fit.shapes, data.weight), F, G


def _reduced_system(data: BandData, fit: Fit, projections: Floats) -> tuple[Floats, Floats]:
    """Return the reduced normal matrix of θ and the steepest descent of half the misfit.

    Parameters
    ----------
    projections : (n_output, n_input, n_mode, 2) float
        Y'F of the values, see `_with_shapes`.
    """
    m = len(fit.poles)
    F = basis(data, fit.poles)
    G = _gram(F)
    S = reduced_normal(G, fit.participation, fit.shapes, data.patterns, solve_shapes)
    r = fit.shapes[:, None, :] * fit.participation[None, :, :]
    model = parts_of(r)
    slopes = onto(data.y, F[:, 1]) - onto(model, G[0, :, :, 1].reshape(2 * m, 2 * m))
    left = projections.reshape(model.shape) - onto(model, G[0, :, :, 0].reshape(2 * m, 2 * m))
    mask = data.weight[:, :, None]
    by_pole, by_value = paired(slopes.reshape(*r.shape, 2)), paired(left.reshape(*r.shape, 2))
    pole = np.einsum("oik,oik->k", r.conj(), by_pole * mask)
    part = np.einsum("ok,oik->ki", fit.shapes.conj(), by_value * mask)
    return S, np.concatenate([parts_of(pole), np.stack([part.real, part.imag], axis=1).ravel()])


def solve_shapes(N: Floats, right: Floats) -> Floats:
    """Solve normal equations of shapes.

    Parameters
    ----------
    N : (..., n, n) float
    right : (..., n, n_right) float

    Returns
    -------
    (..., n, n_right) float
        Scaled to unit diagonal and with a slight ridge, so that it exists where nothing speaks
        for a mode.
    """
    diagonal = np.diagonal(N, axis1=-2, axis2=-1)
    floor = POLES.shape_ridge * diagonal.max(initial=0.0) + 1e-300
    scale = 1.0 / np.sqrt(np.maximum(diagonal, floor))
    scaled = N * scale[..., :, None] * scale[..., None, :] + POLES.shape_ridge * np.eye(N.shape[-1])
    x = np.linalg.solve(scaled, right * scale[..., :, None])
    return np.asarray(x * scale[..., :, None])


def _gram(F: Floats) -> Floats:
    flat = F.reshape(len(F), -1)
    return np.asarray((flat.T @ flat).reshape(F.shape[1:] + F.shape[1:]))


def _with_shapes(data: BandData, poles: Numbers, participation: Numbers) -> tuple[Fit, Floats]:
    """Shapes and misfit at given poles and participation; and Y'F, (n_output, n_input, m, 2)."""
    m, (n_output, n_input) = len(poles), data.weight.shape
    if not m:
        none = Fit(poles, participation, np.zeros((n_output, 0), complex), data.power)
        return none, np.zeros((n_output, n_input, 0, 2))
    biggest = np.argmax(np.abs(participation), axis=0)
    participation = participation / participation[biggest, np.arange(m)]
    F = basis(data, poles, derivative=False)
    B = onto(data.y, F)
    per_input = shape_normals(_gram(F), participation)
    on_modes = paired(B.reshape(n_output, n_input, m, 2))
    x = np.empty((n_output, 2 * m))
    explained = 0.0
    for w, rows in data.patterns:
        b = parts_of(np.einsum("oik,ik->ok", on_modes[rows], w[:, None] * participation.conj()))
        N = np.tensordot(w, per_input, axes=1)
        x[rows] = solve_shapes(N, b.T).T
        explained += float(np.sum(x[rows] * (2.0 * b - x[rows] @ N)))
    shapes = paired(x.reshape(n_output, m, 2))
    fit = Fit(poles, participation, shapes, max(data.power - explained, 0.0))
    return fit, B.reshape(n_output, n_input, m, 2)


def _moved(data: BandData, fit: Fit, step: Floats) -> tuple[Fit, Floats]:
    """Apply a step of θ; decay rates move by factors, so no pole leaves the stable half plane."""
    m = len(fit.poles)
    pole = step[: 2 * m].reshape(m, 2)
    part = step[2 * m :].reshape(m, 2, -1)
    decay, omega = -fit.poles.real, fit.poles.imag
    reach = 2.0 * decay + POLES.frequency_step * omega
    decay = decay * np.exp(np.clip(-pole[:, 0] / decay, -POLES.decay_step, POLES.decay_step))
    omega = np.maximum(omega + np.clip(pole[:, 1], -reach, reach), 0.5 * omega)
    poles = -np.maximum(decay, POLES.ratio_least * omega) + 1j * omega
    return _with_shapes(data, poles, fit.participation + (part[:, 0] + 1j * part[:, 1]).T)
