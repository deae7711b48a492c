"""Points of a structure at which an effect may sit, and how they move."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp

from ...arrays import Bools, Floats, Ints
from ..reduction.elements_and_supports import Structure, unit, used
from .bar_members import bare_bars
from .effect_numbers import EFFECTS


class Points(NamedTuple):
    """Points of a structure.

    Parameters
    ----------
    moves : (3 n, n_free) sparse
        Their translations along the basic axes.
    xyz : (n, 3) float
    where : list of dict
        ``grids`` whose motion each follows; of one that a single grid carries at a distance
        ``arms``, a list of the one from it (3,).
    """

    moves: sp.csr_matrix
    xyz: Floats
    where: list[dict[str, Any]]

    @property
    def at_grids(self) -> Ints:
        """Numbers of those that are grids."""
        own = (len(w["grids"]) == 1 and "arms" not in w for w in self.where)
        return np.flatnonzero(np.fromiter(own, bool, len(self.where)))

    def of(self, which: Ints) -> Points:
        """Return some of them."""
        rows = (3 * which[:, None] + np.arange(3)).ravel()
        return Points(self.moves[rows], self.xyz[which], [self.where[i] for i in which.tolist()])


def points_of(structure: Structure) -> Points:
    """Return grids, the middles of shells and of their edges, and points along bars off the shells.

    Between its grids a shell moves as their rotations say (Hermite's cubic): a mode of four
    elements a wave moves twice as far at the middle of an element as its corners do on average.
    Bars have a point at their middle and, coarse ones, one at either quarter, which the grid next
    to it carries: to the shortest waves of a test half the side of an element is far.
    """
    g = structure.model.geometry
    moving = np.asarray(abs(structure.model.expansion).sum(axis=1)).ravel() > 0.0
    carries = np.zeros(len(g.ids), bool)
    rows = g.index_of(structure.model.dofs.node)
    carries[rows[moving & (rows >= 0)]] = True
    own = np.flatnonzero(carries & used(structure))
    own = own[structure.in_order(g.xyz[own])]
    grids = [own[:, None]]
    bent = [np.zeros((len(own), 3, 3))]
    for m in structure.members:
        if m.element.dimension == 2:
            diagonals = g.xyz[m.corners[:, [2, -1]]] - g.xyz[m.corners[:, [0, 1]]]
            normal = unit(np.cross(diagonals[:, 0], diagonals[:, 1]))
            edges = np.stack([m.corners, np.roll(m.corners, -1, axis=1)], axis=-1).reshape(-1, 2)
            edges, first = np.unique(np.sort(edges, axis=1), axis=0, return_index=True)
            for corners, across in (
                (m.corners, normal),
                (edges, normal[first // m.corners.shape[1]]),
            ):
                order = structure.in_order(g.xyz[corners].mean(axis=1))
                grids.append(corners[order])
                bent.append(across[order, :, None] * across[order, None, :])
    for number, rows in bare_bars(structure):
        corners = structure.members[number].corners[rows, :2]
        grids.append(corners[structure.in_order(g.xyz[corners].mean(axis=1))])
        bent.append(np.tile(np.eye(3), (len(corners), 1, 1)))
    between = sum(map(len, grids))
    carrying, arms = _arms(structure, carries)
    grids.append(carrying[:, None])
    bent.append(np.tile(2.0 * np.eye(3), (len(arms), 1, 1)))
    P = sp.vstack([_means(rows, len(g.ids)) for rows in grids]).tocsr()
    xyz = np.asarray(P @ g.xyz)
    xyz[between:] += arms
    bows = _bows(P, xyz, g.xyz, np.concatenate(bent))
    every = sp.identity(len(g.ids), format="csr")
    moves = (translations(structure, P) + bows @ rotations(structure, every)).tocsr()
    ids = g.ids[P.indices].tolist()
    where: list[dict[str, Any]] = [{"grids": ids[a:b]} for a, b in pairwise(P.indptr.tolist())]
    where[between:] = [
        {**w, "arms": [tuple(a)]} for w, a in zip(where[between:], arms.tolist(), strict=True)
    ]
    return Points(moves, xyz, where)


def _arms(structure: Structure, carries: Bools) -> tuple[Ints, Floats]:
    """Return rows of the grids that carry the quarter points of bars, and how far off, (n, 3)."""
    g = structure.model.geometry
    bars = [structure.members[k].corners[rows, :2] for k, rows in bare_bars(structure)]
    one = np.concatenate([np.zeros((0, 2), np.int64), *bars])
    ends = np.concatenate([one, one[:, ::-1]])
    length = np.linalg.norm(g.xyz[ends[:, 1]] - g.xyz[ends[:, 0]], axis=1)
    ends = ends[carries[ends[:, 0]] & (length > EFFECTS.bar_coarse * g.size)]
    arms = EFFECTS.bar_point * (g.xyz[ends[:, 1]] - g.xyz[ends[:, 0]])
    order = structure.in_order(g.xyz[ends[:, 0]] + arms)
    return ends[order, 0], arms[order]


def _bows(P: sp.csr_matrix, points: Floats, xyz: Floats, bent: Floats) -> sp.csr_matrix:
    """Return how far the rotations of grids move points, (3 n, 3 n_grid).

    Half the mean of what each grid alone, turning rigidly, would move the point by, times `bent`
    (n, 3, 3): across shells, not in their plane; twice that of one that a single grid carries.
    """
    W = P.tocoo()
    lever = 0.5 * W.data[:, None] * (points[W.row] - xyz[W.col])
    turned = np.cross(np.eye(3), lever[:, None, :]).transpose(0, 2, 1)
    rows, columns = (3 * k[:, None] + np.arange(3) for k in (W.row, W.col))
    where = np.repeat(rows, 3, axis=1).ravel(), np.tile(columns, 3).ravel()
    shape = (3 * P.shape[0], 3 * P.shape[1])
    return sp.csr_matrix((np.matmul(bent[W.row], turned).ravel(), where), shape)


def _means(corners: Ints, n_grid: int) -> sp.csr_matrix:
    """Rows that take the mean of some grids, (n, n_grid)."""
    n, k = corners.shape
    where = (np.repeat(np.arange(n), k), corners.ravel())
    return sp.csr_matrix((np.full(n * k, 1.0 / k), where), (n, n_grid))


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
        ``grids``, ``components`` and ``arms`` of each, see `Points`.
    """

    xyz: Floats
    root: sp.csr_matrix
    where: tuple[dict[str, Any], ...]


def along_axes(points: Points) -> Axes:
    """Return the basic axes along which points move."""
    root, xyz, places = points
    live = np.flatnonzero(np.diff(root.indptr) > 0)
    where = tuple({**places[k // 3], "components": [k % 3 + 1]} for k in live.tolist())
    return Axes(xyz[live // 3], root[live], where)
