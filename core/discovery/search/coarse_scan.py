"""A first look at every place of a kind: which size does best there, and how well.

Masses and springs change little where they sit: the places that promise most to first order are
evaluated, at the sizes that do. Of other kinds sizes are gone through smallest first: what a place
can give shows from a small effect on, so places that gain least of all at every other size are not
looked at with the sizes between. Every figure that comes back is an exact evaluation.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...arrays import Bools, Floats, Ints
from ...numerics.products import stacked_product
from ..effects.candidates import Candidates
from ..effects.effect_laws import Law, Rows
from ..likelihood.hypothesis import Fit, Problem
from ..likelihood.mode_likelihood import Evidence, robust, targets
from ..reduction.elements_and_supports import thinned
from .exact_scan import scan
from .search_numbers import SEARCH


@dataclass(frozen=True, eq=False)
class Neighbourhoods:
    """Places around those that a first scan looks at.

    Parameters
    ----------
    rows : (m,) int
        Places, those of the first scan among them.
    of : (n,) int
        The number of its neighbourhood for each of these, -1 for all other places of the kind.
    """

    rows: Ints
    of: Ints

    def around(self, rows: Ints) -> Ints:
        """Return the places around some of them, these included."""
        return np.asarray(self.rows[np.isin(self.of[self.rows], self.of[rows])])

    def first(self, rows: Ints, cost: Floats) -> Ints:
        """Return by their number those of some places that cost least in their neighbourhoods."""
        order = np.lexsort((cost, self.of[rows]))
        return np.asarray(order[np.unique(self.of[rows[order]], return_index=True)[1]])


def neighbourhoods(c: Candidates, first: Ints, size: float) -> Neighbourhoods | None:
    """Return the grids around the places of a first scan, None where it sees them all.

    Of what sits at points, which splits modes of one frequency: where it does not lie between the
    grids of such a scan it turns them the wrong way, and the right one does not show.
    """
    if not c.kind.across or not c.rows_each or not len(first):
        return None
    along = np.array([w["components"][0] if c.kind.directed else 0 for w in c.where])
    grids, of = np.array([len(w["grids"]) == 1 for w in c.where]), np.full(len(c), -1)
    for k in np.unique(along[first]):
        chosen, own = first[along[first] == k], np.flatnonzero(grids & (along == k))
        own = own[thinned(c.spots[own], size / c.kind.across / SEARCH.closer)] if len(own) else own
        rows = np.union1d(chosen, own)
        nearest = cKDTree(c.spots[chosen]).query(c.spots[rows])[1]
        of[rows] = np.flatnonzero(along[first] == k)[nearest]
    found = np.flatnonzero(of >= 0)
    return Neighbourhoods(found, of) if len(found) > len(first) else None


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


@dataclass(frozen=True, eq=False)
class Look:
    """Places (n,), misfit and prior of the best size there (n,), and its θ (n, t)."""

    rows: Ints
    cost: Floats
    theta: Floats

    def best(self) -> Ints:
        """Return the rows that cost least: a part of them."""
        return np.asarray(self.rows[_best(self.cost)])


def look(
    problem: Problem,
    state: Fit,
    kind: int,
    rows: Ints,
    around: Neighbourhoods | None = None,
    worth: float = np.inf,
) -> Look:
    """Evaluate places `rows` of a kind, see `scan`; those that promise nothing are left out.

    Of what sits at points `around` holds neighbourhoods, each of which gives one place. Of other
    kinds those that cost more than is `worth` get a closer look at every other size only.
    """
    c = problem.catalogue[kind]
    if c.kind.at_points and c.rows_each:
        return _hopeful(problem, state, kind, rows, around)
    return _smallest_first(problem, state, kind, rows, worth)


def _hopeful(
    problem: Problem, state: Fit, kind: int, rows: Ints, around: Neighbourhoods | None
) -> Look:
    """Evaluate the places that promise most to first order, at the sizes that do."""
    c = problem.catalogue[kind]
    one = c.rows_each == 1
    foretell, few = promising if one else foretold, c.trials if one else c.trials[every_other(c)]
    hope = (foretell(problem, state, kind, rows, few) + c.surprise(few)).min(axis=1)
    if around is not None:
        first = around.first(rows, hope)
        rows, hope = rows[first], hope[first]
    rows = rows[np.argsort(hope, kind="stable")[: SEARCH.hopeful]]
    guess = foretell(problem, state, kind, rows, c.trials) + c.surprise(c.trials)
    sizes = c.trials[np.argsort(guess, axis=1, kind="stable")[:, : SEARCH.sizes_each]]
    cost = scan(problem, state, kind, rows, sizes) + c.surprise(sizes)
    return Look(rows, cost.min(axis=1), sizes[np.arange(len(rows)), cost.argmin(axis=1)])


def _smallest_first(problem: Problem, state: Fit, kind: int, rows: Ints, worth: float) -> Look:
    """Evaluate all places at every other size, the best that are `worth` it at all sizes."""
    c = problem.catalogue[kind]
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


def every_other(c: Candidates) -> Bools:
    """Of the sizes that give and of those that take, every other one from the smallest on."""
    value = c.law.value(c.trials, np.zeros(len(c.trials), np.int64))[:, 0]
    out = np.zeros(len(c.trials), bool)
    for sign in (1.0, -1.0):
        own = np.flatnonzero(sign * value > 0.0)
        out[own[np.argsort(np.abs(value[own]), kind="stable")][::2]] = True
    return out


def foretold(problem: Problem, state: Fit, kind: int, rows: Ints, trials: Floats) -> Floats:
    """Return the misfit of a mass at every place and of every size to first order, (n, n_trial).

    It adds m uᵢ·uⱼ to the modal masses, by which the eigenvalue of a mode becomes λᵢ / (1 + m uᵢ²).
    Each pair of modes turns as two do that are coupled so: by half the angle whose tangent is twice
    the coupling over the difference of their eigenvalues. At the sensors modes are taken as
    orthogonal.
    """
    U, law = problem.part(kind, rows, state.nuisance)
    n = min(problem.columns, len(state.eigenvalues))
    modes = state.vectors[: problem.basis.size, :n]
    U, seen = stacked_product(U, modes), problem.sensors @ modes
    e, own, noise = problem.evidence, state.match, problem.evidence.noise
    length = np.maximum(np.linalg.norm(seen, axis=0), np.finfo(float).tiny)
    cross, aim = e.shapes.T @ (seen / length), targets(e)
    lam = np.maximum(state.eigenvalues[:n], SEARCH.secular_least * aim.min())
    out = np.empty((len(rows), len(trials)))
    for start in range(0, len(rows), SEARCH.at_once):
        some = np.arange(start, min(start + SEARCH.at_once, len(rows)))
        u = U[some]
        for j, theta in enumerate(trials):
            c = law.value(np.broadcast_to(theta, (len(some), len(theta))), some)[..., None]
            heavier = 1.0 + np.sum(c * u**2, axis=1)
            each, scale = lam / heavier, 1.0 / np.sqrt(heavier)
            twice = np.matmul((u[:, :, own] * c).transpose(0, 2, 1), u)
            twice *= -2.0 * scale[:, own, None] * scale[:, None, :]
            log = np.log(each)
            off = 0.5 * (log[:, own] - np.log(aim))
            lost = 1.0 - _macs(twice, log, own, cross, noise.mixing)
            d = (off / noise.frequency) ** 2 + noise.independent * lost / noise.shape**2
            out[some, j] = robust(d, noise.robust).sum(axis=1)
    return out


def _macs(twice: Floats, log: Floats, own: Ints, cross: Floats, size: float) -> Floats:
    """Return the MAC of each test mode with the mode `own` (t,) as it turns, (n, t).

    Coupled by half of `twice` (n, t, r) beside their eigenvalues, of which `log` (n, r) are the
    logs; `cross` (t, r) are test shapes times modes. Of a mode j it takes
    tan α = 2 b / (|g| + √(g² + 4 b²)), b being coupled and g the gap between the logs, times
    g² / (g² + size²): modes that differ by no more than `size` turn freely, see `mixing`.
    """
    turned = log[:, own, None] - log[:, None, :]
    away = np.abs(turned)
    square = np.square(turned)
    over = np.square(twice)
    over += square
    np.sqrt(over, out=over)
    over += away
    square += size**2
    over *= square
    np.maximum(over, np.finfo(float).tiny, out=over)
    turned *= away
    turned *= twice
    turned /= over
    turned[:, np.arange(len(own)), own] = 1.0
    onto = np.einsum("ntr,tr->nt", turned, cross)
    return np.asarray(np.minimum(onto**2 / np.einsum("ntr,ntr->nt", turned, turned), 1.0))


def promising(problem: Problem, state: Fit, kind: int, rows: Ints, trials: Floats) -> Floats:
    """Return the misfit of every place and size to first order, (n, n_trial).

    To a structure with eigenvalues λᵢ and modes φᵢ that it pulls at along u, a mass m on a spring
    of flexibility c is the flexibility c − 1/(mλ), a spring alone is c. An eigenvalue λ of both
    and its shape, scaled by any mode i that takes part, satisfy

        λ = λᵢ + uᵢ s,   φ = φᵢ − s Σ_{j≠i} uⱼ φⱼ / (λⱼ − λ),
        s = uᵢ / (c − 1/(mλ) + Σ_{j≠i} uⱼ² / (λⱼ − λ)).

    At the eigenvalue of a test mode this gives, with no eigensolution, by how much frequency and
    shape are missed, be it large. See `scan` for the arguments; kinds with one row each only.
    """
    U, law = problem.part(kind, rows, state.nuisance)
    modes = state.vectors[: problem.basis.size]
    U, seen = stacked_product(U, modes), problem.sensors @ modes
    lam, aim = np.maximum(state.eigenvalues, 0.0), targets(problem.evidence)
    at_sensors = problem.evidence.shapes.T @ seen, np.asarray(seen.T @ seen, dtype=float)
    out = []
    for start in range(0, len(rows), SEARCH.at_once):
        part = np.arange(len(rows))[start : start + SEARCH.at_once]
        each = [np.broadcast_to(t, (len(part), len(t))) for t in trials]
        own = np.stack([_flexibility(law, t, part, aim) for t in each], axis=1)
        out.append(_misfit(problem.evidence, at_sensors, lam, U[part, 0], own))
    return np.concatenate(out)


def _flexibility(law: Law, theta: Floats, rows: Ints, aim: Floats) -> Floats:
    """Return the flexibility of what pulls at each row at some eigenvalues, (n, n_test)."""
    c = law.value(theta, rows)[:, :1]
    if law.on == "K":
        return np.broadcast_to(1.0 / c, (len(rows), len(aim)))
    return np.asarray(law.flexibility(theta, rows)[:, :1] - 1.0 / (c * aim))


def _misfit(
    e: Evidence, at_sensors: tuple[Floats, Floats], lam: Floats, u: Floats, flexibility: Floats
) -> Floats:
    """Misfit for flexibilities (n, n_trial, n_test) at places with mode motion u (n, r).

    `at_sensors` are products of test shapes with modes (n_test, r), and of modes (r, r).
    """
    aim, (cross, gram) = targets(e), at_sensors
    tests, tiny = np.arange(len(aim)), SEARCH.nil * aim[:, None]
    gap = lam - aim[:, None]
    gap = np.where(np.abs(gap) < tiny, tiny, gap)
    best = np.full(flexibility.shape, np.inf)
    for i in np.argsort(np.abs(gap), axis=1)[:, : SEARCH.nearest].T:
        away = 1.0 / gap
        away[tests, i] = 0.0
        ui = u[:, i]
        s = ui[:, None] / (flexibility + ((u**2) @ away.T)[:, None])
        off = 0.5 * np.log(np.maximum((lam[i] + ui[:, None] * s) / aim, SEARCH.secular_least))
        rest = u[:, None] * away
        across = cross[tests, i] - s * (u @ (away * cross).T)[:, None]
        square = (
            gram[i, i]
            - 2.0 * s * (u @ (away * gram[i]).T)[:, None]
            + s**2 * np.einsum("ntr,ntr->nt", rest @ gram, rest)[:, None]
        )
        mac = np.minimum(across**2 / np.maximum(square, np.finfo(float).tiny), 1.0)
        noise = e.noise
        d = (off / noise.frequency) ** 2 + noise.independent * (1.0 - mac) / noise.shape**2
        best = np.minimum(best, d)
    return np.asarray(robust(best, e.noise.robust).sum(axis=-1))
