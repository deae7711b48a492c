"""A first look at every place of a kind: which size does best there, and how well.

Sizes are gone through smallest first: what a place can give shows from a small effect on, so
places that gain least of all at every other size are not looked at with the sizes between.
Where a kind has very many sizes, those that promise most to first order are evaluated, at the
places that do. Every figure that comes back is an exact evaluation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Bools, Floats, Ints
from ..effects.candidates import Candidates
from ..effects.effect_laws import Rows
from ..likelihood.hypothesis import Fit, Problem
from ..reduction.elements_and_supports import thinned
from .exact_scan import scan
from .search_numbers import SEARCH
from .secular_screening import promising


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
    if len(c.trials) > SEARCH.sizes_many:
        guess = promising(problem, state, kind, rows, c.trials) + c.surprise(c.trials)
        rows_kept = np.argsort(guess.min(axis=1), kind="stable")[: SEARCH.sizes_places]
        sizes = c.trials[np.argsort(guess, axis=1, kind="stable")[rows_kept, : SEARCH.sizes_each]]
        rows = rows[rows_kept]
        cost = scan(problem, state, kind, rows, sizes) + c.surprise(sizes)
        return Look(rows, cost.min(axis=1), sizes[np.arange(len(rows)), cost.argmin(axis=1)])
    first = every_other(c)
    cost = np.full((len(rows), len(c.trials)), np.inf)
    cost[:, first] = scan(problem, state, kind, rows, c.trials[first])
    cost += c.surprise(c.trials)
    best = np.argsort(cost.min(axis=1), kind="stable")
    kept = best[: max(SEARCH.every_size_least, int(SEARCH.every_size * len(rows)))]
    between = scan(problem, state, kind, rows[kept], c.trials[~first])
    cost[np.ix_(kept, np.flatnonzero(~first))] = between + c.surprise(c.trials[~first])
    return Look(rows, cost.min(axis=1), c.trials[cost.argmin(axis=1)])


def first_places(c: Candidates, factors: Rows, columns: int, size: float) -> Ints:
    """Return the places that the first scan looks at: spread over the structure.

    Of a kind with one direction at a place, those where something moves that way.

    Parameters
    ----------
    c : Candidates
    factors : (n, q, r) float
        Their rows on a basis.
    columns : int
        The first so many vectors of the basis count.
    size : float
        Of the structure.
    """
    if not c.kind.across:
        return c.first
    parts = [c.first]
    if c.kind.directed:
        moves = np.sum(factors[c.first][:, 0, :columns] ** 2, axis=1)
        live = c.first[moves > SEARCH.still * moves.max(initial=0.0)]
        along = np.array([w["components"][0] for w in c.where])[live]
        parts = [live[along == k] for k in np.unique(along)]
    spread = [rows[thinned(c.xyz[rows], size / c.kind.across)] for rows in parts]
    return np.concatenate([c.first[:0], *spread])


def every_other(c: Candidates) -> Bools:
    """Of the sizes that give and of those that take, every other one from the smallest on."""
    value = c.law.value(c.trials, np.zeros(len(c.trials), np.int64))[:, 0]
    out = np.zeros(len(c.trials), bool)
    for sign in (1.0, -1.0):
        own = np.flatnonzero(sign * value > 0.0)
        out[own[np.argsort(np.abs(value[own]), kind="stable")][::2]] = True
    return out
