"""Places that explain the data about as well as the one that was found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from .candidates import Suspect
from .fitting import evaluate, fit
from .judge import CREDIBLE
from .problem import Fit
from .scanning import scan
from .search import Searcher

_NEAR, _MOST = 0.15, 400
"""Places nearer than this part of the structure are all looked at, so many at most."""
_SIZES = np.array([-0.6, -0.3, 0.0, 0.3, 0.6])
"""Steps of θ with which they are."""
_FITTED, _STEPS = 30, 3
"""Places at which all else follows, the most promising, and in how many steps."""


@dataclass(frozen=True, eq=False)
class Place:
    """A suspect that explains the data about as well, and its share of the credibility."""

    suspect: Suspect
    weight: float


def credible_places(searcher: Searcher, best: Fit, number: int, scale: float) -> list[Place]:
    """Return the places of one suspect that explain the data about as well, likeliest first.

    Parameters, sizes and other suspects follow at every place: a spring nearer to a clamp and
    stiffer does what one further off does. Those within a likelihood ratio of exp(3) of the
    best are kept.
    """
    suspect = best.suspects[number]
    before, after = best.suspects[:number], best.suspects[number + 1 :]
    c = searcher.problem.catalogue[suspect.kind]
    away = np.linalg.norm(c.xyz - c.xyz[suspect.row], axis=1)
    near = np.flatnonzero(away < _NEAR * searcher.size)[:_MOST]
    rows = np.union1d(np.union1d(searcher.coarse[suspect.kind], near), [suspect.row])
    small, here = searcher.local(evaluate(searcher.problem, best.log_p, (*before, *after)))
    trials = c.around(suspect.theta, _SIZES)
    score = scan(small, here, suspect.kind, rows, trials)
    chosen = np.argsort(score.min(axis=1), kind="stable")[:_FITTED]
    chosen = np.union1d(chosen, np.flatnonzero(rows == suspect.row))
    tried = []
    for i in chosen:
        moved = Suspect(suspect.kind, int(rows[i]), tuple(trials[score[i].argmin()]))
        suspects = (*before, moved, *after)
        tried.append(fit(small, best.log_p, suspects, searcher.active, _STEPS))
    least = min(f.objective for f in tried)
    kept = [f for f in tried if f.objective - least < CREDIBLE * scale]
    weight = np.exp([-0.5 * (f.objective - least) / scale for f in kept])
    return sorted(
        (
            Place(f.suspects[number], float(w))
            for f, w in zip(kept, weight / weight.sum(), strict=True)
        ),
        key=lambda p: -p.weight,
    )


def between(places: Sequence[Place]) -> Floats:
    """Return the standard deviation of each θ among places, (t,)."""
    weight = np.array([p.weight for p in places])[:, None]
    theta = np.array([p.suspect.theta for p in places])
    mean = np.sum(weight * theta, axis=0) / weight.sum()
    return np.asarray(np.sqrt(np.sum(weight * (theta - mean) ** 2, axis=0) / weight.sum()))
