"""Nested dissection of a graph: what a bulky body asks for, where minimum degree fills too much."""

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import breadth_first_order, connected_components, dijkstra, maximum_flow

from ..arrays import Ints, Numbers

_MIDDLE = 0.5
"""Part of the weight, half way between two ends, in which the separator is looked for."""
_PLANAR = 2.0
"""Nodes of a separator beside the root of all nodes up to which a graph is a surface or a line."""
_SMOOTHED = 10
"""Times that how far along a node is becomes the mean of its neighbours."""
_FEW = 300
"""Nodes that are not worth dissecting."""

Order = Callable[[sp.csr_matrix, Ints], Ints]


def dissected(graph: sp.csr_matrix, weight: Ints, undivided: Order) -> Ints:
    """Return an order of the nodes of a graph, (n_node,): as to be eliminated.

    The graph falls into two parts and a separator, which comes last; the parts likewise, until
    their separators are as small as those of surfaces, on which minimum degree fills no more
    (George 1973, *Nested dissection of a regular finite element mesh*; Lipton, Rose and Tarjan
    1979, *Generalized nested dissection*).

    Parameters
    ----------
    graph : (n_node, n_node) csr_matrix
        Symmetric pattern.
    weight : (n_node,) int
        Rows of each node.
    undivided : callable
        Orders a graph with weights that is not dissected.
    """
    _, piece = connected_components(graph, directed=False)
    few = np.bincount(piece) <= _FEW
    if few.all():
        return undivided(graph, weight)
    piece = np.where(few[piece], -1, piece)
    if np.ptp(piece):
        parts = [np.flatnonzero(piece == k) for k in np.unique(piece)]
        separator = np.zeros(0, np.int64)
    else:
        *parts, separator = _cut(graph, weight)
        if len(separator) <= _PLANAR * np.sqrt(len(weight)):
            return undivided(graph, weight)
    ordered = [p[dissected(graph[p][:, p], weight[p], undivided)] for p in parts]
    return np.concatenate([*ordered, separator])


def _cut(graph: sp.csr_matrix, weight: Ints) -> tuple[Ints, Ints, Ints]:
    """Two parts of a connected graph and the lightest separator near its middle; empty if none.

    Nodes count as far along as they are nearer to one of two ends, far apart, than to the other,
    smoothed, so that equal distances part, too.
    """
    side = np.zeros(len(weight), np.int64)
    one = int(dijkstra(graph, unweighted=True, indices=0).argmax())
    from_one = dijkstra(graph, unweighted=True, indices=one)
    along = from_one - dijkstra(graph, unweighted=True, indices=int(from_one.argmax()))
    mean = sp.diags(1.0 / np.diff(graph.indptr)) @ graph.astype(bool)
    for _ in range(_SMOOTHED):
        along = mean @ along
    order = np.argsort(along, kind="stable")
    share = np.cumsum(weight[order]) / weight.sum()
    side[order[share < 0.5 - _MIDDLE / 2]] = -1
    side[order[share > 0.5 + _MIDDLE / 2]] = 1
    before, separator = _least_separator(graph, weight, side)
    return np.flatnonzero(before), np.flatnonzero(~before & ~separator), np.flatnonzero(separator)


def _least_separator(graph: sp.csr_matrix, weight: Ints, side: Ints) -> tuple[Numbers, Numbers]:
    """Nodes before and on the lightest separator of sides -1 and 1 among those of side 0, (n,).

    By the largest flow from one side to the other, each node between passing its weight.
    """
    n = len(side)
    link = graph.tocoo()
    near, far = side[link.row], side[link.col]
    none = np.zeros(n, bool)
    if not side.any() or ((near < 0) & (far > 0)).any():
        return none, none
    source, sink = 2 * n, 2 * n + 1
    inner = (near == 0) & (far == 0) & (link.row != link.col)
    first = np.unique(link.col[(near < 0) & (far == 0)])
    last = np.unique(link.row[(near == 0) & (far > 0)])
    node = np.flatnonzero(side == 0)
    start = [node, n + link.row[inner], np.full(len(first), source), n + last]
    end = [n + node, link.col[inner], first, np.full(len(last), sink)]
    wide = np.full(inner.sum() + len(first) + len(last), weight.sum())
    capacity = np.concatenate([weight[node], wide]).astype(np.int32)
    at = (np.concatenate(start), np.concatenate(end))
    room = sp.csr_matrix((capacity, at), shape=(2 * n + 2,) * 2)
    left = (room - maximum_flow(room, source, sink).flow).tocsr()
    left.eliminate_zeros()
    reached = np.zeros(2 * n + 2, bool)
    reached[breadth_first_order(left, source, return_predecessors=False)] = True
    passed = (side < 0) | ((side == 0) & reached[n : 2 * n])
    return passed, reached[:n] & ~passed
