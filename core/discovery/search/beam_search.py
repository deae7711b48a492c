"""A beam of hypotheses that grows by one suspect at a time.

From each, the most promising places of every kind are fitted together with everything chosen
before; the best of these are moved to better neighbours and reconsidered, and the best of those
are grown again, until one more suspect no longer earns its place.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence

import numpy as np

from ..effects.candidates import Suspect
from ..likelihood.hypothesis import Fit, distinct, softened
from ..likelihood.map_fit import evaluate
from .found import Found, objective_of
from .model_selection import enough, hopeless, usual
from .moves import Searcher
from .search_numbers import SEARCH


def grown(
    searcher: Searcher,
    progress: Callable[[str], None] = lambda _: None,
    first: Sequence[Fit] = (),
    explains: Callable[[Fit], bool] = lambda _: False,
) -> Found:
    """Grow the beam until one more suspect no longer earns its place.

    `first` are hypotheses of no suspect, one and more, the last of which is grown;
    ``explains(fit)`` ends the search where a hypothesis leaves nothing to explain.
    """
    levels = [*first] or [searcher.settled(searcher.null())]
    rivals: list[tuple[Fit, ...]] = [() for _ in levels]
    beam = [*levels[-1:], *([] if first else _as_the_deck(searcher, levels[0]))]
    for depth in range(len(levels), SEARCH.most + 1):
        if explains(levels[-1]):
            break
        progress(f"looking for {depth} missing effect{'s' if depth > 1 else ''}")
        found: list[Fit] = []
        among, vain = searcher.coarse, False
        for state in beam:
            small, here = searcher.local(state)
            soft = evaluate(softened(small), here.nuisance, here.suspects).objective
            scanned = searcher.scanned(state, SEARCH.branches, among)
            among = scanned.live if depth > 1 and state is beam[0] else among
            for branch in _varied(searcher, scanned.best, soft):
                wider = (*state.suspects, branch)
                found.append(searcher.fitted(state, wider, SEARCH.steps_new, soften=True))
            found.sort(key=objective_of)
            vain = depth > 1 and bool(found) and hopeless(searcher, levels[-1], found[0])
            if vain:
                break
        if not found:
            break
        chosen = _distinct(searcher, found)
        if vain:
            levels.append(chosen[0])
            rivals.append(tuple(chosen[1 : SEARCH.rivals]))
            break
        base = beam[0].objective
        followed = chosen[: SEARCH.beam - (depth > 1)]
        beam = sorted(map(searcher.settled, map(searcher.refined, followed)), key=objective_of)
        if depth > 1:
            beam[0] = searcher.moved_at_once(searcher.reconsidered(beam[0]))
        beam = _distinct(searcher, sorted(beam, key=objective_of))
        best = next((f for f in beam if depth > 1 and explains(f)), beam[0])
        rest = (*(f for f in beam if f is not best), *chosen[SEARCH.beam :])
        rivals.append(rest[: SEARCH.rivals])
        previous = levels[-1]
        levels.append(best)
        if enough(searcher, previous, best):
            break
        beam = sorted(_near(searcher, beam, base), key=objective_of)
    return Found(tuple(levels), tuple(rivals))


def _as_the_deck(searcher: Searcher, null: Fit) -> list[Fit]:
    """Return the known parameters as the deck has them, the error of the mesh as fitted.

    Where something large is missing the known parameters have gone far to make up for it; what
    is right then fits to modes that they have spoilt. Nothing where they have not moved, or leave
    no more than right models do.
    """
    if usual(searcher, null):
        return []
    mesh = np.arange(len(null.nuisance)) == len(null.nuisance) - 1
    as_it_is = null.nuisance * mesh
    if np.array_equal(as_it_is, null.nuisance):
        return []
    return [evaluate(searcher.problem, as_it_is, ())]


def _distinct(searcher: Searcher, fits: Sequence[Fit]) -> list[Fit]:
    near = SEARCH.same_place * SEARCH.apart * searcher.size
    return distinct(fits, searcher.problem.catalogue, near)


def _near(searcher: Searcher, fits: Sequence[Fit], base: float) -> list[Fit]:
    """Return the best and the next few that gained nearly as much over `base`."""
    near = fits[0].objective + SEARCH.nearly * (base - fits[0].objective)
    close = [f for f in fits if f is fits[0] or f.objective < near]
    return close[: SEARCH.beam - 1]


def _varied(
    searcher: Searcher, branches: Sequence[tuple[float, Suspect]], base: float
) -> list[Suspect]:
    """Keep the best branches of all and the best of every kind, if they gain enough.

    Stretches of an edge are a kind by each way they give.
    """
    number: Counter[tuple[str, int]] = Counter()
    kept: list[Suspect] = []
    best = branches[0][0] if branches else 0.0
    for score, s in branches:
        c = searcher.problem.catalogue[s.kind]
        kind = (c.kind.name, s.kind if c.ends else -1)
        if base - score < SEARCH.worth_fitting * (base - best) and kept:
            continue
        number[kind] += 1
        if number.total() <= SEARCH.branches or number[kind] == 1:
            kept.append(s)
    return kept
