"""Elastic matrices of solids, strains in the order xx, yy, zz, xy, yz, zx."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats
from .batch import symmetric, transpose

PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))


def isotropic_solid(E: Floats, nu: Floats) -> Floats:
    """Elastic matrices (n, 6, 6) of isotropic materials; shear follows from E and nu as in NX."""
    E, nu = np.broadcast_arrays(np.atleast_1d(E), np.atleast_1d(nu))
    C = np.zeros((len(E), 6, 6))
    G = E / (2.0 * (1.0 + nu))
    C[:, :3, :3] = (2.0 * G * nu / (1.0 - 2.0 * nu))[:, None, None]
    for i in range(3):
        C[:, i, i] += 2.0 * G
        C[:, i + 3, i + 3] = G
    return C


def strain_transform(axes: Floats) -> Floats:
    """Strains in the basis of the rows of `axes` from Cartesian strains, (n, 6, 6).

    E_ij = a_i . e . a_j with engineering shears; the rows (n, 3, 3) need be neither orthogonal
    nor of unit length.
    """
    T = np.empty((*axes.shape[:-2], 6, 6))
    for r, (i, j) in enumerate(PAIRS):
        a, b = axes[..., i, :], axes[..., j, :]
        double = 1.0 if i == j else 2.0
        for c, (k, m) in enumerate(PAIRS):
            if k == m:
                T[..., r, c] = double * a[..., k] * b[..., k]
            else:
                T[..., r, c] = 0.5 * double * (a[..., k] * b[..., m] + a[..., m] * b[..., k])
    return T


def rotate_material(C: Floats, axes: Floats) -> Floats:
    """Elastic matrices in the basic frame from those in material axes.

    Parameters
    ----------
    C : (n, 6, 6) float
        In material axes.
    axes : (n, 3, 3) float
        Rows are the material axes in the basic frame.
    """
    T = strain_transform(axes)
    return symmetric(transpose(T) @ C @ T)
