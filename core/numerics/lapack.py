"""LAPACK called directly: for a search's many small matrices the way to it counts."""

import numpy as np
from scipy.linalg import lapack

from ..arrays import Floats


def eigenpairs(K: Floats, M: Floats) -> tuple[Floats, Floats]:
    """Return all eigenvalues (n,), ascending, and M-orthonormal vectors of a symmetric pencil.

    Raises
    ------
    numpy.linalg.LinAlgError
        M (n, n) is not positive definite.
    """
    values, vectors, fault = lapack.dsygvd(K.T, M.T, uplo="U")
    if fault:
        raise np.linalg.LinAlgError("the mass matrix is not positive definite")
    return values, vectors


def lower_solved(L: Floats, B: Floats) -> Floats:
    """Return L⁻¹ B of lower triangular L (..., n, n) and B (..., n, m)."""
    if L.ndim == 2:
        return np.asarray(lapack.dtrtrs(L.T, B, lower=0, trans=1)[0])
    out = np.empty(B.shape)
    for at in np.ndindex(B.shape[:-2]):
        out[at] = lapack.dtrtrs(L[at].T, B[at], lower=0, trans=1)[0]
    return out
