"""Small helpers for work on batches of element matrices."""

from collections.abc import Callable

import numpy as np

from ..arrays import Floats, Ints, skew

CHUNK = 256


def in_chunks(n: int, n_dof: int, matrices: Callable[[slice], Floats], size: int = CHUNK) -> Floats:
    """Evaluate `matrices` slice by slice, so that temporary arrays stay in cache and bounded.

    Parameters
    ----------
    n, n_dof : int
        Number of elements and of degrees of freedom of each.
    matrices : callable
        Returns the (m, n_dof, n_dof) matrices of a slice of the elements.

    Returns
    -------
    (n, n_dof, n_dof) float
    """
    out = np.empty((n, n_dof, n_dof))
    for start in range(0, n, size):
        part = slice(start, min(start + size, n))
        out[part] = matrices(part)
    return out


def transpose(a: Floats) -> Floats:
    """Return the transpose of each matrix of a batch, a view."""
    return a.swapaxes(-1, -2)


def symmetric(a: Floats) -> Floats:
    """Return the symmetric part of each matrix of a batch: removes rounding only."""
    return 0.5 * (a + transpose(a))


def congruent(K: Floats, T: Floats) -> Floats:
    """Return T^T K T of each element, symmetric to the last bit."""
    return symmetric(transpose(T) @ K @ T)


def unit(v: Floats) -> Floats:
    """Return the vectors `v`, (..., 3), scaled to length one."""
    return np.asarray(v / np.linalg.norm(v, axis=-1, keepdims=True))


def arms(axes: Floats, offset: Floats) -> Floats:
    """Return local motion at the ends of rigid arms from grid motion in the basic frame.

    Parameters
    ----------
    axes : (n, 3, 3) float
        Rows are the local axes in the basic frame.
    offset : (n, m, 3) float
        Arm from each grid to its local point, in *local* axes.

    Returns
    -------
    (n, 6 m, 6 m) float
        Block diagonal; local u + theta x arm and theta from the six motions of each grid.
    """
    n, m = offset.shape[:2]
    T = np.zeros((n, m, 6, m, 6))
    cross = -skew(offset) @ axes[:, None]
    for i in range(m):
        T[:, i, :3, i, :3] = axes
        T[:, i, :3, i, 3:] = cross[:, i]
        T[:, i, 3:, i, 3:] = axes
    return T.reshape(n, 6 * m, 6 * m)


def condense(K: Floats, kept: Ints, dropped: Ints) -> Floats:
    """Eliminate internal freedoms statically, element by element.

    Internal freedoms without any stiffness (an element without membrane, say) are left out.
    """
    Kpp = K[:, dropped[:, None], dropped]
    empty = np.einsum("nii->ni", Kpp) == 0.0
    np.einsum("nii->ni", Kpp)[empty] = 1.0
    Kpk = K[:, dropped[:, None], kept]
    return np.asarray(K[:, kept[:, None], kept] - transpose(Kpk) @ np.linalg.solve(Kpp, Kpk))


def translations(m: Floats, freedoms: int) -> Floats:
    """Return masses of nodes, (n, k, k), alike in all directions as (n, k freedoms, k freedoms)."""
    n, k, _ = m.shape
    M = np.zeros((n, k, freedoms, k, freedoms))
    for axis in range(3):
        M[:, :, axis, :, axis] = m
    return M.reshape(n, k * freedoms, k * freedoms)
