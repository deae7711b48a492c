"""Transverse shear flexibility of plates with MacNeal's residual bending flexibility.

A plate element with assumed edge shears is too stiff where the moment varies along it. MacNeal
(1978), *A simple quadrilateral shell element*, Computers & Structures 8, 175-183, adds what is
missing to the shear flexibility: l**2 / (12 D) for a shear force that is constant over the
element. Written with the edge vectors e of the element, Z_b = sum(e e^T) / (24 D), which holds
for the NX Nastran matrices of both the square and the triangle.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Floats
from .batch import transpose
from .section import ShellSection

_RIGID = 1e9


def bending_scale(section: ShellSection) -> Floats:
    """1 / sqrt of the bending stiffness along element x and y, (n, 2); 0 without bending.

    The coupling to the membrane is taken out first, D - B A^-1 B, so that the reference
    surface does not matter.
    """
    D = section.D
    if section.B.any():
        coupled = section.B.any(axis=(1, 2))
        A, B = section.A[coupled], section.B[coupled]
        D = D.copy()
        D[coupled] -= B @ np.linalg.solve(A, B)
    diagonal = np.stack([D[:, 0, 0], D[:, 1, 1]], axis=1)
    positive = diagonal > 0.0
    return np.where(positive, 1.0 / np.sqrt(np.where(positive, diagonal, 1.0)), 0.0)


def residual_flexibility(edges: Floats, scale: Floats) -> Floats:
    """Z_b for constant shear, (n, 2, 2), from the edges (n, m, 2) and `bending_scale`."""
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
