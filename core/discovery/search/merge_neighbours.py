"""Two findings that are one: masses side by side, springs side by side, patches that overlap.

The catalogue has round and elongated patches and points; a mass of another shape comes out as two
of them. What a person is told is one effect with what both amount to.
"""

from dataclasses import replace

import numpy as np

from ..effects.candidates import Candidates, Suspect
from ..likelihood.hypothesis import Fit
from .moves import Searcher
from .search_numbers import SEARCH


def merged(searcher: Searcher, state: Fit) -> Fit:
    """Return a hypothesis with neighbours of one nature made one; the same if there are none.

    Masses and springs add up, at the place of the largest, a mass that is spread out in part as a
    whole; of patches of stiffness the one that changes most stays. Nothing is fitted again.
    """
    left = list(state.suspects)
    kept: list[Suspect] = []
    while left:
        first = max(left, key=lambda s: _size(searcher, s))
        left.remove(first)
        same = [s for s in left if _one(searcher, first, s)]
        left = [s for s in left if not any(s is t for t in same)]
        if same and _of(searcher, first).kind.adds_up:
            total = np.sum([np.exp(s.theta) for s in (first, *same)], axis=0)
            spread = [s for s in (first, *same) if _of(searcher, s).kind.spread_out]
            first = max(spread or [first], key=lambda s: _size(searcher, s))
            first = first.moved(np.log(total))
        kept.append(first)
    if len(kept) == len(state.suspects):
        return state
    return replace(state, suspects=tuple(kept), unseen=None, surplus=None, in_deck=None)


def _of(searcher: Searcher, s: Suspect) -> Candidates:
    return searcher.problem.catalogue[s.kind]


def _size(searcher: Searcher, s: Suspect) -> float:
    theta = s.theta[0]
    return float(np.exp(theta)) if _of(searcher, s).kind.adds_up else abs(theta)


def _one(searcher: Searcher, s: Suspect, t: Suspect) -> bool:
    a, b = _of(searcher, s), _of(searcher, t)
    near = float(np.linalg.norm(a.xyz[s.row] - b.xyz[t.row])) < SEARCH.one_effect * searcher.size
    along = a.where[s.row].get("components") == b.where[t.row].get("components")
    return near and along and a.many(s.row) == b.many(t.row) and a.kind.joins(b.kind)
