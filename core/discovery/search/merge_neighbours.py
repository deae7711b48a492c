"""Two findings that are one: masses side by side, springs side by side, patches that overlap.

The catalogue has round and elongated patches and points; a mass of another shape comes out as two
of them. What a person is told is one effect with what both amount to.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .candidates import Candidates, Suspect
from .problem import Fit
from .search import Searcher

_NEAR = 0.09
"""Suspects of one nature nearer than this part of the structure are one."""
_MASSES = {"point_mass", "distributed_mass"}


def merged(searcher: Searcher, state: Fit) -> Fit:
    """Return a hypothesis with neighbours of one nature made one; the same if there are none.

    Masses and springs add up, at the place of the largest, a mass that is spread out in part as a
    whole; of patches of stiffness the one that
    changes most stays. Nothing is fitted again.
    """
    left = list(state.suspects)
    kept: list[Suspect] = []
    while left:
        first = max(left, key=lambda s: _size(searcher, s))
        left.remove(first)
        same = [s for s in left if _one(searcher, first, s)]
        left = [s for s in left if not any(s is t for t in same)]
        c = searcher.problem.catalogue[first.kind]
        if same and c.kind != "local_stiffness":
            total = np.sum([np.exp(s.theta) for s in (first, *same)], axis=0)
            spread = [s for s in (first, *same) if _is_spread(searcher, s)]
            first = max(spread or [first], key=lambda s: _size(searcher, s))
            first = first.moved(np.log(total))
        kept.append(first)
    return (
        state
        if len(kept) == len(state.suspects)
        else replace(state, suspects=tuple(kept), unseen=None, surplus=None, in_deck=None)
    )


def _is_spread(searcher: Searcher, s: Suspect) -> bool:
    return searcher.problem.catalogue[s.kind].kind == "distributed_mass"


def _size(searcher: Searcher, s: Suspect) -> float:
    c = searcher.problem.catalogue[s.kind]
    theta = s.theta[0]
    return abs(theta) if c.kind == "local_stiffness" else float(np.exp(theta))


def _one(searcher: Searcher, s: Suspect, t: Suspect) -> bool:
    a, b = searcher.problem.catalogue[s.kind], searcher.problem.catalogue[t.kind]
    near = float(np.linalg.norm(a.xyz[s.row] - b.xyz[t.row])) < _NEAR * searcher.size
    return near and _alike(a, b, s.row, t.row)


def _alike(a: Candidates, b: Candidates, i: int, j: int) -> bool:
    if a.kind in _MASSES and b.kind in _MASSES:
        return True
    if a.kind != b.kind or a.kind not in {"ground_spring", "local_stiffness"}:
        return False
    return a.where[i].get("components") == b.where[j].get("components")
