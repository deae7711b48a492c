"""Variable projection: poles and participation by nonlinear least squares, shapes within."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, Numbers
from .moments import BandData, Normal, basis, normal, normal_shapes, turned

_RIDGE = 1e-12  # relative, on the normal matrices of the shapes
_STUCK = 1e8  # of the damping of the iteration: no step helps any more
_FACTOR = 1.5  # largest change of the logarithm of a decay rate in one step
_LEAST_DAMPING = 1e-6
_SMALL = 1e-9  # relative decrease of the misfit that ends the iteration


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


@dataclass(frozen=True, eq=False)
class _State:
    """A trial point with everything its step needs."""

    fit: Fit
    G: Floats
    B: Floats


def fit_shapes(data: BandData, poles: Numbers, participation: Numbers) -> Fit:
    """Least-squares shapes (and residual terms) at fixed poles and participation (LSFD)."""
    return _state(data, poles, participation).fit


def refine(
    data: BandData,
    poles: Numbers,
    participation: Numbers,
    free: Numbers | None = None,
    max_iterations: int = 40,
) -> Fit:
    """Minimise the output error over poles and participation, the shapes being projected out.

    min over λ, l of Σ_oi ‖H_oi − (jω)^d [Σ_k ψ_ok l_ik/(jω−λ_k) + conj. + LR_oi/(jω)² + UR_oi]‖²
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
    free : (n_mode,) bool, optional
        Modes whose pole and participation may move; the others' shapes are still fitted.
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
    moving = np.ones(len(poles), bool) if free is None else np.asarray(free)
    state = _state(data, poles, participation)
    mu, count, converged = 1e-4, 0, not moving.any()
    floor = 1e-14 * data.power
    while count < max_iterations and not converged:
        count += 1
        columns = free_columns(state.fit.participation, moving)
        S, gradient = reduced_system(data, state)
        S, gradient = S[np.ix_(columns, columns)], gradient[columns]
        scale = np.sqrt(np.maximum(np.diag(S), 1e-300))
        S = S / np.outer(scale, scale)
        while True:
            step = np.zeros(2 * len(poles) * (1 + len(participation)))
            step[columns] = np.linalg.solve(S + mu * np.eye(len(S)), gradient / scale) / scale
            trial = _moved(data, state.fit, step)
            if trial.fit.misfit <= state.fit.misfit + floor or mu > _STUCK:
                break
            mu *= 10.0
        if mu > _STUCK:
            converged = True
            break
        decrease = state.fit.misfit - trial.fit.misfit
        converged = decrease <= _SMALL * trial.fit.misfit + floor
        state, mu = trial, max(mu / 10.0, 1e-9)
    f = state.fit
    return Fit(f.poles, f.participation, f.shapes, f.misfit, count, bool(converged))


def free_columns(participation: Numbers, moving: Numbers) -> Numbers:
    """Positions in θ of what may move, the largest participation of each mode staying 1."""
    n_input, m = participation.shape
    pole = np.repeat(moving[:, None], 2, axis=1)
    part = np.repeat(np.repeat(moving[:, None, None], 2, axis=1), n_input, axis=2)
    part[np.arange(m), :, np.argmax(np.abs(participation), axis=0)] = False
    return np.flatnonzero(np.concatenate([pole.ravel(), part.ravel()]))


def system_at(data: BandData, fit: Fit) -> tuple[Normal, Floats, Floats]:
    """Return normal matrices, F (2 n_line, 2, n_mode, 2) and F'F at a fit."""
    F = basis(data, fit.poles)
    G = _gram(F)
    return normal(G, fit.participation, fit.shapes, data.weight), F, G


