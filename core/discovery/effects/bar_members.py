"""Bars of a frame, from one joint to the next, and stretches of them."""

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import depth_first_order

from ...arrays import Bools, Floats, Ints
from ..reduction.elements_and_supports import Structure, connected, unit, used
from .effect_numbers import EFFECTS
from .element_patches import Patch


def bars_of(structure: Structure, size: float) -> list[Patch]:
    """Every bar of a frame, and stretches of it one element long and more.

    Bars are the line elements from one joint to the next, off the shells. The first scan looks at
    whole bars, and at stretches of a bar that is itself most of the `size` of the structure.
    """
    own = _bars(structure)
    least = 1
    while sum(len(_stretches(len(rows), least)) for _, rows in own) > EFFECTS.bar_stretches:
        least += 1
    out = []
    for number, rows in own:
        m = structure.members[number]
        xyz = structure.centroids(m)
        ends = structure.model.geometry.xyz[m.corners[rows, :2]]
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        whole = float(length.sum())
        out.append(Patch(number, np.sort(rows), xyz[rows].mean(axis=0), True))
        for a, b in _stretches(len(rows), least):
            part, extent = rows[a:b], float(length[a:b].sum())
            low, high = (size * share for share in EFFECTS.bar_first)
            first = whole > EFFECTS.bar_long * size and low <= extent <= high
            out.append(Patch(number, np.sort(part), xyz[part].mean(axis=0), first))
    return out


def bare_bars(structure: Structure) -> list[tuple[int, Ints]]:
    """Return number of the member and rows of line elements that bend, off the shells."""
    on_shell = used(structure, 2)
    return [
        (number, np.flatnonzero(~on_shell[m.corners[:, :2]].all(axis=1)))
        for number, m in enumerate(structure.members)
        if m.element.dimension == 1 and m.element.freedoms == 6
    ]


def _bars(structure: Structure) -> list[tuple[int, Ints]]:
    """Return number of the member and rows, in order, of the elements of each bar."""
    g = structure.model.geometry
    count = np.zeros(len(g.ids), np.int64)
    for m in structure.members:
        if m.element.dimension == 1:
            np.add.at(count, m.corners[:, :2].ravel(), 1)
    through = (count == 2) & ~used(structure, 2)
    return [
        (number, free[rows])
        for number, free in bare_bars(structure)
        for rows in _chains(structure.members[number].corners[free, :2], through, g.xyz)
    ]


def _stretches(n: int, least: int) -> list[tuple[int, int]]:
    """Return begin and end of stretches of a bar of n elements, `least` elements long and more.

    Their lengths are those of Fibonacci, and they overlap by two thirds.
    """
    out = []
    length, longer = 1, 2
    while length < n:
        if length >= least:
            step = max(1, length // 3)
            out += [(start, start + length) for start in range(0, n - length + 1, step)]
        length, longer = longer, length + longer
    return out


def _chains(ends: Ints, through: Bools, xyz: Floats) -> list[Ints]:
    """Rows of line elements that continue each other straight, in their order.

    They do so at nodes with nothing else.
    """
    n = len(ends)
    order = np.argsort(ends.ravel(), kind="stable")
    nodes = ends.ravel()[order]
    pairs = np.flatnonzero((nodes[1:] == nodes[:-1]) & through[nodes[1:]])
    along = unit(xyz[ends[:, 1]] - xyz[ends[:, 0]])
    rows, columns = order[pairs] // 2, order[pairs + 1] // 2
    straight = np.abs(np.sum(along[rows] * along[columns], axis=1)) > EFFECTS.straight
    rows, columns = rows[straight], columns[straight]
    graph = sp.csr_matrix((np.ones(len(rows)), (rows, columns)), (n, n))
    neighbours = np.bincount([*rows, *columns], minlength=n)
    out = []
    for own in connected(n, rows, columns):
        start = int(own[np.argmin(neighbours[own])])
        out.append(depth_first_order(graph, start, directed=False, return_predecessors=False))
    return out
