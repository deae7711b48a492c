"""Simple explanations first; kinds that are tuned where these do clearly worse.

A mass on a spring has one magnitude more than a mass or a spring and can imitate either until all
that is missing stands where it should. So the search runs without tuned kinds first. Then one of
them is put beside every level of what was found; where it gains clearly more than the next simple
effect did, the search runs again with all kinds, and the likelier of the two outcomes counts. It
does so too where something was found in a model small enough for a second opinion.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from ..effects.candidates import Candidates, Suspect
from ..likelihood.hypothesis import Fit, softened
from ..likelihood.map_fit import fit
from .beam_search import Found, grown
from .model_selection import adequate, complete, cost, enough, noise_scale, usual, with_unseen
from .moves import Searcher
from .search_numbers import SEARCH


def searched(searcher: Searcher, progress: Callable[[str], None] = lambda _: None) -> Found:
    """Search with all kinds but the late ones, and with these where much is left.

    One of these is put beside every level of what was found; from the best of them the search goes
    on with the others.
    """
    late = [c.kind.late for c in searcher.problem.catalogue]
    simple = _with(searcher, [not x for x in late])
    found = _by_tuning(simple, progress)
    scale, costs = _scale(searcher, found, found), _costs(searcher, found, found)
    best = int(np.argmin(costs))
    if not any(late) or usual(searcher, found.levels[best]):
        return found
    progress("looking for springs between two places")
    alone = _with(searcher, late)
    beside = [_best_beside(alone, f) for f in found.levels[: best + 1]]
    tried = [(cost(searcher, f, scale), f) for f in beside if f is not None]
    price, top = min(tried, key=lambda t: t[0], default=(np.inf, None))
    if top is None or price > costs[best]:
        return found.with_rivals(f for _, f in tried[:best])
    levels = [*found.levels[: len(top.suspects)], top]
    return _better(searcher, found, grown(simple, enough(searcher), progress, levels))


def _by_tuning(searcher: Searcher, progress: Callable[[str], None]) -> Found:
    """Search with simple kinds, and with all where a tuned one does clearly better."""
    tuned = [c.tunings > 1 for c in searcher.problem.catalogue]
    found = _simple(_with(searcher, [not t for t in tuned]), progress)
    costs = _costs(searcher, found, found)
    best = int(np.argmin(costs))
    if not any(tuned) or complete(searcher, found.levels[-1]):
        return found
    if best and adequate(searcher, found.levels[best]):
        return found
    progress("looking for absorbers beside what was found")
    alone = _with(searcher, tuned)
    beside = [_best_beside(alone, f) for f in found.levels[: best + 1]]
    scale = _scale(searcher, found, found)
    top = beside[best]
    better = top is not None and cost(searcher, top, scale) < costs[best]
    small = _small(searcher)
    clearly = (_clearly(found, k, f) for k, f in enumerate(beside[:-1]) if f is not None)
    if better or any(clearly) or (small and (best or scale > SEARCH.unexplained)):
        other = grown(searcher, enough(searcher), progress)
        return _better(searcher, found, simplified(searcher, other))
    return found.with_rivals(f for f in beside[:-1] if f is not None)


def _simple(searcher: Searcher, progress: Callable[[str], None]) -> Found:
    """Search with simple kinds; where much is left, by a wider noise first as well."""
    found = grown(searcher, enough(searcher), progress, explains=partial(complete, searcher))
    if complete(searcher, found.levels[-1]):
        return found
    scale, best = _scale(searcher, found, found), int(np.argmin(_costs(searcher, found, found)))
    if scale < SEARCH.second_opinion or (best and not _small(searcher)):
        return found
    progress("looking by a wider noise")
    return _better(searcher, found, guided(searcher, progress))


def _small(searcher: Searcher) -> bool:
    return len(searcher.problem.basis.vectors) <= searcher.effort.twice


def _better(searcher: Searcher, found: Found, other: Found) -> Found:
    """Return the likelier of two outcomes with the levels of the other among its rivals."""
    if min(_costs(searcher, other, found)) < min(_costs(searcher, found, other)):
        found, other = other, found
    levels = len(found.rivals)
    others = (f for level in other.rivals[:levels] for f in level)
    return found.with_rivals((*other.levels[1:levels], *others))


def simplified(searcher: Searcher, found: Found) -> Found:
    """Return an outcome with absorbers replaced where a mass or a spring there does nearly as well.

    Tuned far above the band an absorber is a mass, far below it a spring to ground. Tuned within
    the band it does what neither can; where it hardly gains more it makes up for what is wrong with
    the structure under it.
    """
    levels, beaten = list(found.levels), []
    scale = _scale(searcher, found, found)
    for k, f in enumerate(found.levels):
        for q in (q for q, s in enumerate(f.suspects) if searcher.tuned(s)):
            others = f.suspects[:q] + f.suspects[q + 1 :]
            left = searcher.fitted(f, others, SEARCH.steps_instead)
            limits = _limits(searcher, levels[k], q)
            if not limits:
                continue
            plain = searcher.refined(min(limits, key=lambda t: cost(searcher, t, scale)))
            without, own, simple = (cost(searcher, t, scale) for t in (left, levels[k], plain))
            if simple < own:
                beaten.append(levels[k])
            if simple < own or without - own < SEARCH.clearly * (without - simple):
                levels[k] = plain
    return Found(tuple(levels), found.rivals).with_rivals(beaten)


def _limits(searcher: Searcher, f: Fit, q: int) -> list[Fit]:
    """Return fits with a tuned suspect replaced by the simple ones it becomes at its limits."""
    catalogue, out = searcher.problem.catalogue, []
    s = f.suspects[q]
    own = catalogue[s.kind]
    sizes = own.kind.limits(np.exp(s.theta))
    for kind, c in enumerate(catalogue):
        if c.kind in sizes and c.rows_each:
            plain = Suspect(kind, _same_place(own, s.row, c), (float(np.log(sizes[c.kind])),))
            suspects = (*f.suspects[:q], plain, *f.suspects[q + 1 :])
            out.append(searcher.fitted(f, suspects, SEARCH.steps_instead))
    return out


def _same_place(own: Candidates, row: int, other: Candidates) -> int:
    """Return the row of another kind at a place, in the same direction where it has one."""
    away = np.linalg.norm(other.xyz - own.xyz[row], axis=1)
    along = own.where[row].get("components")
    same = np.array([w.get("components", along) == along for w in other.where])
    return int(np.argmin(np.where(same, away, np.inf)))


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


def _best_beside(searcher: Searcher, state: Fit) -> Fit | None:
    """Return the best fit of a state with one more suspect, None where there is no place."""
    fits = [
        searcher.fitted(state, (*state.suspects, branch), SEARCH.steps_new, None, True)
        for _, branch in searcher.branches(state, SEARCH.tuned_tried)[: SEARCH.tuned_tried]
    ]
    if not fits:
        return None
    return searcher.refined(min(fits, key=lambda f: f.objective))


def _clearly(found: Found, k: int, f: Fit) -> bool:
    """Whether a tuned kind beside a level does clearly better than the simple one that came."""
    here = found.levels[k].objective
    return here - f.objective > SEARCH.clearly * (here - found.levels[k + 1].objective)


def guided(searcher: Searcher, progress: Callable[[str], None] = lambda _: None) -> Found:
    """Return what grows from the hypotheses that a search by a wider noise finds.

    Two effects may each explain nothing alone: the shapes are as wrong with one as with none, and
    a misfit that levels off for what is far away does not tell that one of them is right. By
    several times the noise it does (graduated non-convexity: Blake and Zisserman 1987, chapter 3).
    """
    wide = replace(searcher, problem=softened(searcher.problem))
    found = grown(wide, enough(wide), progress)
    levels = []
    for f in found.levels:  # by the noise of the test, every suspect at its best neighbour
        f = fit(searcher.problem, f.nuisance, f.suspects, searcher.active, SEARCH.steps_guided)
        levels.append(searcher.refined(f) if f.suspects else f)
    best = int(np.argmin([f.objective for f in levels]))
    if not best:
        return Found(tuple(levels[:1]), ((),))
    return grown(searcher, enough(searcher), progress, levels[: best + 1])
