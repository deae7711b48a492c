"""A first look at every place of a kind: which size does best there, and how well.

Sizes are gone through smallest first: what a place can give shows from a small effect on, so
places that gain least of all at every other size are not looked at with the sizes between.
Where a kind has very many sizes, those that promise most to first order are evaluated, at the
places that do. Every figure that comes back is an exact evaluation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats, Ints
from .candidates import Candidates
from .problem import Fit, Problem
from .scanning import scan
from .tuning import promising

_MANY = 30
"""Sizes of a kind above which not all are evaluated anywhere."""
_PLACES, _SIZES = 30, 2
"""Places, and sizes at each, that are evaluated of a kind with many sizes."""
_BETWEEN, _AT_LEAST = 0.3, 30
"""Share of the places, and their number at least, that are looked at with every size."""


@dataclass(frozen=True, eq=False)
class Look:
    """Places (n,), misfit and prior of the best size there (n,), and its θ (n, t)."""

    rows: Ints
    cost: Floats
    theta: Floats


def look(problem: Problem, state: Fit, kind: int, rows: Ints) -> Look:
    """Evaluate the places `rows` of a kind.

    Parameters
    ----------
    problem, state
        See `scan`.
    kind : int
        Number in the catalogue.
    rows : (n,) int
        Places; those that promise nothing may be missing from the answer.
    """
    c = problem.catalogue[kind]
    if len(c.trials) > _MANY:
        guess = promising(problem, state, kind, rows, c.trials) + c.surprise(c.trials)
        rows_kept = np.argsort(guess.min(axis=1), kind="stable")[:_PLACES]
        sizes = c.trials[np.argsort(guess, axis=1, kind="stable")[rows_kept, :_SIZES]]
        rows = rows[rows_kept]
        cost = scan(problem, state, kind, rows, sizes) + c.surprise(sizes)
        return Look(rows, cost.min(axis=1), sizes[np.arange(len(rows)), cost.argmin(axis=1)])
    first = every_other(c)
    cost = np.full((len(rows), len(c.trials)), np.inf)
    cost[:, first] = scan(problem, state, kind, rows, c.trials[first])
    cost += c.surprise(c.trials)
    best = np.argsort(cost.min(axis=1), kind="stable")
    kept = best[: max(_AT_LEAST, int(_BETWEEN * len(rows)))]
    between = scan(problem, state, kind, rows[kept], c.trials[~first])
    cost[np.ix_(kept, np.flatnonzero(~first))] = between + c.surprise(c.trials[~first])
    return Look(rows, cost.min(axis=1), c.trials[cost.argmin(axis=1)])


def every_other(c: Candidates) -> Bools:
    """Of the sizes that give and of those that take, every other one from the smallest on."""
    value = c.law.value(c.trials, np.zeros(len(c.trials), np.int64))[:, 0]
    out = np.zeros(len(c.trials), bool)
    for sign in (1.0, -1.0):
        own = np.flatnonzero(sign * value > 0.0)
        out[own[np.argsort(np.abs(value[own]), kind="stable")][::2]] = True
    return out
