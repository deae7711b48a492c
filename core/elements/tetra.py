"""Tetrahedra as Nastran's CTETRA, four and ten nodes.

Four nodes: constant strain. Ten nodes: five points, exact for straight edges; with a curved one
this is MSC Nastran's matrix to seven digits.
"""

import numpy as np

from ..arrays import Floats
from ..data.shapes import TETRA
from .middle_nodes import quadratic
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
    return quadratic(*tetra4(p), _EDGES)


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
