"""Points of a structure at which an effect may sit, and how they move."""

from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats, Ints
from ..reduction.elements_and_supports import Structure
from .bar_members import bare_bars


def points_of(structure: Structure) -> tuple[sp.csr_matrix, Floats, list[list[int]]]:
    """Weights (n_point, n_grid), positions and grids of the points of a structure.

    Grids, the middles of shells and of their edges, and those of bars off the shells.
    """
    g = structure.model.geometry
    moving = np.asarray(abs(structure.model.expansion).sum(axis=1)).ravel() > 0.0
    carries = np.zeros(len(g.ids), bool)
    rows = g.index_of(structure.model.dofs.node)
    carries[rows[moving & (rows >= 0)]] = True
    used = np.zeros(len(g.ids), bool)
    for m in structure.members:
        used[m.corners.ravel()] = True
    own = np.flatnonzero(carries & used)
    own = own[structure.in_order(g.xyz[own])]
    weights = [
        sp.csr_matrix((np.ones(len(own)), (np.arange(len(own)), own)), (len(own), len(g.ids)))
    ]
    for m in structure.members:
        if m.element.dimension == 2:
            weights.append(_means(m.corners, structure))
            edges = np.stack([m.corners, np.roll(m.corners, -1, axis=1)], axis=-1).reshape(-1, 2)
            edges = np.unique(np.sort(edges, axis=1), axis=0)
            weights.append(_means(edges, structure))
    for number, rows in bare_bars(structure):
        weights.append(_means(structure.members[number].corners[rows, :2], structure))
    P = sp.vstack(weights).tocsr()
    grids = [g.ids[c].tolist() for c in np.split(P.indices, P.indptr[1:-1])]
    return P, np.asarray(P @ g.xyz), grids


def _means(corners: Ints, structure: Structure) -> sp.csr_matrix:
    """Rows that take the mean of some grids, in an order of their own, (n, n_grid)."""
    xyz, (n, k) = structure.model.geometry.xyz, corners.shape
    corners = corners[structure.in_order(xyz[corners].mean(axis=1))]
    where = (np.repeat(np.arange(n), k), corners.ravel())
    return sp.csr_matrix((np.full(n * k, 1.0 / k), where), (n, len(xyz)))


def translations(structure: Structure, points: sp.csr_matrix) -> sp.csr_matrix:
    """Rows (3 n_point, n_free): the translations of points given by grid weights."""
    return _motion(structure, points, (1, 2, 3))


def rotations(structure: Structure, points: sp.csr_matrix) -> sp.csr_matrix:
    """Rows (3 n_point, n_free): the rotations of points given by grid weights."""
    return _motion(structure, points, (4, 5, 6))


def _motion(
    structure: Structure, points: sp.csr_matrix, components: tuple[int, int, int]
) -> sp.csr_matrix:
    model = structure.model
    rows = model.geometry.index_of(model.dofs.node)
    shape, pick = (len(model.geometry.ids), len(model.dofs)), []
    for component in components:
        which = np.flatnonzero((model.dofs.component == component) & (rows >= 0))
        pick.append(sp.csr_matrix((np.ones(len(which)), (rows[which], which)), shape))
    stacked = sp.vstack([points @ S for S in pick]).tocsr()
    order = np.arange(3 * points.shape[0]).reshape(3, -1).T.ravel()
    return (stacked[order] @ model.expansion).tocsr()


class Axes(NamedTuple):
    """Axes of points along which they move.

    Parameters
    ----------
    xyz : (n, 3) float
        Where, deck units.
    root : (n, n_free) sparse
        Row u of each: its motion.
    where : tuple of dict
        ``grids`` and ``components`` of each.
    """

    xyz: Floats
    root: sp.csr_matrix
    where: tuple[dict[str, Any], ...]


def along_axes(
    structure: Structure, points: sp.csr_matrix, xyz: Floats, grids: list[list[int]]
) -> Axes:
    """Return the basic axes along which points move that `points_of` returned."""
    root = translations(structure, points)
    live = np.flatnonzero(np.diff(root.indptr) > 0)
    at = live // 3
    where = tuple(
        {"grids": grids[i], "components": [int(c)]} for i, c in zip(at, live % 3 + 1, strict=True)
    )
    return Axes(xyz[at], root[live], where)
