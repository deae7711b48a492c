"""All modes of a small model by LAPACK, exact for singular mass matrices."""

import numpy as np
import scipy.linalg as sl

from ..arrays import Floats
from ..data.parametric_model import Model
from ..errors import InputError
from ..numerics.block_lanczos import NEGATIVE_MASS
from .eigen_numbers import EIGEN
from .mechanisms import diagnose
from .pencil import Pencil, Spectrum, refuse_indefinite_mass


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
    refuse_indefinite_mass(pencil)
    diagnose(model, pencil, -pencil.least_shift)
    B = _massed_basis(K, M)
    count = max(B.shape[1] - rigid.shape[1], 0)
    if not count:
        none = np.zeros(0)
        return Spectrum(none, rigid[:, :0], none, -pencil.least_shift, complete=True, missed=0)
    sigma, factor, low, low_vectors = _inverse(pencil, K, M, rigid, count)
    # errors are eps (lambda - sigma)^2 / (lambda_1 - sigma) below, eps lambda_max above
    highest = sl.eigh(B.T @ K @ B, eigvals_only=True, subset_by_index=[B.shape[1] - 1] * 2)[0]
    balance = np.sqrt(max(highest, -sigma) * (low[0] - sigma))
    split = int(np.count_nonzero(low < balance))
    low_vectors = low_vectors[:, :split]
    low_vectors = _orthonormal(M, low_vectors - rigid @ (rigid.T @ M @ low_vectors))
    B = B @ _complement(B.T @ M @ np.hstack([rigid, low_vectors]))
    high, y = np.linalg.eigh(B.T @ K @ B)
    values, X = np.concatenate([low[:split], high]), np.hstack([low_vectors, B @ y])
    error = X - sl.cho_solve((factor, True), M @ X) * (values - sigma)
    residual = np.sqrt(np.maximum(np.einsum("ij,ij->j", error, M @ error), 0.0))
    condensed = np.linalg.norm(B.T @ (K @ (B @ y)) - y * high, axis=0) / np.abs(high)
    residual[split:] = np.minimum(residual[split:], condensed)  # either bounds the error
    return Spectrum(
        values,
        X,
        residual,
        sigma,
        complete=True,
        missed=0,
    )


def _massed_basis(K: Floats, M: Floats) -> Floats:
    """M-orthonormal basis of the motions with mass; those without follow statically."""
    B, N = _mass_range(K, M)
    return B - N @ np.linalg.solve(N.T @ K @ N, N.T @ K @ B) if N.shape[1] else B


def _orthonormal(M: Floats, X: Floats) -> Floats:
    """Vectors of the same span in the same order, M-orthonormal (twice is enough)."""
    for _ in range(2):
        X = sl.solve_triangular(sl.cholesky(X.T @ M @ X, lower=True), X.T, lower=True).T
    return X


def _inverse(
    pencil: Pencil, K: Floats, M: Floats, rigid: Floats, count: int
) -> tuple[float, Floats, Floats, Floats]:
    """Modes of (K - sigma M)^-1 M: shift, Cholesky factor, values, vectors, the lowest `count`.

    The shift follows the lowest mode down: beside a larger one its eigenvalue would be rounding.
    """
    least = pencil.least_shift
    sigma = -max(EIGEN.shift_most * float(np.median(pencil.stiffness_over_mass)), least)
    for _ in range(EIGEN.shifts):
        L = sl.cholesky(K - sigma * M, lower=True)
        half = sl.solve_triangular(L, M, lower=True)
        operator = sl.solve_triangular(L, half.T, lower=True)
        keep = _complement(L.T @ rigid)
        operator = keep.T @ operator @ keep
        operator = (operator + operator.T) / 2.0
        last = len(operator) - 1
        lowest = sigma + 1.0 / sl.eigh(operator, eigvals_only=True, subset_by_index=[last] * 2)[0]
        if -sigma <= max(EIGEN.far_shift * lowest, least):
            break
        sigma = -max(EIGEN.nearer[0] * lowest, -(EIGEN.nearer[1] ** 2) * sigma, least)
    theta, w = np.linalg.eigh(operator)
    theta = np.maximum(theta[::-1][:count], np.finfo(float).tiny)
    X = sl.solve_triangular(L.T, keep @ w[:, ::-1][:, :count]) / np.sqrt(theta)
    return sigma, L, sigma + 1.0 / theta, X


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
