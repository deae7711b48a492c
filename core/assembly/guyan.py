"""Static (Guyan) condensation."""

import numpy as np
import scipy.sparse as sp
from scipy.sparse import linalg as spla

from ..arrays import Floats, Ints
from ..errors import InputError


def static_condensation(K: sp.csr_matrix, kept: Ints) -> Floats:
    """Displacements of all degrees of freedom from the kept ones, without loads on the others.

    Guyan (1965), *Reduction of stiffness and mass matrices*, AIAA Journal 3(2), 380.

    Parameters
    ----------
    K : (n, n) sparse
        Symmetric stiffness.
    kept : (m,) int
        Degrees of freedom that stay.

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
    return T
