"""Simple explanations first; kinds that are tuned where these do clearly worse.

A mass on a spring has one magnitude more than a mass or a spring and can imitate either until all
that is missing stands where it should. So the search runs without tuned kinds first. Then one of
them is put beside every level of what was found; where it gains clearly more than the next simple
effect did, the search runs again with all kinds, and the likelier of the two outcomes counts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from .fitting import Fit
from .search import Found, Searcher

_CLEARLY = 1.3
"""How many times what a simple effect gains a tuned one has to."""
_TRIED = 3


def searched(
    searcher: Searcher,
    enough: Callable[[Fit, Fit, float], bool],
    likelier: Callable[[Found, Found], bool],
    progress: Callable[[str], None] = lambda _: None,
) -> Found:
    """Search with simple kinds, and with all where a tuned one does clearly better.

    Parameters
    ----------
    searcher : Searcher
    enough : callable
        See `Searcher.run`.
    likelier : callable
        Whether the best of the first outcome is likelier than that of the second.
    progress : callable
        Told what happens.
    """
    tuned = [c.tunings > 1 for c in searcher.problem.catalogue]
    found = _with(searcher, [not t for t in tuned]).run(enough, progress)
    if not any(tuned):
        return found
    progress("looking for absorbers beside what was found")
    beside = [_best_beside(_with(searcher, tuned), f) for f in found.levels]
    if any(_clearly(found, k, f, enough) for k, f in enumerate(beside) if f is not None):
        other = searcher.run(enough, progress)
        if likelier(other, found):
            return _joined(other, found)
        return _joined(found, other)
    rivals = [list(level) for level in found.rivals]
    for k, f in enumerate(beside[:-1]):
        if f is not None:
            rivals[k + 1].append(f)
    return Found(found.levels, tuple(tuple(level) for level in rivals))


def _with(searcher: Searcher, kinds: list[bool]) -> Searcher:
    """Return a searcher that looks for some kinds alone."""
    none = np.zeros(0, np.int64)
    coarse = tuple(
        rows if wanted else none for rows, wanted in zip(searcher.coarse, kinds, strict=True)
    )
    return replace(searcher, coarse=coarse)


def _best_beside(searcher: Searcher, state: Fit) -> Fit | None:
    """Return the best fit of a state with one more suspect, None where there is no place."""
    fits = [
        searcher.fitted(state, (*state.suspects, branch), 5, None, True)
        for _, branch in searcher.branches(state, _TRIED)[:_TRIED]
    ]
    if not fits:
        return None
    return searcher.refined(min(fits, key=lambda f: f.objective))


def _clearly(found: Found, k: int, f: Fit, enough: Callable[[Fit, Fit, float], bool]) -> bool:
    """Whether a tuned kind beside level k does clearly better than the simple one that came."""
    here = found.levels[k]
    if enough(here, f, 1.0):
        return False
    if k + 1 == len(found.levels):
        return True
    simple = here.objective - found.levels[k + 1].objective
    return here.objective - f.objective > _CLEARLY * simple


def _joined(best: Found, other: Found) -> Found:
    """Return an outcome with the levels of another among its rivals."""
    rivals = [list(level) for level in best.rivals]
    for k, f in enumerate(other.levels[: len(rivals)]):
        if k:
            rivals[k].append(f)
    return Found(best.levels, tuple(tuple(level) for level in rivals))
