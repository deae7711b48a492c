"""Component mode synthesis: constraint modes and normal modes of the interior."""

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Ints
from ..eigen.normal_modes import solve
from .derivative_numbers import DERIVATIVES


def component_modes(
    K: sp.csr_matrix,
    M: sp.csr_matrix,
    constraint_modes: Floats,
    kept: Ints,
    held: Ints,
    n_modes: int | None,
    fmax: float | None,
) -> Floats:
    """Displacements of all degrees of freedom in the modes of a component, the boundary at rest.

    The modes are those with `held` fixed; of what else is kept, and free to move in them, the
    static shape is taken away, so that the kept displacements stay coordinates of the reduced
    model. Modes that the constraint modes hold already, such as rigid-body modes, are left out.

    Craig, Bampton (1968), *Coupling of substructures for dynamic analyses*, AIAA Journal 6(7),
    1313; with a free boundary Herting (1985), *A general purpose, multi-stage, component modal
    synthesis method*, Finite Elements in Analysis and Design 1(2), 153.

    Parameters
    ----------
    K, M : (n, n) sparse
    constraint_modes : (n, m) float
        See `assembly.guyan.static_condensation`.
    kept : (m,) int
        Degrees of freedom that stay.
    held : (h,) int
        Those of them that are fixed in the modes.
    n_modes, fmax : optional
        How many modes, and up to which frequency [Hz].

    Returns
    -------
    (n, k) float
        Zero in the rows `kept`, of unit generalised mass before the static shape was taken away.
    """
    moving = np.setdiff1d(np.arange(K.shape[0]), held)
    if not len(moving):
        return np.zeros((K.shape[0], 0))
    found = solve((K[moving][:, moving], M[moving][:, moving]), n_modes, fmax)
    shapes = np.zeros((K.shape[0], found.vectors.shape[1]))
    shapes[moving] = found.vectors
    shapes -= constraint_modes @ shapes[kept]
    shapes[kept] = 0.0
    left = np.einsum("nk,nk->k", shapes, M @ shapes)
    return np.asarray(shapes[:, left > DERIVATIVES.held_already])
