"""Two sensors whose readings are exchanged, whole nodes or single directions of them.

A file gives each reading as a vector; which way along its line a lone sensor looks is not kept.
So two lone sensors that look opposite ways seem to be exchanged and wired backwards both.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.special import logsumexp

from ...arrays import Floats
from .fault_hypotheses import Alternative, Before
from .node_likelihood import Node, averaged, likelihood_of
from .sensor_numbers import SENSORS


@dataclass(frozen=True)
class Swap:
    """Rows of two nodes exchanged.

    `odds` is the log of how much more likely this is than all that the two nodes may be alone;
    `sign` is -1 where both read the opposite of what the other should; `worse` is the same log for
    that of the two which is the less so, the chance of a swap left out.
    """

    nodes: tuple[int, int]
    rows: tuple[tuple[int, ...], tuple[int, ...]]
    sign: float
    odds: float
    worse: float


def swaps(
    nodes: Mapping[int, Node],
    among: Sequence[int],
    alone: Mapping[int, Sequence[Alternative]],
    before: Before,
) -> list[Swap]:
    """Return the possible swaps among some nodes, the likeliest first."""
    total = {i: float(logsumexp([a.log for a in alone[i]])) for i in among}
    n = len(nodes)
    prior = float(np.log(before.faulty * SENSORS.swapped / max(n - 1, 1)))
    out = []
    for i, j in combinations(among, 2):
        ways = _ways(nodes[i].reading.shape[1], nodes[j].reading.shape[1])
        one = _crossed(nodes[i], nodes[j], [w[:3] for w in ways], before.shares) - total[i]
        back = [(b, a, s) for a, b, s, _ in ways]
        other = _crossed(nodes[j], nodes[i], back, before.shares) - total[j]
        for (a, b, sign, share), *each in zip(ways, one, other, strict=True):
            odds = float(sum(each)) + prior + float(np.log(share))
            out.append(Swap((i, j), (a, b), sign, odds, float(min(each))))
    return sorted(out, key=lambda s: -s.odds)


_Rows = tuple[int, ...]


def _ways(k: int, m: int) -> list[tuple[_Rows, _Rows, float, float]]:
    """Rows of sets with k and m directions that may be exchanged, the sign, and the share."""
    if k * m == 1:
        return [((0,), (0,), 1.0, 1.0 - SENSORS.back_lone), ((0,), (0,), -1.0, SENSORS.back_lone)]
    whole = [(tuple(range(k)), tuple(range(k)), 1.0, SENSORS.whole_swap)] if k == m else []
    share = (1.0 - SENSORS.whole_swap if k == m else 1.0) / (k * m)
    single = [
        ((a,), (b,), sign, share * chance)
        for a in range(k)
        for b in range(m)
        for sign, chance in ((1.0, 1.0 - SENSORS.back), (-1.0, SENSORS.back))
    ]
    return [*whole, *single]


def _crossed(
    node: Node, other: Node, ways: Sequence[tuple[_Rows, _Rows, float]], shares: Floats
) -> Floats:
    """Log likelihoods of a node some of whose rows read what rows of another should, (n,)."""
    k = node.reading.shape[1]
    mean = np.repeat(node.mean[None, :, :k], len(ways), axis=0)
    C = np.repeat(node.covariance[None, :, :k, :k], len(ways), axis=0)
    for g, (rows, others, sign) in enumerate(ways):
        own, far = np.array(rows), np.array(others)
        mean[g][:, own] = sign * other.mean[:, far]
        C[g][:, own, :] = 0.0
        C[g][:, :, own] = 0.0
        C[g][:, own[:, None], own] = other.covariance[:, far[:, None], far]
    return averaged(likelihood_of(node, mean, C), shares)
