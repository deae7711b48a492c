"""A first look at every place of a kind: which size does best there, and how well.

Sizes are gone through smallest first: what a place can give shows from a small effect on, so
places that gain least of all at every other size are not looked at with the sizes between.
Where a kind has very many sizes, and of springs that pull at one point, those that promise most
to first order are evaluated, at the places that do. Every figure that comes back is an exact
evaluation.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Bools, Floats, Ints
from ..effects.candidates import Candidates
from ..effects.effect_laws import Law, Rows
from ..likelihood.hypothesis import Fit, Problem
from ..likelihood.mode_likelihood import Evidence, targets
from ..reduction.elements_and_supports import thinned
from .exact_scan import scan
from .search_numbers import SEARCH


@dataclass(frozen=True, eq=False)
class Look:
    """Places (n,), misfit and prior of the best size there (n,), and its θ (n, t)."""

    rows: Ints
    cost: Floats
    theta: Floats

    def best(self) -> Ints:
        """Return the rows that cost least: a part of them."""
        return np.asarray(self.rows[_best(self.cost)])


def look(problem: Problem, state: Fit, kind: int, rows: Ints, worth: float = np.inf) -> Look:
    """Evaluate the places `rows` of a kind, see `scan`; some that promise nothing are left out.

    Of places that cost more than is `worth` a closer look at every other size only.
    """
    c = problem.catalogue[kind]
    many = c.law.on == "A" and len(c.trials) > SEARCH.sizes_many
    if many or (c.law.on == "K" and c.rows_each == 1):
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
    kept = _best(cost.min(axis=1))
    kept = kept[cost[kept].min(axis=1) <= worth]
    between = scan(problem, state, kind, rows[kept], c.trials[~first])
    cost[np.ix_(kept, np.flatnonzero(~first))] = between + c.surprise(c.trials[~first])
    return Look(rows, cost.min(axis=1), c.trials[cost.argmin(axis=1)])


def _best(cost: Floats) -> Ints:
    """Return which places cost least, those first: a part of them."""
    number = max(SEARCH.every_size_least, int(SEARCH.every_size * len(cost)))
    return np.argsort(cost, kind="stable")[:number]


def first_places(c: Candidates, factors: Rows, columns: int, size: float) -> Ints:
    """Return the places that the first scan looks at: spread over the structure.

    Of a kind with one direction at a place, those where something moves that way, by its rows
    `factors` (n, q, r) on the first `columns` vectors of a basis; `size` is that of the structure.
    """
    if not c.kind.across:
        return c.first
    parts = [c.first]
    if c.kind.directed:
        moves = np.sum(factors[c.first][:, 0, :columns] ** 2, axis=1)
        live = c.first[moves > SEARCH.still * moves.max(initial=0.0)]
        along = np.array([w["components"][0] for w in c.where])[live]
        parts = [live[along == k] for k in np.unique(along)]
    spread = [rows[thinned(c.spots[rows], size / c.kind.across)] for rows in parts]
    return np.concatenate([c.first[:0], *spread])


def every_other(c: Candidates) -> Bools:
    """Of the sizes that give and of those that take, every other one from the smallest on."""
    value = c.law.value(c.trials, np.zeros(len(c.trials), np.int64))[:, 0]
    out = np.zeros(len(c.trials), bool)
    for sign in (1.0, -1.0):
        own = np.flatnonzero(sign * value > 0.0)
        out[own[np.argsort(np.abs(value[own]), kind="stable")][::2]] = True
    return out


def promising(problem: Problem, state: Fit, kind: int, rows: Ints, trials: Floats) -> Floats:
    """Return the misfit of every place and size to first order, (n, n_trial).

    To a structure with eigenvalues λᵢ and modes φᵢ that it pulls at along u, a mass m on a spring
    of flexibility c is the flexibility c − 1/(mλ), a spring alone is c. An eigenvalue λ of both
    and its shape, scaled by any mode i that takes part, satisfy

        λ = λᵢ + uᵢ s,   φ = φᵢ − s Σ_{j≠i} uⱼ φⱼ / (λⱼ − λ),
        s = uᵢ / (c − 1/(mλ) + Σ_{j≠i} uⱼ² / (λⱼ − λ)).

    At the eigenvalue of a test mode this gives, with no eigensolution, by how much frequency and
    shape are missed. See `scan` for the arguments; kinds with one row each only.
    """
    U, law = problem.part(kind, rows, state.nuisance)
    modes = state.vectors[: problem.basis.size]
    U, seen = U @ modes, problem.sensors @ modes
    lam, aim = np.maximum(state.eigenvalues, 0.0), targets(problem.evidence)
    out = []
    for start in range(0, len(rows), SEARCH.at_once):
        part = np.arange(len(rows))[start : start + SEARCH.at_once]
        each = [np.broadcast_to(t, (len(part), len(t))) for t in trials]
        own = np.stack([_flexibility(law, t, part, aim) for t in each], axis=1)
        out.append(_misfit(problem.evidence, seen, lam, U[part, 0], own))
    return np.concatenate(out)


def _flexibility(law: Law, theta: Floats, rows: Ints, aim: Floats) -> Floats:
    """Return the flexibility of what pulls at each row at some eigenvalues, (n, n_test)."""
    c = law.value(theta, rows)[:, :1]
    if law.on == "K":
        return np.broadcast_to(1.0 / c, (len(rows), len(aim)))
    return np.asarray(law.flexibility(theta, rows)[:, :1] - 1.0 / (c * aim))


def _misfit(e: Evidence, sensors: Floats, lam: Floats, u: Floats, flexibility: Floats) -> Floats:
    """Misfit for flexibilities (n, n_trial, n_test) at places with mode motion u (n, r)."""
    aim, t = targets(e), e.shapes
    tests, tiny = np.arange(len(aim)), SEARCH.resonance * aim[:, None]
    gap = lam - aim[:, None]
    gap = np.where(np.abs(gap) < tiny, tiny, gap)
    best = np.full(flexibility.shape, np.inf)
    for i in np.argsort(np.abs(gap), axis=1)[:, : SEARCH.nearest].T:
        away = 1.0 / gap
        away[tests, i] = 0.0
        ui, phi = u[:, i], sensors[:, i]
        others = (u**2) @ away.T
        s = ui[:, None] / (flexibility + others[:, None])
        off = 0.5 * np.log(np.maximum((lam[i] + ui[:, None] * s) / aim, SEARCH.secular_least))
        rest = np.einsum("nr,tr,kr->nkt", u, away, sensors, optimize=True)
        across = np.sum(t * phi, axis=0) - s * np.einsum("kt,nkt->nt", t, rest)[:, None]
        square = (
            np.sum(phi**2, axis=0)
            - 2.0 * s * np.einsum("kt,nkt->nt", phi, rest)[:, None]
            + s**2 * np.sum(rest**2, axis=1)[:, None]
        )
        mac = across**2 / np.maximum(square, np.finfo(float).tiny)
        noise = e.noise
        d = (off / noise.frequency) ** 2 + noise.independent * (1.0 - mac) / noise.shape**2
        best = np.minimum(best, d)
    return np.asarray(np.sum(e.noise.robust * np.log1p(best / e.noise.robust), axis=-1))
