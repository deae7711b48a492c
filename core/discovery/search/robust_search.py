"""Search in a model that is off everywhere, by errors that the test itself tells.

Every grid and every set of equivalent ones is looked at; each hypothesis has an assignment of
test modes; the errors begin wide, so that modes which nobody explains do not rule, and shrink as
more modes pair (graduated non-convexity: Blake and Zisserman 1987, chapter 3).
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...arrays import Ints
from ..effects.candidates import Candidates
from ..likelihood.estimated_noise import WIDE, by_noise, estimated
from ..likelihood.hypothesis import Fit
from ..likelihood.map_fit import fit
from ..reduction.elements_and_supports import thinned
from .beam_search import Found, grown
from .model_selection import cost, enough
from .moves import Searcher
from .search_numbers import SEARCH


def robust(
    searcher: Searcher, progress: Callable[[str], None] = lambda _: None
) -> tuple[Searcher, Found]:
    """Return what a search finds that estimates the errors as it goes, and a searcher by these."""
    kinds = zip(searcher.problem.catalogue, searcher.coarse, strict=True)
    coarse = tuple(_every(c, rows, searcher.size) for c, rows in kinds)
    problem = by_noise(searcher.problem, WIDE)
    searcher = replace(searcher, coarse=coarse, beside=(), problem=problem)
    first: list[Fit] = []
    for _ in range(SEARCH.estimates):
        found = grown(searcher, enough(searcher), progress, first)
        best = int(np.argmin([cost(searcher, f, 1.0) for f in found.levels]))
        noise = estimated(searcher.problem, found.levels[best])
        if noise.frequency > SEARCH.shrinks * searcher.problem.whole.noise.frequency:
            break
        searcher = replace(searcher, problem=by_noise(searcher.problem, noise))
        first = [_again(searcher, f) for f in found.levels[: best + 1]]
    return searcher, found


def _every(c: Candidates, rows: Ints, size: float) -> Ints:
    """Return all grids where a mass may sit, of so many that they can be looked at."""
    if c.tunings > 1 or c.kind.directed or not c.kind.at_points or not c.rows_each:
        return rows if c.tunings == 1 else rows[:0]
    alone = (len(w["grids"]) == 1 and "arms" not in w for w in c.where)
    own = np.flatnonzero(np.fromiter(alone, bool, len(c)))
    if len(own) <= SEARCH.every_most:
        return own
    return np.asarray(own[thinned(c.xyz[own], size / SEARCH.every_across)])


def _again(searcher: Searcher, f: Fit) -> Fit:
    """Fit a hypothesis by other errors, each suspect at its best neighbour."""
    f = fit(searcher.problem, f.nuisance, f.suspects, searcher.active, SEARCH.steps_guided)
    return searcher.refined(f) if f.suspects else f
