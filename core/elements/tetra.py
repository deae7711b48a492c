"""Tetrahedra as Nastran's CTETRA, four and ten nodes.

Four nodes: constant strain. Ten nodes: five points, exact for straight edges; with a curved one
this is MSC Nastran's matrix to seven digits.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Floats
from ..data.shapes import TETRA
from .quadrature import gauss_tetra
from .solid import Solid, pointed_edges

_EDGES = pointed_edges(3)


def tetra4(p: Floats) -> tuple[Floats, Floats]:
    """Volume coordinates."""
    N = np.column_stack([1.0 - p.sum(axis=1), p])
    d = np.column_stack([-np.ones(3), np.eye(3)])
    return N, np.broadcast_to(d, (len(p), 3, 4))


def tetra10(p: Floats) -> tuple[Floats, Floats]:
    """Quadratic shape functions of the tetrahedron."""
    L, dL = tetra4(p)
    edges = _EDGES
    a, b = edges[:, 0], edges[:, 1]
    N = np.concatenate([L * (2.0 * L - 1.0), 4.0 * L[:, a] * L[:, b]], axis=1)
    middle = 4.0 * (dL[:, :, a] * L[:, None, b] + dL[:, :, b] * L[:, None, a])
    return N, np.concatenate([dL * (4.0 * L - 1.0)[:, None], middle], axis=2)


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
    edges=_EDGES,
    interpolation=tetra10,
    rules={"full": gauss_tetra(5)},
    mass_rule=gauss_tetra(15),
)