def reduced_system(data: BandData, state: _State) -> tuple[Floats, Floats]:
    """Return the reduced normal matrix of θ and the steepest descent of half the misfit."""
    f = state.fit
    n = normal(state.G, f.participation, f.shapes, data.weight)
    S = n.common_common - eliminated(n)
    r = f.shapes[:, None, :] * f.participation[None, :, :]
    coefficients = np.stack([r.real, r.imag], axis=-1)
    G = state.G[:, :, :, 0]
    left = state.B - np.einsum("gkfKF,oiKF->oigkf", G, coefficients, optimize=True)
    left *= data.weight[:, :, None, None, None]
    pole = np.einsum("oikaf,oikf->ka", turned(r), left[:, :, 1], optimize=True)
    part = np.einsum("okaf,oikf->kai", turned(f.shapes), left[:, :, 0], optimize=True)
    return S, np.concatenate([pole.ravel(), part.ravel()])


def eliminated(n: Normal) -> Floats:
    """Return Σ_o N_θψ N_ψψ⁻¹ N_ψθ, what the shapes take from the normal matrix of θ."""
    T = solve_shapes(n.shape_shape, n.shape_common)
    size = n.common_common.shape[0]
    return np.asarray(n.shape_common.reshape(-1, size).T @ T.reshape(-1, size))


def solve_shapes(N: Floats, right: Floats) -> Floats:
    """Solve the normal equations of the shapes, one system per output.

    Parameters
    ----------
    N : (n_output, n, n) float
    right : (n_output, n, n_right) float

    Returns
    -------
    (n_output, n, n_right) float
        Scaled to unit diagonal and with a slight ridge, so that it exists where nothing speaks
        for a mode.
    """
    diagonal = np.diagonal(N, axis1=1, axis2=2)
    floor = 1e-12 * diagonal.max(initial=0.0) + 1e-300
    scale = 1.0 / np.sqrt(np.maximum(diagonal, floor))
    scaled = N * scale[:, :, None] * scale[:, None, :] + _RIDGE * np.eye(N.shape[1])
    x = np.linalg.solve(scaled, right * scale[:, :, None])
    return np.asarray(x * scale[:, :, None])


def _gram(F: Floats) -> Floats:
    flat = F.reshape(len(F), -1)
    return np.asarray((flat.T @ flat).reshape(F.shape[1:] + F.shape[1:]))


def _state(data: BandData, poles: Numbers, participation: Numbers) -> _State:
    """Shapes and misfit at given poles and participation."""
    if not len(poles):
        none = Fit(poles, participation, np.zeros((len(data.y), 0), complex), data.power)
        return _State(none, np.zeros((2, 0, 2, 2, 0, 2)), np.zeros((*data.y.shape[:2], 2, 0, 2)))
    biggest = np.argmax(np.abs(participation), axis=0)
    participation = participation / participation[biggest, np.arange(len(poles))]
    F = basis(data, poles)
    G = _gram(F)
    B = (data.y @ F.reshape(len(F), -1)).reshape(data.y.shape[:2] + F.shape[1:])
    N = normal_shapes(G, participation, data.weight)
    weighted = B[:, :, 0] * data.weight[:, :, None, None]
    b = np.einsum("ikaf,oikf->oka", turned(participation), weighted, optimize=True)
    b = b.reshape(len(b), -1)
    x = solve_shapes(N, b[:, :, None])[:, :, 0]
    misfit = data.power - float(np.sum(x * (2.0 * b - np.einsum("oab,ob->oa", N, x))))
    pairs = x.reshape(len(x), -1, 2)
    shapes = pairs[..., 0] + 1j * pairs[..., 1]
    return _State(Fit(poles, participation, shapes, max(misfit, 0.0)), G, B)


def _moved(data: BandData, fit: Fit, step: Floats) -> _State:
    """Apply a step of θ; decay rates move by factors, so no pole leaves the stable half plane."""
    m = len(fit.poles)
    pole = step[: 2 * m].reshape(m, 2)
    part = step[2 * m :].reshape(m, 2, -1)
    decay, omega = -fit.poles.real, fit.poles.imag
    reach = 2.0 * decay + 1e-3 * omega
    decay = decay * np.exp(np.clip(-pole[:, 0] / decay, -_FACTOR, _FACTOR))
    omega = omega + np.clip(pole[:, 1], -reach, reach)
    poles = -np.maximum(decay, _LEAST_DAMPING * omega) + 1j * omega
    return _state(data, poles, fit.participation + (part[:, 0] + 1j * part[:, 1]).T)
