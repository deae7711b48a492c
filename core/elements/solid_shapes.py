"""Shape functions, integration points and node numbering of the solid elements.

Node numbering is the usual one (corners of the first face, corners of the second, then middle
nodes edge by edge). Natural coordinates run from -1 to 1 for hexahedra and along the axis of
wedges and pyramids; triangles and tetrahedra use area and volume coordinates.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, Ints

Shape = Callable[[Floats], tuple[Floats, Floats]]

_SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
_HEXA = np.column_stack([np.tile(_SQUARE, (2, 1)), np.repeat([-1.0, 1.0], 4)])
_QUAD_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0))
_TRIA_EDGES = ((0, 1), (1, 2), (2, 0))


@dataclass(frozen=True, eq=False)
class Solid:
    """A solid element: how many nodes, where its middle nodes stand, how it is integrated.

    Parameters
    ----------
    nodes : int
        Number of nodes.
    edges : (k, 2) int
        Ends of the edges with a middle node, in the order of the middle nodes.
    shape : callable
        (m, 3) natural coordinates -> shape functions (m, nodes) and derivatives (m, 3, nodes).
    points, weights : (m, 3), (m,) float
        Integration of the stiffness.
    mass_points, mass_weights : (m, 3), (m,) float
        Integration of the mass.
    """

    nodes: int
    edges: Ints
    shape: Shape
    points: Floats
    weights: Floats
    mass_points: Floats
    mass_weights: Floats


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


def hexa8(p: Floats) -> tuple[Floats, Floats]:
    """Trilinear shape functions."""
    f = 1.0 + _HEXA * p[:, None, :]
    N = f.prod(axis=2) / 8.0
    d = [_HEXA[:, k] * f[:, :, k - 2] * f[:, :, k - 1] / 8.0 for k in range(3)]
    return N, np.stack(d, axis=1)


def hexa20(p: Floats) -> tuple[Floats, Floats]:
    """Serendipity shape functions of the 20-node brick."""
    middle = np.array([0.5 * (_HEXA[i] + _HEXA[j]) for i, j in _hexa_edges()])
    N, dN = np.empty((len(p), 20)), np.empty((len(p), 3, 20))
    f = 1.0 + _HEXA * p[:, None, :]
    s = (_HEXA * p[:, None, :]).sum(axis=2) - 2.0
    N[:, :8] = f.prod(axis=2) * s / 8.0
    for k in range(3):
        pair = f[:, :, k - 2] * f[:, :, k - 1]
        dN[:, k, :8] = _HEXA[:, k] * pair * (s + f[:, :, k]) / 8.0
    for m, at in enumerate(middle):
        along = int(np.flatnonzero(at == 0.0)[0])
        i, j = (along + 1) % 3, (along + 2) % 3
        a, b = 1.0 + at[i] * p[:, i], 1.0 + at[j] * p[:, j]
        c = 1.0 - p[:, along] ** 2
        N[:, 8 + m] = a * b * c / 4.0
        dN[:, along, 8 + m] = -0.5 * p[:, along] * a * b
        dN[:, i, 8 + m] = at[i] * b * c / 4.0
        dN[:, j, 8 + m] = at[j] * a * c / 4.0
    return N, dN


def penta6(p: Floats) -> tuple[Floats, Floats]:
    """Shape functions of the wedge: area coordinates times linear along the axis."""
    L, dL = _area_coordinates(p)
    z = p[:, 2:3]
    low, high = 0.5 * (1.0 - z), 0.5 * (1.0 + z)
    N = np.concatenate([L * low, L * high], axis=1)
    dN = np.empty((len(p), 3, 6))
    dN[:, :2] = np.concatenate([dL * low[:, None], dL * high[:, None]], axis=2)
    dN[:, 2] = np.concatenate([-0.5 * L, 0.5 * L], axis=1)
    return N, dN


def penta15(p: Floats) -> tuple[Floats, Floats]:
    """Serendipity shape functions of the 15-node wedge."""
    L, dL = _area_coordinates(p)
    z = p[:, 2:3]
    N, dN = np.empty((len(p), 15)), np.zeros((len(p), 3, 15))
    edges = np.array(_TRIA_EDGES)
    La, Lb = L[:, edges[:, 0]], L[:, edges[:, 1]]
    dab = dL[:, :, edges[:, 0]] * Lb[:, None] + dL[:, :, edges[:, 1]] * La[:, None]
    for corner, edge, sign in ((slice(0, 3), slice(6, 9), -1.0), (slice(3, 6), slice(12, 15), 1.0)):
        f = 1.0 + sign * z
        N[:, corner] = 0.5 * L * ((2.0 * L - 1.0) * f - (1.0 - z**2))
        dN[:, :2, corner] = 0.5 * dL * ((4.0 * L - 1.0) * f - (1.0 - z**2))[:, None]
        dN[:, 2, corner] = 0.5 * L * ((2.0 * L - 1.0) * sign + 2.0 * z)
        N[:, edge] = 2.0 * La * Lb * f
        dN[:, :2, edge] = 2.0 * dab * f[:, None]
        dN[:, 2, edge] = 2.0 * La * Lb * sign
    N[:, 9:12] = L * (1.0 - z**2)
    dN[:, :2, 9:12] = dL * (1.0 - z**2)[:, None]
    dN[:, 2, 9:12] = -2.0 * L * z
    return N, dN


def tetra4(p: Floats) -> tuple[Floats, Floats]:
    """Volume coordinates."""
    N = np.column_stack([1.0 - p.sum(axis=1), p])
    d = np.column_stack([-np.ones(3), np.eye(3)])
    return N, np.broadcast_to(d, (len(p), 3, 4))


def tetra10(p: Floats) -> tuple[Floats, Floats]:
    """Quadratic shape functions of the tetrahedron."""
    L, dL = tetra4(p)
    edges = _tetra_edges()
    a, b = edges[:, 0], edges[:, 1]
    N = np.concatenate([L * (2.0 * L - 1.0), 4.0 * L[:, a] * L[:, b]], axis=1)
    middle = 4.0 * (dL[:, :, a] * L[:, None, b] + dL[:, :, b] * L[:, None, a])
    return N, np.concatenate([dL * (4.0 * L - 1.0)[:, None], middle], axis=2)


def pyramid5(p: Floats) -> tuple[Floats, Floats]:
    """Rational shape functions of the pyramid (Bedrosian 1992); base z = 0, apex z = 1."""
    corner = _SQUARE
    x, y, z = p[:, 0:1], p[:, 1:2], p[:, 2:3]
    cx, cy = corner[:, 0], corner[:, 1]
    h = 1.0 - z
    a, b = h + cx * x, h + cy * y
    N = np.concatenate([a * b / (4.0 * h), z], axis=1)
    dN = np.zeros((len(p), 3, 5))
    dN[:, 0, :4] = cx * b / (4.0 * h)
    dN[:, 1, :4] = cy * a / (4.0 * h)
    dN[:, 2, :4] = (-(a + b) * h + a * b) / (4.0 * h**2)
    dN[:, 2, 4] = 1.0
    return N, dN


def pyramid13(p: Floats) -> tuple[Floats, Floats]:
    """Rational quadratic shape functions of the pyramid (Bedrosian 1992).

    One at their own node, zero at the others, and complete to second order.
    """
    h = np.maximum(1.0 - p[:, 2], 1e-300)[:, None]
    x, y = p[:, 0:1], p[:, 1:2]
    one = np.ones_like(h)
    monomials, gradients = _pyramid_basis(x, y, h, one)
    coefficients = _pyramid13_coefficients()
    N = monomials @ coefficients
    dN = np.einsum("mdk,kn->mdn", gradients, coefficients)
    return N, dN


def _pyramid_basis(x: Floats, y: Floats, h: Floats, one: Floats) -> tuple[Floats, Floats]:
    """Thirteen functions that span the space, and their derivatives by x, y, z = 1 - h."""
    z, o = 1.0 - h, 0.0 * one
    r = x * y / h
    f = [one, x, y, z, x * y, x * z, y * z, x**2, y**2, z**2, r, x * r, y * r]
    fx = [o, one, o, o, y, z, o, 2 * x, o, o, y / h, 2 * r, y**2 / h]
    fy = [o, o, one, o, x, o, z, o, 2 * y, o, x / h, x**2 / h, 2 * r]
    fz = [o, o, o, one, o, x, y, o, o, 2 * z, r / h, x * r / h, y * r / h]
    stack = [np.concatenate(column, axis=1) for column in (fx, fy, fz)]
    return np.concatenate(f, axis=1), np.stack(stack, axis=1)


def _pyramid13_coefficients() -> Floats:
    corner = np.column_stack([_SQUARE, np.zeros(4)])
    apex = np.array([[0.0, 0.0, 1.0]])
    base = np.array([0.5 * (corner[i] + corner[j]) for i, j in _QUAD_EDGES])
    nodes = np.concatenate([corner, apex, base, 0.5 * (corner + apex)])
    h = 1.0 - nodes[:, 2:3]
    safe = np.where(h > 0.0, h, 1.0)
    values, _ = _pyramid_basis(nodes[:, 0:1], nodes[:, 1:2], safe, np.ones_like(h))
    at_apex = np.array([1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0], dtype=float)
    values[4] = at_apex
    return np.linalg.inv(values)


def _area_coordinates(p: Floats) -> tuple[Floats, Floats]:
    L = np.column_stack([1.0 - p[:, 0] - p[:, 1], p[:, 0], p[:, 1]])
    d = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
    return L, np.broadcast_to(d, (len(p), 2, 3))


def _hexa_edges() -> Ints:
    low = list(_QUAD_EDGES)
    upright = [(i, i + 4) for i in range(4)]
    high = [(i + 4, j + 4) for i, j in _QUAD_EDGES]
    return np.array(low + upright + high)


def _penta_edges() -> Ints:
    low = list(_TRIA_EDGES)
    upright = [(i, i + 3) for i in range(3)]
    high = [(i + 3, j + 3) for i, j in _TRIA_EDGES]
    return np.array(low + upright + high)


def _tetra_edges() -> Ints:
    return np.array([*_TRIA_EDGES, (0, 3), (1, 3), (2, 3)])


def _pyramid_edges() -> Ints:
    return np.array([*_QUAD_EDGES, (0, 4), (1, 4), (2, 4), (3, 4)])


_NONE = np.zeros((0, 2), dtype=np.int64)
HEXA8 = Solid(8, _NONE, hexa8, *gauss_hexa(2), *gauss_hexa(2))
HEXA20 = Solid(20, _hexa_edges(), hexa20, *gauss_hexa(3), *gauss_hexa(3))
PENTA6 = Solid(6, _NONE, penta6, *gauss_wedge(3, 2), *gauss_wedge(7, 2))
PENTA15 = Solid(15, _penta_edges(), penta15, *gauss_wedge(7, 3), *gauss_wedge(7, 3))
TETRA4 = Solid(4, _NONE, tetra4, *gauss_tetra(1), *gauss_tetra(4))
TETRA10 = Solid(10, _tetra_edges(), tetra10, *gauss_tetra(5), *gauss_tetra(15))
PYRAMID5 = Solid(5, _NONE, pyramid5, *gauss_pyramid(2), *gauss_pyramid(2))
PYRAMID13 = Solid(13, _pyramid_edges(), pyramid13, *gauss_pyramid(3), *gauss_pyramid(3))
