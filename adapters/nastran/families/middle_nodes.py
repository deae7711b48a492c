"""Second-order elements with some middle nodes left out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ....core.arrays import Floats, Ints
from ..cards import Card


def by_pattern(cards: Sequence[Card], corners: int) -> dict[tuple[bool, ...], list[Card]]:
    """Sort elements by which middle nodes they have; () where they have none."""
    out: dict[tuple[bool, ...], list[Card]] = {}
    for card in cards:
        present = tuple(bool(n) for n in card.nodes[corners:])
        out.setdefault(present if any(present) else (), []).append(card)
    return out


def kept_nodes(present: Sequence[bool], corners: int, n_node: int) -> Any:
    """Which of the nodes are there, (n_node,) bool."""
    kept = np.zeros(n_node, dtype=bool)
    kept[:corners] = True
    kept[corners : corners + len(present)] = present
    return kept


def nodes_of(cards: Sequence[Card], kept: Any) -> list[list[int]]:
    """Node numbers that are there, one list an element."""
    return [[n for n, there in zip(c.nodes, kept, strict=False) if there] for c in cards]


def spread(edges: Ints, kept: Any) -> Floats | None:
    """Values at all nodes from those that are there: a missing one takes the mean of its edge.

    Parameters
    ----------
    edges : (m, 2) int
        Ends of the edge of each middle node.
    kept : (n_node,) bool
        Which nodes are there.

    Returns
    -------
    (n_node, n_there) float or None
        None where all are there.
    """
    if kept.all():
        return None
    n = len(kept)
    corners = n - len(edges)
    columns = np.cumsum(kept) - 1
    T = np.zeros((n, int(kept.sum())))
    for node in range(n):
        if kept[node]:
            T[node, columns[node]] = 1.0
        else:
            for end in edges[node - corners]:
                T[node, columns[end]] += 0.5
    return T
