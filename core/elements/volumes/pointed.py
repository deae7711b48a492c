"""Tetrahedra and pyramids as Nastran's CTETRA and CPYRAM, without and with middle nodes.

Tetrahedra of ten nodes: five points, exact for straight edges; with a curved one this is MSC
Nastran's matrix to seven digits.
"""

import numpy as np

from ...arrays import Floats, Ints
from ...data.shapes import PYRAMID, QUAD, TETRA
from ..middle_nodes import quadratic
from ..quadrature import gauss_pyramid, gauss_tetra
from .hexa import SQUARE
from .solid import Solid


def pointed_edges(k: int) -> Ints:
    """Edges of a face of `k` corners below an apex."""
    return np.array([(i, (i + 1) % k) for i in range(k)] + [(i, k) for i in range(k)])


def tetra4(p: Floats) -> tuple[Floats, Floats]:
    """Volume coordinates."""
    N = np.column_stack([1.0 - p.sum(axis=1), p])
    d = np.column_stack([-np.ones(3), np.eye(3)])
    return N, np.broadcast_to(d, (len(p), 3, 4))


def tetra10(p: Floats) -> tuple[Floats, Floats]:
    """Quadratic shape functions of the tetrahedron."""
    return quadratic(*tetra4(p), pointed_edges(3))


TETRA4 = Solid(
    name="tetra4",
    shape=TETRA,
    interpolation=tetra4,
    rules={"full": gauss_tetra(1)},
    mass_rule=gauss_tetra(4),
)
TETRA10 = Solid(
    name="tetra10",
    shape=TETRA,
    edges=pointed_edges(3),
    interpolation=tetra10,
    rules={"full": gauss_tetra(5)},
    mass_rule=gauss_tetra(15),
)


def pyramid5(p: Floats) -> tuple[Floats, Floats]:
    """Rational shape functions of the pyramid (Bedrosian 1992); base z = 0, apex z = 1."""
    corner = SQUARE
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
    corner = np.column_stack([SQUARE, np.zeros(4)])
    apex = np.array([[0.0, 0.0, 1.0]])
    base = np.array([0.5 * (corner[i] + corner[j]) for i, j in QUAD.sides])
    nodes = np.concatenate([corner, apex, base, 0.5 * (corner + apex)])
    h = 1.0 - nodes[:, 2:3]
    safe = np.where(h > 0.0, h, 1.0)
    values, _ = _pyramid_basis(nodes[:, 0:1], nodes[:, 1:2], safe, np.ones_like(h))
    at_apex = np.array([1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0], dtype=float)
    values[4] = at_apex
    return np.linalg.inv(values)


PYRAMID5 = Solid(
    name="pyramid5",
    unknown="interpolation",
    shape=PYRAMID,
    interpolation=pyramid5,
    rules={"full": gauss_pyramid(2)},
    mass_rule=gauss_pyramid(2),
)
PYRAMID13 = Solid(
    name="pyramid13",
    unknown="interpolation",
    shape=PYRAMID,
    edges=pointed_edges(4),
    interpolation=pyramid13,
    rules={"full": gauss_pyramid(3)},
    mass_rule=gauss_pyramid(3),
)
