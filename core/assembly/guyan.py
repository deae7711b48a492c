"""Static (Guyan) condensation."""

import numpy as np
import scipy.sparse as sp
from scipy.sparse import linalg as spla

from ..arrays import Floats, Ints, Numbers
from ..errors import InputError

_ROUNDING = 1e-14
"""Force beside the sum of what it is the difference of."""


def static_condensation(K: sp.csr_matrix, kept: Ints, rigid: Floats) -> Floats:
    """Displacements of all degrees of freedom from the kept ones, without loads on the others.

    Guyan (1965), *Reduction of stiffness and mass matrices*, AIAA Journal 3(2), 380.

    Parameters
    ----------
    K : (n, n) sparse
        Symmetric stiffness.
    kept : (m,) int
        Degrees of freedom that stay.
    rigid : (n, k) float
        Motions that cost no strain energy: they are followed to the last digit.

    Returns
    -------
    (n, m) float
        Identity in the rows `kept`.

    Raises
    ------
    InputError
        The others are not supported when the kept ones are held.
    """
    n = K.shape[0]
    others = np.setdiff1d(np.arange(n), kept)
    T = np.zeros((n, len(kept)))
    T[kept, np.arange(len(kept))] = 1.0
    if not len(others):
        return T
    rows = K.tocsr()[others]
    free = rows[:, others].tocsc()
    scale = 1.0 / np.sqrt(np.where(free.diagonal() > 0.0, free.diagonal(), 1.0))
    D = sp.diags(scale)
    try:
        factor = spla.splu((D @ free @ D).tocsc())
        pivots = np.abs(factor.U.diagonal())
        if pivots.min() <= 1e-14 * pivots.max():
            raise RuntimeError
    except RuntimeError:
        raise InputError(
            "the degrees of freedom that are left out move freely when the kept ones are held: "
            "keep more of them"
        ) from None
    T[others] = -scale[:, None] * factor.solve(scale[:, None] * rows[:, kept].toarray())
    if rigid.shape[1]:
        T[others] += (rigid - T @ rigid[kept])[others] @ np.linalg.pinv(rigid[kept])
    return T


def without_strain(K: sp.csr_matrix, motions: Floats) -> Floats:
    """Those of some motions (n, k) whose forces K x are rounding."""
    return np.asarray(motions[:, _free(K @ motions, _magnitudes(K), motions)])


def _free(force: Floats, magnitudes: sp.csr_matrix | Floats, motions: Floats) -> Numbers:
    """Which motions (n, k) make forces (n, k) that are rounding of stiffness times all of them.

    A motion along an axis alone has rounding of the others' size across it.
    """
    largest = np.abs(motions).max(axis=0, initial=0.0)
    moved = largest > 0.0
    size = magnitudes @ (np.abs(motions[:, moved]) / largest[moved]).sum(axis=1)
    small = np.abs(force) <= _ROUNDING * size[:, None] * largest
    return np.asarray(small.all(axis=0) & moved)


def condensed(A: sp.csr_matrix, T: Floats, rigid: Floats) -> sp.csr_matrix:
    """T^T A T, exactly symmetric and without what is rounding of the sums that make it.

    The stiffness of a few points of a soft structure is a small difference of large numbers; what
    is left of these would resist rigid motions (m, k) a little, or less than not at all. Where A
    is a stiffness that leaves these free, so does what is returned.
    """
    found, size = T.T @ (A @ T), np.abs(T.T) @ (_magnitudes(A) @ np.abs(T))
    found = np.where(np.abs(found) > _ROUNDING * size, found, 0.0)
    rigid = rigid[:, _free(found @ rigid, size, rigid)]
    if rigid.shape[1]:
        root = np.sqrt(np.maximum(found.diagonal(), 0.0))
        basis = np.linalg.qr(root[:, None] * rigid)[0]
        P = np.eye(len(root)) - (basis / np.where(root > 0.0, root, 1.0)[:, None]) @ (
            basis.T * root
        )
        found = P.T @ found @ P
    return sp.csr_matrix(0.5 * (found + found.T))


def _magnitudes(A: sp.csr_matrix) -> sp.csr_matrix:
    """Return |A|; scipy's own would sort the indices of `A`, which other matrices share."""
    return sp.csr_matrix((np.abs(A.data), A.indices, A.indptr), A.shape)
