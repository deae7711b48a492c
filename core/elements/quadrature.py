"""Integration points and weights on triangles and solids.

Natural coordinates run from -1 to 1 for hexahedra and along the axis of wedges and pyramids;
triangles and tetrahedra use area and volume coordinates.
"""

import numpy as np

from ..arrays import Floats


def gauss_line(n: int) -> tuple[Floats, Floats]:
    """Return Gauss-Legendre points and weights on -1..1."""
    x, w = np.polynomial.legendre.leggauss(n)
    return x, w


def gauss_hexa(n: int) -> tuple[Floats, Floats]:
    """Return the n x n x n rule of the cube."""
    x, w = gauss_line(n)
    points = np.stack(np.meshgrid(x, x, x, indexing="ij"), axis=-1).reshape(-1, 3)
    weights = (w[:, None, None] * w[:, None] * w).ravel()
    return points, weights


def gauss_tria(n: int) -> tuple[Floats, Floats]:
    """Return the 3 or 7 point rule of the triangle (two area coordinates; weights sum to 1/2)."""
    if n == 3:
        a, b = 1.0 / 6.0, 2.0 / 3.0
        return np.array([[a, a], [b, a], [a, b]]), np.full(3, 1.0 / 6.0)
    s = np.sqrt(15.0)
    a, b = (6.0 - s) / 21.0, (6.0 + s) / 21.0
    wa, wb = (155.0 - s) / 2400.0, (155.0 + s) / 2400.0
    c = 1.0 / 3.0
    points = [
        [c, c],
        [a, a],
        [1 - 2 * a, a],
        [a, 1 - 2 * a],
        [b, b],
        [1 - 2 * b, b],
        [b, 1 - 2 * b],
    ]
    return np.array(points), np.array([9.0 / 80.0, wa, wa, wa, wb, wb, wb])


def gauss_wedge(n_tria: int, n_line: int) -> tuple[Floats, Floats]:
    """Return the product rule of the wedge; points of one level follow each other."""
    t, wt = gauss_tria(n_tria)
    z, wz = gauss_line(n_line)
    points = np.concatenate([np.column_stack([t, np.full(len(t), h)]) for h in z])
    return points, np.concatenate([wt * w for w in wz])


def gauss_tetra(n: int) -> tuple[Floats, Floats]:
    """Return the 1, 4, 5 or 15 point rule of the tetrahedron (weights sum to 1/6)."""
    c = np.full((1, 3), 0.25)
    if n == 1:
        return c, np.array([1.0 / 6.0])
    if n == 4:
        return _corners((5.0 - np.sqrt(5.0)) / 20.0), np.full(4, 1.0 / 24.0)
    if n == 5:
        points = np.concatenate([c, _corners(1.0 / 6.0)])
        return points, np.array([-0.8, 0.45, 0.45, 0.45, 0.45]) / 6.0
    s = np.sqrt(15.0)
    a, b = (7.0 + s) / 34.0, (7.0 - s) / 34.0
    d = (10.0 - 2.0 * s) / 40.0
    e = 0.5 - d
    mid = np.array([[d, d, e], [d, e, d], [e, d, d], [d, e, e], [e, d, e], [e, e, d]])
    wa, wb = (2665.0 - 14.0 * s) / 226800.0, (2665.0 + 14.0 * s) / 226800.0
    weights = [8.0 / 405.0, *[wa] * 4, *[wb] * 4, *[5.0 / 567.0] * 6]
    return np.concatenate([c, _corners(a), _corners(b), mid]), np.array(weights)


def gauss_pyramid(n: int) -> tuple[Floats, Floats]:
    """Return the n x n x n collapsed rule of the pyramid (weights sum to 4/3)."""
    x, wx = gauss_line(n)
    z, wz = np.polynomial.legendre.leggauss(n + 1)
    z, wz = 0.5 * (z + 1.0), 0.5 * wz
    a, b, h = np.meshgrid(x, x, z, indexing="ij")
    points = np.stack([a * (1 - h), b * (1 - h), h], axis=-1).reshape(-1, 3)
    weights = wx[:, None, None] * wx[:, None] * wz * (1 - z) ** 2
    return points, weights.ravel()


def _corners(a: float) -> Floats:
    b = 1.0 - 3.0 * a
    return np.array([[a, a, a], [b, a, a], [a, b, a], [a, a, b]])
