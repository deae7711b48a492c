"""What a search by a wider noise finds, fitted to the noise of the test and grown from there.

Two effects may each explain nothing alone: the shapes are as wrong with one as with none, and a
misfit that levels off for what is far away does not tell that one of them is right. By several
times the noise it does (graduated non-convexity: Blake and Zisserman 1987, chapter 3).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..likelihood.hypothesis import Fit, softened
from ..likelihood.map_fit import fit
from .beam_search import Found, grown
from .model_selection import enough
from .moves import Searcher
from .search_numbers import SEARCH


def guided(searcher: Searcher, progress: Callable[[str], None] = lambda _: None) -> Found:
    """Return what grows from the hypotheses that a search by a wider noise finds.

    Parameters
    ----------
    searcher : Searcher
    progress : callable
        Told what happens.
    """
    wide = replace(searcher, problem=softened(searcher.problem))
    found = grown(wide, enough(wide), progress)
    levels = [_by_the_test(searcher, f) for f in found.levels]
    best = int(np.argmin([f.objective for f in levels]))
    if not best:
        return Found(tuple(levels[:1]), ((),))
    return grown(searcher, enough(searcher), progress, levels[: best + 1])


def _by_the_test(searcher: Searcher, f: Fit) -> Fit:
    """Return a fit by the noise of the test, every suspect at its best neighbour."""
    start = fit(searcher.problem, f.nuisance, f.suspects, searcher.active, SEARCH.steps_guided)
    return searcher.refined(start) if f.suspects else start
