"""Second-order elements with some middle nodes left out."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats, Ints, Numbers
from .batch import congruent


def fill_middle_nodes(xyz: Floats, edges: Ints, present: Numbers) -> Floats:
    """Positions with every missing middle node put half-way between the ends of its edge.

    Parameters
    ----------
    xyz : (n, k, 3) float
        Corners, then middle nodes; what stands at a missing one does not matter.
    edges : (m, 2) int
        Ends of the edge of each middle node; k - m corners.
    present : (n, m) bool
        Which middle nodes exist.
    """
    corners = xyz.shape[1] - len(edges)
    half = 0.5 * (xyz[:, edges[:, 0]] + xyz[:, edges[:, 1]])
    out = np.array(xyz, dtype=float)
    out[:, corners:] = np.where(np.asarray(present)[..., None], xyz[:, corners:], half)
    return out


def drop_middle_nodes(matrix: Floats, edges: Ints, present: Numbers) -> Floats:
    """Tie each missing middle node to the mean of the ends of its edge.

    Its rows and columns become zero; for `matrix` (n, k d, k d) of d freedoms a node.
    """
    present = np.asarray(present, bool)
    n, m = present.shape
    corners = int(edges.max()) + 1
    k = corners + m
    d = matrix.shape[1] // k
    T = np.zeros((n, k, d, k, d))
    for i in range(d):
        for node in range(corners):
            T[:, node, i, node, i] = 1.0
        for middle, (a, b) in enumerate(edges):
            node = corners + middle
            there = present[:, middle]
            T[:, node, i, node, i] = there
            T[:, node, i, a, i] = np.where(there, 0.0, 0.5)
            T[:, node, i, b, i] = np.where(there, 0.0, 0.5)
    return congruent(matrix, T.reshape(n, k * d, k * d))
