"""What a dashpot does to measured modes.

A dashpot of damping c along u adds c·uuᵀ to D. In coordinates of the undamped modes (unit modal
mass) the motion is q'' + D q' + Ω² q = 0. To first order in c the ratio of mode j grows by
c u_j² / (2 ω_j) and its shape turns complex: −i ω_j c u_j Σ_k φ_k u_k / (ω_k² − ω_j²) is added to
φ_j. Exactly, poles and shapes are those of the quadratic eigenproblem.

References
----------
Adhikari (2013), Structural Dynamic Analysis with Generalized Damping Models, section 2.4;
Tisseur, Meerbergen (2001), The quadratic eigenvalue problem, SIAM Review 43, 235-286.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import linear_sum_assignment

from ...arrays import Floats, Ints, Numbers
from .likelihood_numbers import LIKELIHOOD
from .mode_likelihood import Evidence, matched, mixing, mode_costs, targets


@dataclass(frozen=True, eq=False)
class Oriented:
    """A model with the measured modes as its coordinates.

    Parameters
    ----------
    omega : (n,) float
        rad/s; the first `count` are those of the test, in its order.
    turn : (n_model, n) float
        Columns are coordinates on the eigenvectors of the model, orthonormal.
    count : int
    above : (n_above,) int
        Modes of the model that lie too high to count.
    """

    omega: Floats
    turn: Floats
    count: int
    above: Ints = field(default_factory=lambda: np.zeros(0, np.int64))


def oriented(e: Evidence, eigenvalues: Floats, sensors: Floats, columns: int) -> Oriented:
    """Turn the modes of a model onto those of the test.

    Each measured shape is a combination of its partner and of the modes close to that in
    frequency (ridge regression, prior variance `mixing`), so that close modes lie as the test
    found them; further modes stay as they are. `sensors` (n_sensor, n_model) are shapes of unit
    modal mass, of which the first `columns` may match.
    """
    n = min(columns, len(eigenvalues))
    S = sensors[:, :n]
    _, match = matched(mode_costs(e, eigenvalues[:n], e.shapes.T @ S, S.T @ S))
    near = mixing(eigenvalues, LIKELIHOOD.mixing)
    own = np.stack([_combined(e, j, sensors, near[k], int(k)) for j, k in enumerate(match)], axis=1)
    top = (LIKELIHOOD.above * float(targets(e).max()) ** 0.5) ** 2
    rest = np.setdiff1d(np.flatnonzero(eigenvalues < top), match)
    B = np.hstack([own, np.eye(len(eigenvalues))[:, rest]])
    U, _, Vt = np.linalg.svd(B, full_matrices=False)
    own_omega = np.sqrt(np.maximum(eigenvalues[rest], 0.0))
    omega = np.concatenate([2.0 * np.pi * e.frequencies_hz, own_omega])
    above = np.setdiff1d(np.flatnonzero(eigenvalues >= top), match)
    return Oriented(omega, U @ Vt, len(match), above)


def _combined(e: Evidence, j: int, sensors: Floats, prior: Floats, partner: int) -> Floats:
    """Coordinates of one measured shape on the modes of the model, of unit length."""
    a, t = sensors[:, partner], e.shapes[:, j]
    size = float(np.linalg.norm(a))
    target = t * size * (-1.0 if t @ a < 0.0 else 1.0)
    shape = float(np.broadcast_to(e.noise.shape, e.shapes.shape[1])[j])
    noise = (shape * size) ** 2 / min(float(len(t)), e.noise.independent)
    C = (sensors * prior) @ sensors.T + (noise + np.finfo(float).tiny) * np.eye(len(t))
    q = prior * (sensors.T @ np.linalg.solve(C, target))
    length = float(np.linalg.norm(q))
    return q / length if length > 0.0 else np.eye(len(prior))[partner]


def added(u: Floats, omega: Floats) -> Floats:
    """Return what a dashpot of unit damping adds to each ratio, first order, shaped as `u`."""
    return np.asarray(u**2 / (2.0 * omega))


def complex_modes(omega: Floats, D: Floats) -> tuple[Numbers, Numbers]:
    """Return poles with Im > 0 and complex modes of s² + s D + diag(ω²), each near one mode.

    Of frequencies `omega` (n,) [rad/s] and damping D (n, n) on unit modal masses. Pole number k
    (n,) is that of the complex mode that undamped mode k takes the largest part in, one to one; NaN
    where so many are overdamped that none is left. Columns of the shapes (n, n) are on the undamped
    modes, component k of column k equal to 1.
    """
    n = len(omega)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.diag(omega**2), -D]])
    values, vectors = np.linalg.eig(A)
    up = np.flatnonzero(values.imag > 0.0)
    Q = vectors[:n, up]
    share = np.abs(Q) ** 2
    share = share / np.maximum(share.sum(axis=0), np.finfo(float).tiny)
    own, taken = linear_sum_assignment(-share)
    poles, shapes = np.full(n, np.nan, complex), np.full((n, n), np.nan, complex)
    poles[own] = values[up[taken]]
    pivot = Q[own, taken]
    pivot = np.where(np.abs(pivot) > 0.0, pivot, 1.0)
    shapes[:, own] = Q[:, taken] / pivot
    return poles, shapes


def ratios(poles: Numbers) -> Floats:
    """Return the damping ratios −Re λ / |λ| of poles."""
    return np.asarray(-poles.real / np.abs(poles))


def predicted(omega: Floats, D: Floats, level: Floats) -> Floats:
    """Return the damping ratios of modes with a `level` of their own and dashpots between them.

    Frequencies `omega` (n,) [rad/s] of rigid-body modes may be 0, their ratio is NaN; the
    dashpots D (n, n) are on unit modal masses.
    """
    elastic = np.flatnonzero(omega > LIKELIHOOD.elastic * omega.max())
    own = D[np.ix_(elastic, elastic)] + np.diag(2.0 * level[elastic] * omega[elastic])
    out = np.full(len(omega), np.nan)
    out[elastic] = ratios(complex_modes(omega[elastic], own)[0])
    return out


def of_pairs(
    eigenvalues: Floats, D: Floats, level: Floats, pairs: Sequence[tuple[int, int]]
) -> dict[int, float]:
    """Return the damping ratios that a model foretells for the test modes that have a partner.

    By its `eigenvalues` (n,) [(rad/s)²], dashpots D (n, n) on unit modal masses, the `level`
    (n_test,) of the test modes without dashpots, and pairs of test mode and analysis mode.
    """
    own = np.full(len(eigenvalues), float(np.exp(np.mean(np.log(level)))))
    for test, analysis in pairs:
        own[analysis] = level[test]
    out = predicted(np.sqrt(np.maximum(eigenvalues, 0.0)), D, own)
    return {test: float(out[analysis]) for test, analysis in pairs if np.isfinite(out[analysis])}


def imaginary(u: Floats, modes: Oriented, sensors: Floats) -> tuple[Floats, Floats]:
    """Return what a dashpot of unit damping makes of the shapes, first order.

    Parts of modes that turn freely with one another are left out: the test's real shapes decide
    how those lie. `u` (n_place, n) is the motion of the places in the modes, `sensors`
    (n_sensor, n) are shapes of unit modal mass in the coordinates of `modes`. Returned are the
    coordinates of the imaginary parts on the modes, (n_place, count, n), and their inner products
    at the sensors, (n, n).
    """
    lam = modes.omega**2
    gap = lam[None, :] - lam[: modes.count, None]
    size = LIKELIHOOD.mixing * np.maximum(lam[None, :], lam[: modes.count, None])
    inverse = gap / (gap**2 + size**2)
    turned = -(modes.omega[: modes.count] * u[:, : modes.count])[:, :, None] * (
        u[:, None, :] * inverse
    )
    return turned, np.asarray(sensors.T @ sensors)
