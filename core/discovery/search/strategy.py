"""Simple explanations first; kinds that imitate others where these leave much.

A mass on a spring has one magnitude more than a mass or a spring and can imitate either until all
that is missing stands where it should; a spring may join any two places. So the search runs
without such kinds first. Then one of them is put beside every level of what was found; from the
best of these the search goes on with the others, and the likelier of the two outcomes counts.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from ..likelihood.hypothesis import Fit
from .beam_search import Found, grown
from .model_selection import adequate, complete, cost, enough, noise_scale, usual, with_unseen
from .moves import Searcher
from .search_numbers import SEARCH


def searched(
    searcher: Searcher,
    progress: Callable[[str], None] = lambda _: None,
    explained: Callable[[Searcher, Fit], bool] = lambda s, f: usual(s, f),
) -> Found:
    """Search with all kinds but the late ones, and with these where much is left.

    ``explained(searcher, best)`` says where not.
    A tuned one is not looked for where an adequate explanation was found: it would imitate what
    that leaves.
    """
    kinds = [c.kind.late for c in searcher.problem.catalogue]
    simple = _with(searcher, [not late for late in kinds])
    found = grown(simple, enough(simple), progress, explains=partial(complete, simple))
    scale, costs = _scale(searcher, found, found), _costs(searcher, found, found)
    best = int(np.argmin(costs))
    if not any(kinds) or explained(searcher, found.levels[best]):
        return found
    stands = bool(best) and adequate(searcher, found.levels[best])
    if stands or complete(searcher, found.levels[-1]):
        tuned = (c.tunings > 1 for c in searcher.problem.catalogue)
        kinds = [late and not t for late, t in zip(kinds, tuned, strict=True)]
    progress("looking for absorbers and for springs between two places")
    alone = _with(searcher, kinds)
    poorer = best - 1 if stands else 0
    beside = [f for level in found.levels[poorer : best + 1] for f in _beside(alone, level)]
    tried = [(cost(searcher, f, scale), f) for f in beside]
    price, top = min(tried, key=lambda t: t[0], default=(np.inf, None))
    if top is None or price > costs[best]:
        return found.with_rivals(f for _, f in tried if len(f.suspects) <= best)
    levels = [*found.levels[: len(top.suspects)], top]
    return _better(searcher, found, grown(simple, enough(searcher), progress, levels))


def _better(searcher: Searcher, found: Found, other: Found) -> Found:
    """Return the likelier of two outcomes with the levels of the other among its rivals."""
    if min(_costs(searcher, other, found)) < min(_costs(searcher, found, other)):
        found, other = other, found
    levels = len(found.rivals)
    others = (f for level in other.rivals[:levels] for f in level)
    return found.with_rivals((*other.levels[1:levels], *others))


def _scale(searcher: Searcher, found: Found, other: Found) -> float:
    best = min((*found.levels, *other.levels), key=lambda f: f.objective)
    return noise_scale(searcher.problem, with_unseen(searcher, best))


def _costs(searcher: Searcher, found: Found, other: Found) -> list[float]:
    """Costs of the levels of one outcome, by the noise that the better of two leaves."""
    scale = _scale(searcher, found, other)
    return [cost(searcher, f, scale) for f in found.levels]


def _with(searcher: Searcher, kinds: list[bool]) -> Searcher:
    """Return a searcher that looks for some kinds alone."""
    none = np.zeros(0, np.int64)
    coarse = tuple(
        rows if wanted else none for rows, wanted in zip(searcher.coarse, kinds, strict=True)
    )
    return replace(searcher, coarse=coarse)


def _beside(searcher: Searcher, state: Fit) -> list[Fit]:
    """Return the best fit of a state with one more suspect of each kind."""
    best: dict[int, Fit] = {}
    for _, branch in searcher.branches(state, SEARCH.tried):
        new = searcher.fitted(state, (*state.suspects, branch), None, True)
        kind = branch.kind
        if kind not in best or new.objective < best[kind].objective:
            best[kind] = new
    return [searcher.refined(f) for f in best.values()]
