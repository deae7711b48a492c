"""Two sensors whose readings are exchanged, whole nodes or single directions of them.

A file gives each reading as a vector; which way along its line a lone sensor looks is not kept.
So two lone sensors that look opposite ways seem to be exchanged and wired backwards both.
"""

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
_LONE_BACK, _BACK = 0.5, 0.15
"""Of swaps of lone sensors and of single directions of sets, those with the sign turned."""
_WHOLE = 0.7
"""Of swaps of sets with several directions, those of the whole set."""


@dataclass(frozen=True)
class Swap:
    """Rows of two nodes exchanged.

    `odds` is the log of how much more likely this is than all that the two nodes may be alone;
    `sign` is -1 where both read the opposite of what the other should.
    """

    nodes: tuple[int, int]
    rows: tuple[tuple[int, ...], tuple[int, ...]]
    sign: float
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
            back = _LONE_BACK if k * m == 1 else _BACK if len(a) == 1 else 0.0
            for sign, chance in ((1.0, 1.0 - back), (-1.0, back)):
                if not chance:
                    continue
                log = _crossed(nodes[i], a, nodes[j], b, sign, before.shares)
                log += _crossed(nodes[j], b, nodes[i], a, sign, before.shares)
                log += prior + float(np.log(share * chance)) - total[i] - total[j]
                out.append(Swap((i, j), (a, b), sign, log))
    return sorted(out, key=lambda s: -s.odds)


def _crossed(
    node: Node,
    rows: tuple[int, ...],
    other: Node,
    others: tuple[int, ...],
    sign: float,
    shares: Floats,
) -> float:
    """Log likelihood of a node some of whose rows read what rows of another should."""
    k = node.reading.shape[1]
    mean, C = node.mean[:, :k].copy(), node.covariance[:, :k, :k].copy()
    own, far = np.array(rows), np.array(others)
    mean[:, own] = sign * other.mean[:, far]
    C[:, own, :] = 0.0
    C[:, :, own] = 0.0
    C[:, own[:, None], own] = other.covariance[:, far[:, None], far]
    crossed = Node(mean, C, node.reading, node.noise)
    return float(evidence(crossed, np.eye(k)[None], shares)[0])
