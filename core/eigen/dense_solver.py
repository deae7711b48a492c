"""All modes of a small model by LAPACK, exact for singular mass matrices."""

import numpy as np
import scipy.linalg as sl

from ..arrays import Floats
from ..data.parametric_model import Model
from ..errors import InputError
from ..numerics.block_lanczos import NEGATIVE_MASS
from .eigen_numbers import EIGEN
from .mechanisms import diagnose
from .pencil import Pencil, Spectrum


def dense_modes(model: Model | None, pencil: Pencil, rigid: Floats) -> Spectrum:
    """Find every mode with a finite eigenvalue that is M-orthogonal to `rigid`, (n, n_rigid).

    Two forms of the problem are solved, since each is accurate at one end of the spectrum only:
    K condensed to the range of M, with errors of the order of its largest eigenvalue, and
    (K - sigma M)^-1 M, with errors relative to the smallest one.

    Raises
    ------
    InputError
        The mass or the stiffness is not positive semi-definite, or a motion has neither.
    """
    K, M = pencil.K.toarray(), pencil.M.toarray()
    small = pencil.least_shift
    diagnose(model, pencil, -small)
    high, high_vectors, high_residual = _condensed(K, M, rigid)
    if not len(high):
        return Spectrum(high, high_vectors, high, -small, complete=True, missed=0)
    lowest = high[high > EIGEN.lowest * high[-1]].min(initial=high[-1])
    sigma = -max(0.5 * lowest, small)
    low, low_vectors, low_residual = _inverse(K, M, rigid, sigma, len(high))
    # errors are eps (lambda - sigma)^2 / (lambda_1 - sigma) below, eps lambda_max above
    balance = np.sqrt(max(high[-1], -sigma) * (low[0] - sigma))
    split = int(np.count_nonzero(low < balance))
    X = np.hstack([low_vectors[:, :split], high_vectors[:, split:]])
    X -= rigid @ (rigid.T @ M @ X)
    return Spectrum(
        np.concatenate([low[:split], high[split:]]),
        sl.solve_triangular(sl.cholesky(X.T @ M @ X, lower=True), X.T, lower=True).T,
        np.concatenate([low_residual[:split], high_residual[split:]]),
        sigma,
        complete=True,
        missed=0,
    )


def _condensed(K: Floats, M: Floats, rigid: Floats) -> tuple[Floats, Floats, Floats]:
    """Modes by static condensation of the motions without mass: values, vectors, residuals."""
    B, N = _mass_range(K, M)
    if N.shape[1]:
        B = B - N @ np.linalg.solve(N.T @ K @ N, N.T @ K @ B)
    B = B @ _complement(B.T @ M @ rigid)
    condensed = B.T @ K @ B
    condensed = (condensed + condensed.T) / 2.0
    values, y = np.linalg.eigh(condensed)
    error = np.linalg.norm(condensed @ y - y * values, axis=0)
    return values, B @ y, error / np.maximum(np.abs(values), np.finfo(float).tiny)


def _inverse(
    K: Floats, M: Floats, rigid: Floats, sigma: float, count: int
) -> tuple[Floats, Floats, Floats]:
    """Modes of (K - sigma M)^-1 M: values, vectors, residuals, the lowest `count`."""
    A = K - sigma * M
    L = sl.cholesky(A, lower=True)
    half = sl.solve_triangular(L, M, lower=True)
    operator = sl.solve_triangular(L, half.T, lower=True)
    keep = _complement(L.T @ rigid)
    operator = keep.T @ operator @ keep
    theta, w = np.linalg.eigh((operator + operator.T) / 2.0)
    theta = np.maximum(theta[::-1][:count], np.finfo(float).tiny)
    X = sl.solve_triangular(L.T, keep @ w[:, ::-1][:, :count]) / np.sqrt(theta)
    error = X - sl.cho_solve((L, True), M @ X) / theta
    norm = np.sqrt(np.maximum(np.einsum("ij,ij->j", error, M @ error), 0.0))
    return sigma + 1.0 / theta, X, norm


def _mass_range(K: Floats, M: Floats) -> tuple[Floats, Floats]:
    """M-orthonormal basis of the range of M, and a basis of its null space, both (n, .)."""
    massed = M.any(axis=1)
    d = 1.0 / np.sqrt(np.diag(M)[massed])
    value, Q = np.linalg.eigh(d[:, None] * M[np.ix_(massed, massed)] * d)
    if value[0] < -EIGEN.negative_mass * value[-1]:
        raise InputError(NEGATIVE_MASS)
    has = value > EIGEN.no_mass * value[-1]
    B = np.zeros((len(M), np.count_nonzero(has)))
    B[massed] = d[:, None] * (Q[:, has] / np.sqrt(value[has]))
    N = np.zeros((len(M), len(M) - B.shape[1]))
    n_free = np.count_nonzero(~massed)
    N[~massed, :n_free] = np.diag(1.0 / np.sqrt(np.diag(K)[~massed]))
    N[massed, n_free:] = d[:, None] * Q[:, ~has]
    return B, N


def _complement(Y: Floats) -> Floats:
    """Orthonormal basis of what is orthogonal to the columns of Y."""
    if not Y.shape[1]:
        return np.eye(len(Y))
    return np.asarray(np.linalg.qr(Y, mode="complete")[0][:, Y.shape[1] :])
