"""Transverse shear flexibility of plates with MacNeal's residual bending flexibility.

A plate element with assumed edge shears is too stiff where the moment varies along it. MacNeal
(1978), *A simple quadrilateral shell element*, Computers & Structures 8, 175-183, adds what is
missing to the shear flexibility: l**2 / (12 D) for a shear force that is constant over the
element, D being the bending stiffness of the strip of length l with every other curvature held.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Floats
from .batch import transpose
from .section import ShellSection

_RIGID = 1e9


def strip_stiffness(D: Floats, direction: Floats) -> tuple[Floats, Floats]:
    """Bending stiffness along and across a direction, each (n,).

    Parameters
    ----------
    D : (n, 3, 3) float
        Bending stiffness in element axes.
    direction : (n, 2) float
        In element axes, any length.
    """
    c, s = (direction / np.linalg.norm(direction, axis=1, keepdims=True)).T
    along = np.stack([c * c, s * s, 2.0 * s * c], axis=1)
    across = np.stack([s * s, c * c, -2.0 * s * c], axis=1)
    D1 = np.einsum("ni,nij,nj->n", along, D, along)
    D2 = np.einsum("ni,nij,nj->n", across, D, across)
    return D1, D2


def bending_scale(D: Floats) -> Floats:
    """1 / sqrt of the bending stiffness along element x and y, (n, 2); 0 without bending."""
    diagonal = np.stack([D[:, 0, 0], D[:, 1, 1]], axis=1)
    positive = diagonal > 0.0
    return np.where(positive, 1.0 / np.sqrt(np.where(positive, diagonal, 1.0)), 0.0)


def residual_flexibility(edges: Floats, scale: Floats) -> Floats:
    """Z_b = sum(e e^T) / (24 D), (n, 2, 2), of triangles, from edges and `bending_scale`."""
    e = edges * scale[:, None, :]
    return np.asarray(transpose(e) @ e / 24.0)


def finite_shear(section: ShellSection, size: Floats) -> Floats:
    """S with "infinite" replaced by a number that is large beside 12 D / size**2."""
    rigid = np.isinf(section.S).any(axis=(1, 2))
    if not rigid.any():
        return section.S
    D = np.maximum(section.D[:, 0, 0], section.D[:, 1, 1])
    large = (_RIGID * D / size**2)[:, None, None] * np.eye(2)
    return np.where(rigid[:, None, None], large, section.S)
