"""An attached mass: equipment, a bracket, ballast, a sensor's own mass."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats, Ints
from ..candidates import Candidates
from ..laws import MassLaw
from ..structure import Structure
from .bars import bare_bars
from .patches import Patch, PatchCandidates, patches_of
from .scale import Scale

_FEET = (0.024, 0.034, 0.048)
"""Radii of the footprint of a mass, beside the size of the structure."""
_SHELLS = ("quad", "tria")


def candidates(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Masses at points, and masses on small patches of shells.

    Points are grids and the middles of shells, their edges and bars. Equipment has a footprint,
    and a thin shell gives under a point far more than under a foot, so small patches count as well.
    """
    points, xyz, grids = points_of(structure)
    at_points = Candidates(
        kind="point_mass",
        xyz=xyz,
        law=MassLaw(),
        trials=scale.masses(),
        root=translations(structure, points),
        rows_each=3,
        where=tuple({"grids": g} for g in grids),
        typical=np.array([np.log(0.03 * scale.mass)]),
        spread=np.array([1.5]),
    )
    feet = patches_of(structure, scale.size, _FEET)
    if not feet:
        return (at_points,)
    on_feet = PatchCandidates(
        kind="point_mass",
        xyz=np.array([p.xyz for p in feet]),
        law=MassLaw(),
        trials=scale.masses(),
        root=sp.csr_matrix((0, structure.model.n_free)),
        rows_each=0,
        where=_grids(structure, feet),
        described=_grids,
        typical=np.array([np.log(0.03 * scale.mass)]),
        spread=np.array([1.5]),
        extra={"structure": structure, "patches": feet},
    )
    return (at_points, on_feet)


def _grids(structure: Structure, feet: Sequence[Patch]) -> tuple[dict[str, list[int]], ...]:
    ids = structure.model.geometry.ids
    corners = [structure.members[p.member].corners[p.rows] for p in feet]
    return tuple({"grids": ids[np.unique(c)].tolist()} for c in corners)


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
        if m.shape:
            used[m.corners.ravel()] = True
    own = np.flatnonzero(carries & used)
    weights = [
        sp.csr_matrix((np.ones(len(own)), (np.arange(len(own)), own)), (len(own), len(g.ids)))
    ]
    for m in structure.members:
        if m.shape in _SHELLS:
            weights.append(_means(m.corners, len(g.ids)))
            edges = np.stack([m.corners, np.roll(m.corners, -1, axis=1)], axis=-1).reshape(-1, 2)
            edges = np.unique(np.sort(edges, axis=1), axis=0)
            weights.append(_means(edges, len(g.ids)))
    for number, rows in bare_bars(structure):
        weights.append(_means(structure.members[number].corners[rows, :2], len(g.ids)))
    P = sp.vstack(weights).tocsr()
    grids = [g.ids[c].tolist() for c in np.split(P.indices, P.indptr[1:-1])]
    return P, np.asarray(P @ g.xyz), grids


def _means(corners: Ints, n_grid: int) -> sp.csr_matrix:
    """Rows that take the mean of some grids, (n, n_grid)."""
    n, k = corners.shape
    where = (np.repeat(np.arange(n), k), corners.ravel())
    return sp.csr_matrix((np.full(n * k, 1.0 / k), where), (n, n_grid))


def translations(structure: Structure, points: sp.csr_matrix) -> sp.csr_matrix:
    """Rows (3 n_point, n_free): the translations of points given by grid weights."""
    model = structure.model
    rows = model.geometry.index_of(model.dofs.node)
    pick = []
    for component in (1, 2, 3):
        which = np.flatnonzero((model.dofs.component == component) & (rows >= 0))
        pick.append(
            sp.csr_matrix(
                (np.ones(len(which)), (rows[which], which)),
                (len(model.geometry.ids), len(model.dofs)),
            )
        )
    stacked = sp.vstack([points @ S for S in pick]).tocsr()
    order = np.arange(3 * points.shape[0]).reshape(3, -1).T.ravel()
    return (stacked[order] @ model.expansion).tocsr()
