"""Two sensors whose readings are exchanged, whole nodes or single directions of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.special import logsumexp

from ..arrays import Floats
from .alternatives import Alternative, Before
from .readings import Node, evidence

_SHARE = 0.25
_WHOLE = 0.7
"""Of swaps of sets with several directions, those of the whole set."""


@dataclass(frozen=True)
class Swap:
    """Rows of two nodes exchanged.

    `odds` is the log of how much more likely this is than all that the two nodes may be alone.
    """

    nodes: tuple[int, int]
    rows: tuple[tuple[int, ...], tuple[int, ...]]
    odds: float


def swaps(
    nodes: Mapping[int, Node],
    among: Sequence[int],
    alone: Mapping[int, Sequence[Alternative]],
    before: Before,
) -> list[Swap]:
    """Return the possible swaps among some nodes, the likeliest first.

    Parameters
    ----------
    nodes : mapping of int to Node
    among : sequence of int
    alone : mapping of int to sequence of Alternative
    before : Before
    """
    total = {i: float(logsumexp([a.log for a in alone[i]])) for i in among}
    n = len(nodes)
    out = []
    for i, j in combinations(among, 2):
        k, m = nodes[i].reading.shape[1], nodes[j].reading.shape[1]
        ways: list[tuple[tuple[int, ...], tuple[int, ...], float]] = []
        if k == m:
            ways.append((tuple(range(k)), tuple(range(k)), 1.0 if k == 1 else _WHOLE))
        if k * m > 1:
            share = (1.0 - _WHOLE if k == m else 1.0) / (k * m)
            ways += [((a,), (b,), share) for a in range(k) for b in range(m)]
        prior = float(np.log(before.faulty * _SHARE / max(n - 1, 1)))
        for a, b, share in ways:
            log = _crossed(nodes[i], a, nodes[j], b, before.shares)
            log += _crossed(nodes[j], b, nodes[i], a, before.shares)
            out.append(Swap((i, j), (a, b), log + prior + np.log(share) - total[i] - total[j]))
    return sorted(out, key=lambda s: -s.odds)


def _crossed(
    node: Node, rows: tuple[int, ...], other: Node, others: tuple[int, ...], shares: Floats
) -> float:
    """Log likelihood of a node some of whose rows read what rows of another should."""
    k = node.reading.shape[1]
    mean, C = node.mean[:, :k].copy(), node.covariance[:, :k, :k].copy()
    own, far = np.array(rows), np.array(others)
    mean[:, own] = other.mean[:, far]
    C[:, own, :] = 0.0
    C[:, :, own] = 0.0
    C[:, own[:, None], own] = other.covariance[:, far[:, None], far]
    crossed = Node(mean, C, node.reading, node.noise)
    return float(evidence(crossed, np.eye(k)[None], shares)[0])
