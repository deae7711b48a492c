"""Places that explain the data about as well as the one that was found."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Floats
from ..effects.candidates import Candidates, Suspect
from ..effects.element_patches import gives
from ..likelihood.hypothesis import Fit
from ..likelihood.map_fit import fit
from .exact_scan import scan
from .found import noise_scale
from .model_selection import Scored
from .moves import Searcher, nearest
from .search_numbers import SEARCH


@dataclass(frozen=True, eq=False)
class Place:
    """A suspect that explains the data about as well, and its share of the credibility."""

    suspect: Suspect
    weight: float


def credible_places(searcher: Searcher, best: Fit, number: int) -> list[Place]:
    """Return the places of one suspect that explain the data about as well, likeliest first.

    Parameters, sizes and other suspects follow at every place: a spring nearer to a clamp and
    stiffer does what one further off does. Those within a likelihood ratio of exp(3) of the
    best are kept.
    """
    suspect, scale = best.suspects[number], noise_scale(searcher.problem, best)
    c = searcher.problem.catalogue[suspect.kind]
    away = np.linalg.norm(c.spots - c.spots[suspect.row], axis=1)
    near = nearest(away, SEARCH.credible_near * searcher.size)[: SEARCH.credible_most]
    rows = np.union1d(np.union1d(searcher.coarse[suspect.kind], near), [suspect.row])
    small, here = searcher.without(best, number)
    trials = c.around(suspect.theta, np.array(SEARCH.credible_sizes))
    score = scan(small, here, suspect.kind, rows, trials)
    order = np.argsort(score.min(axis=1), kind="stable")[: SEARCH.credible_fitted]
    own = np.flatnonzero(rows == suspect.row)
    tried: list[Fit] = []
    vain = 0
    for i in [*own, *order[order != own[0]]]:
        moved = Suspect(suspect.kind, int(rows[i]), tuple(trials[score[i].argmin()]))
        suspects = best.instead(number, moved)
        tried.append(fit(small, best.nuisance, suspects, searcher.active, SEARCH.credible_steps))
        least = min(f.objective for f in tried)
        vain = 0 if tried[-1].objective - least < SEARCH.credible * scale else vain + 1
        if vain == SEARCH.credible_vain:
            break
    kept = [f for f in tried if f.objective - least < SEARCH.credible * scale]
    weight = np.exp([-0.5 * (f.objective - least) / scale for f in kept])
    share = (weight / weight.sum()).tolist()
    places = [Place(f.suspects[number], w) for f, w in zip(kept, share, strict=True)]
    return sorted(places, key=lambda p: -p.weight)


def alike(tried: Sequence[Scored], best: Scored, number: int) -> tuple[list[Scored], list[Place]]:
    """Return what was `tried` that is about as likely by the error of the model, and where.

    One suspect elsewhere, on bases of their own: no other tells the size of a patch that gives. Of
    each place the first.
    """

    def same(s: Scored) -> bool:
        pairs = list(zip(s.fit.suspects, best.fit.suspects, strict=False))
        others = all(t.row == o.row for k, (t, o) in enumerate(pairs) if k != number)
        kinds = [t.kind for t in s.fit.suspects] == [o.kind for o in best.fit.suspects]
        return kinds and others and 2.0 * (best.score - s.score) < SEARCH.credible

    rows = {s.fit.suspects[number].row: s for s in reversed(tried) if s.judged and same(s)}
    near = list(rows.values())
    where = [s.judged.fit.suspects[number] for s in near if s.judged]
    weight = np.exp([s.score - best.score for s in near])
    share = (weight / weight.sum()).tolist()
    return near, [Place(s, w) for s, w in zip(where, share, strict=True)]


def between(places: Sequence[Place]) -> Floats:
    """Return the standard deviation of each θ among places, (t,)."""
    weight = np.array([p.weight for p in places])[:, None]
    theta = np.array([p.suspect.theta for p in places])
    mean = np.sum(weight * theta, axis=0) / weight.sum()
    return np.asarray(np.sqrt(np.sum(weight * (theta - mean) ** 2, axis=0) / weight.sum()))


def middle(c: Candidates, places: Sequence[Place]) -> int:
    """Return the number of that place which is nearest to where a suspect may be, on average.

    Along a beam that hardly stretches a spring in its direction does the same anywhere. Patches
    that give are near each other by how much they do, the larger one is the less: it is a mean that
    small and large ones, which are as likely, share.
    """
    at = c.spots[[p.suspect.row for p in places]]
    if gives(c):
        at = np.array([p.suspect.theta for p in places])
    away = np.linalg.norm(at[:, None] - at, axis=2) ** (2 if gives(c) else 1)
    return int(np.argmin(away @ [p.weight for p in places]))
