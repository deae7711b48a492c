"""A support that gives: a clamp that is not rigid, a foot that turns, an edge that moves."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ...arrays import Floats, Ints
from ..candidates import Candidates
from ..laws import ReleaseLaw, directions
from ..structure import Structure, Supports, thinned
from .scale import Scale

_STRETCHES = (0.06, 0.12, 0.2)
"""Half lengths of stretches of an edge, beside the size of the structure."""
_TOGETHER = ((4, 5, 6), (1, 2, 3))
_STRAIGHT = 1e-9


def candidates(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Give supports a finite stiffness.

    Every fixed direction of a support alone, all rotations or translations alike, and one
    direction over stretches of supports that are neighbours. The stiffness counts over all grids
    of a place, for each of its directions.
    """
    s = structure.supports
    if s is None or not len(s.grid):
        return ()
    made = [_released(s, list(_joined(s, components))) for components in _TOGETHER]
    for c in np.unique(s.component):
        own = np.flatnonzero(s.component == c)
        made.append(_released(s, [np.array([i]) for i in own]))
        made.append(_released(s, list(_stretches(s, own, scale.size))))
    return tuple(c for c in made if c is not None)


def _joined(s: Supports, components: tuple[int, ...]) -> Iterator[Ints]:
    """Rows of several directions of one support."""
    for grid in np.unique(s.grid):
        rows = np.flatnonzero((s.grid == grid) & np.isin(s.component, components))
        if len(rows) > 1:
            yield rows


def _stretches(s: Supports, own: Ints, size: float) -> Iterator[Ints]:
    """Rows over neighbouring supports among the rows `own`, several lengths."""
    tree = cKDTree(s.xyz[own])
    seen = set()
    for half in _STRETCHES:
        for i in thinned(s.xyz[own], 0.35 * half * size):
            rows = own[sorted(tree.query_ball_point(s.xyz[own[i]], half * size))]
            if len(rows) > 1 and rows.tobytes() not in seen:
                seen.add(rows.tobytes())
                yield rows


def _released(s: Supports, places: list[Ints]) -> Candidates | None:
    """Make candidates of groups of fixed directions.

    A group is released along the principal directions of its own stiffness, each of which then
    is a release by itself. The stiffness of n grids is n times that of one.
    """
    if not places:
        return None
    most = max(len(rows) for rows in places)
    n = len(places)
    own = np.ones((n, most))
    elastic = np.zeros((n, most, len(s.slopes)))
    turns, where, xyz = [], [], []
    for i, rows in enumerate(places):
        grids, q = np.unique(s.grid[rows]), len(rows)
        C = s.coupling[rows][:, rows].toarray()
        (d,), (W,) = directions(C[None], 0)
        d = np.maximum(d, _STRAIGHT * d[-1])
        own[i, :q] = d * len(grids)
        for k, slope in enumerate(s.slopes):
            change = slope[rows][:, rows].toarray()
            elastic[i, :q, k] = np.einsum("ai,ij,aj->a", W, change, W) / d
        turns.append(_block(W * np.sqrt(len(grids)), rows, i * most, (n * most, len(s.grid))))
        xyz.append(s.xyz[rows].mean(axis=0))
        components = sorted({int(c) for c in s.component[rows]})
        where.append({"grids": [int(g) for g in grids], "components": components})
    typical = float(np.median(np.log(own[:, 0])))
    together = sum(turns[1:], turns[0])
    return Candidates(
        kind="support_flexibility",
        xyz=np.array(xyz),
        law=ReleaseLaw(own, elastic, np.zeros(len(s.slopes))),
        trials=(typical + np.log([0.001, 0.006, 0.04, 0.25, 2.0]))[:, None],
        root=(together @ s.root).tocsr(),
        rows_each=most,
        where=tuple(where),
        typical=np.array([typical - 2.5]),
        spread=np.array([2.5]),
        extra={"loads": s.root, "turns": together},
    )


def _block(W: Floats, rows: Ints, start: int, shape: tuple[int, int]) -> sp.csr_matrix:
    """Put W as rows from `start` on, over the columns `rows`."""
    k = len(rows)
    at = (np.repeat(start + np.arange(k), k), np.tile(rows, k))
    return sp.csr_matrix((W.ravel(), at), shape)
