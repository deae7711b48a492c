"""Edges along which shells are held, and the stretches of them that may give."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...arrays import Bools, Floats, Ints
from ..reduction.elements_and_supports import Structure, Supports, connected, unit
from .effect_numbers import EFFECTS


@dataclass(frozen=True, eq=False)
class Edge:
    """Held grids in their order along an edge.

    Parameters
    ----------
    grids : (n,) int
        Grid numbers.
    xyz, along, normal : (n, 3) float
        Where they are, the direction of the edge there, the normal of its shells.
    """

    grids: Ints
    xyz: Floats
    along: Floats
    normal: Floats

    def stretches(self, size: float) -> Iterator[tuple[int, int, slice]]:
        """Return stretches of several grids that begin and end at one of a few places.

        The numbers of these places come first.
        """
        n = len(self.grids)
        ends = np.unique(np.linspace(0, n - 1, min(n, EFFECTS.edge_ends)).round().astype(int))
        length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(self.xyz, axis=0), axis=1))]
        for a, first in enumerate(ends):
            for b, last in enumerate(ends):
                if length[last] - length[first] > EFFECTS.edge_shortest * size:
                    yield a, b, slice(first, last + 1)


def edges_of(structure: Structure, s: Supports) -> list[Edge]:
    """Return the held edges of shells, each as far as it goes on without a bend.

    An edge is made of sides of shells both grids of which are held, of shells that are not held
    as a whole.
    """
    g = structure.model.geometry
    held = np.zeros(len(g.ids), bool)
    held[g.index_of(np.unique(s.grid))] = True
    ends, along, normal = _sides(structure, held)
    order = structure.in_order(g.xyz)
    rank = np.argsort(order)
    out = []
    for rows in _continued(ends, along, normal):
        sides, at = _walk(rank[ends[rows]])
        grids = order[sides]
        t, n = along[rows][at], normal[rows][at]
        out.append(Edge(g.ids[grids], g.xyz[grids], t, n))
    return out


def _sides(structure: Structure, held: Bools) -> tuple[Ints, Floats, Floats]:
    """Grids (n, 2) of the sides that are held, their directions and normals, (n, 3) each."""
    xyz = structure.model.geometry.xyz
    ends, normals = [np.zeros((0, 2), np.int64)], [np.zeros((0, 3))]
    for m in structure.members:
        if m.element.dimension != 2:
            continue
        corners = m.corners[~held[m.corners].all(axis=1)]
        x = xyz[corners]
        n = np.cross(x[:, 1] - x[:, 0], x[:, -1] - x[:, 0])
        for a in range(corners.shape[1]):
            side = np.sort(corners[:, [a - 1, a]], axis=1)
            on = held[side].all(axis=1)
            ends.append(side[on])
            normals.append(n[on])
    own, first = np.unique(np.vstack(ends), axis=0, return_index=True)
    along = xyz[own[:, 1]] - xyz[own[:, 0]]
    return own, unit(along), unit(np.vstack(normals)[first])


def _continued(ends: Ints, along: Floats, normal: Floats) -> list[Ints]:
    """Rows of sides that continue each other."""
    order = np.argsort(ends.ravel(), kind="stable")
    grids = ends.ravel()[order]
    first, last = [], []
    for group in np.split(order // 2, np.flatnonzero(np.diff(grids)) + 1):
        for k, a in enumerate(group):
            for b in group[k + 1 :]:
                straight = abs(float(along[a] @ along[b])) > EFFECTS.straight
                if straight and abs(float(normal[a] @ normal[b])) > EFFECTS.straight:
                    first.append(a)
                    last.append(b)
    return connected(len(ends), np.array(first, np.int64), np.array(last, np.int64))


def _walk(ends: Ints) -> tuple[Ints, Ints]:
    """Grids of sides in their order, a closed line opened anywhere, and a side of each."""
    at: dict[int, list[int]] = {}
    for k, pair in enumerate(ends.tolist()):
        for grid in pair:
            at.setdefault(grid, []).append(k)
    grid = min(at, key=lambda g: (len(at[g]), g))
    grids, sides, left = [grid], [at[grid][0]], set(range(len(ends)))
    while onward := [k for k in at[grid] if k in left]:
        k = onward[0]
        left.discard(k)
        grid = int(ends[k].sum() - grid)
        grids.append(grid)
        sides.append(k)
    if grids[0] == grids[-1]:
        grids, sides = grids[:-1], sides[:-1]
    return np.array(grids), np.array(sides)
