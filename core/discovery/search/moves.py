"""Steps of a search over combinations of suspects, able to take back an earlier choice.

Every place and several sizes of every kind are evaluated exactly beside a hypothesis, on the basis
of its own eigenvectors; suspects are fitted together, moved to better neighbours, and each earlier
one is taken out and looked for anew.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import chain, permutations

import numpy as np

from ...arrays import Bools, Floats, Ints
from ..discovery_numbers import DISCOVERY
from ..effects.candidates import Candidates, Suspect, beside as stretches_beside, places_of
from ..effects.element_patches import Patch, PatchCandidates
from ..likelihood.hypothesis import Fit, Problem, softened
from ..likelihood.map_fit import evaluate, fit, promised, solve
from ..likelihood.repeated_modes import none_cut
from ..model_error.diffuse_fit import Judged, everything
from ..reduction.search_basis import structural
from .coarse_scan import Look, Neighbourhoods, look
from .exact_scan import best_apart, scan
from .found import objective_of
from .search_numbers import SEARCH

_NONE, _NEARBY = np.zeros(0, np.int64), np.array(SEARCH.nearby)


@dataclass(frozen=True, eq=False)
class Scanned:
    """The best further suspects with what each would leave; of every kind rows that gain most."""

    best: list[tuple[float, Suspect]]
    live: tuple[Ints, ...]


@dataclass(frozen=True, eq=False)
class Searcher:
    """The search with what it needs at every step.

    `coarse` holds for every kind the rows that a first scan looks at, `beside` what lies around
    them where it takes the most promising there; ``judged(problem, fit, least)`` is a hypothesis as
    the error of the model judges it, None where its model does not solve, in full where it may have
    the evidence `least`.
    """

    problem: Problem
    coarse: tuple[Ints, ...]
    start: Floats
    size: float
    judged: Callable[..., Judged | None] = lambda *_: None
    beside: tuple[Neighbourhoods | None, ...] = ()

    @property
    def active(self) -> tuple[int, ...]:
        """Numbers of the known parameters and the error of the mesh: all are fitted."""
        return everything(self.problem)

    def null(self) -> Fit:
        """Fit the known parameters alone."""
        return fit(self.problem, self.start, (), self.active, DISCOVERY.steps)

    def local(self, state: Fit) -> tuple[Problem, Fit]:
        """Return the problem on the lowest eigenvectors of a fit, and the fit there."""
        return _local(self.problem, state, min(SEARCH.search_modes, self.problem.basis.size))

    def without(self, state: Fit, q: int) -> tuple[Problem, Fit]:
        """Return the same of a fit less one suspect, nothing else moved."""
        return self.local(evaluate(self.problem, state.nuisance, state.others(q)))

    def with_kind(self, kind: int, new: Candidates) -> Searcher:
        """Put candidates into the catalogue, as one of its numbers; no scan looks at a new one."""
        p = self.problem
        coarse = self.coarse if kind < len(self.coarse) else (*self.coarse, _NONE)
        problem = p.with_kind(kind, new, new.factors(p.basis))
        return replace(self, problem=problem, coarse=coarse)

    def with_patches(self, kind: int, patches: Sequence[Patch]) -> Searcher:
        """Put patches into the catalogue, after those that one of its numbers has."""
        c, p = self.problem.catalogue[kind], self.problem
        assert isinstance(c, PatchCandidates)
        more = c.with_patches(patches)
        return replace(self, problem=p.with_kind(kind, more, more.extended(p.factors[kind])))

    def branches(self, state: Fit, count: int, soft: bool = True) -> list[tuple[float, Suspect]]:
        """Return the most promising further suspects of every kind, see `scanned`."""
        return self.scanned(state, count, self.coarse, soft).best

    def scanned(
        self, state: Fit, count: int, among: tuple[Ints, ...], soft: bool = True
    ) -> Scanned:
        """Return the most promising further suspects of every kind, `count` of each.

        Of the places `among` the rows of each kind and those next to the best of them, exactly with
        all else as it stands, and of the best of these by what a step of all unknowns would leave;
        by a `soft` noise, as far from the truth.
        """
        small, here = self.local(state)
        small = softened(small) if soft else small
        here = evaluate(small, here.nuisance, here.suspects)
        seen: dict[int, Look] = {}
        worth = np.inf
        for kind, rows in enumerate(among):
            beside = self.beside[kind] if kind < len(self.beside) else None
            rows = rows if beside is None else beside.around(rows)
            rows = rows[~self._taken(state, kind, rows)]
            if len(rows):
                seen[kind] = look(small, here, kind, rows, beside, worth)
                gain = here.objective - min(float(s.cost.min()) for s in seen.values())
                worth = here.objective - 0.5 * SEARCH.worth_fitting * gain
        apart, out = SEARCH.apart * self.size, list[tuple[float, Suspect]]()
        for kind, coarse in seen.items():
            tried = self._finer(small, here, kind, coarse, worth)
            spots = small.catalogue[kind].spots[tried.rows]
            for i in best_apart(spots, tried.cost, apart, SEARCH.hoped_each):
                suspect = Suspect(kind, int(tried.rows[i]), tuple(tried.theta[i]))
                out.append((float(tried.cost[i]), suspect))
        live = tuple(seen[k].best() if k in seen else _NONE for k in range(len(among)))
        return Scanned(self._followed(small, here, sorted(out, key=lambda b: b[0]), count), live)

    def _followed(
        self, small: Problem, here: Fit, scanned: list[tuple[float, Suspect]], count: int
    ) -> list[tuple[float, Suspect]]:
        """Return suspects by what is left once the known parameters follow, `count` of each kind.

        What is right and what imitates it differ little before that, and much after.
        """
        first = Counter(s.kind for _, s in scanned[: SEARCH.hoped])
        out, of_kind = list[tuple[float, Suspect]](), Counter[int]()
        for _, s in scanned:
            if of_kind[s.kind] < max(first[s.kind], 1):
                of_kind[s.kind] += 1
                with suppress(np.linalg.LinAlgError):
                    suspects = (*here.suspects, s)
                    out.append((promised(small, here.nuisance, suspects, self.active), s))
        kept, of_kind = list[tuple[float, Suspect]](), Counter[int]()
        for left, s in sorted(out, key=lambda b: b[0]):
            of_kind[s.kind] += 1
            if of_kind[s.kind] <= count:
                kept.append((left, s))
        return kept

    def _finer(self, small: Problem, here: Fit, kind: int, coarse: Look, worth: float) -> Look:
        """Return a first look at a kind with the best places next to the best of it that cost less.

        What `worth` allows; of each, places with its size first, then other sizes at some of them.
        """
        c, spots = small.catalogue[kind], small.catalogue[kind].spots
        apart, done = SEARCH.apart * self.size, set(coarse.rows.tolist())
        groups: list[tuple[int, Ints]] = []
        for i in best_apart(spots[coarse.rows], coarse.cost, apart, SEARCH.looked_at):
            near = self.around(kind, int(coarse.rows[i])) if coarse.cost[i] <= worth else _NONE
            near = near[~self._taken(here, kind, near)]
            near = np.array([r for r in near.tolist() if r not in done], dtype=np.int64)
            done.update(near.tolist())
            groups.append((i, near))
        rows = np.concatenate([near for _, near in groups])
        if not len(rows):
            return coarse
        which = np.repeat([i for i, _ in groups], [len(near) for _, near in groups])
        alike = scan(small, here, kind, rows, coarse.theta[which][:, None])[:, 0]
        order = np.lexsort((alike, which))
        number = np.arange(len(rows)) - np.searchsorted(which[order], which[order])
        kept = order[number < SEARCH.promising // 2]
        rows, which = rows[kept], which[kept]
        moved = np.array([c.around(coarse.theta[i], _NEARBY) for i in which])
        trials = np.concatenate([coarse.theta[which][:, None], moved], axis=1)
        other = scan(small, here, kind, rows, moved)
        fine = np.hstack([alike[kept, None], other]) + c.surprise(trials)
        each, best = np.arange(len(rows)), fine.argmin(axis=1)
        return Look(
            np.concatenate([coarse.rows, rows]),
            np.concatenate([coarse.cost, fine[each, best]]),
            np.concatenate([coarse.theta, trials[each, best]]),
        )

    def around(self, kind: int, row: int) -> Ints:
        """Places next to one, nearest first."""
        spots = self.problem.catalogue[kind].spots
        distance = np.linalg.norm(spots - spots[row], axis=1)
        return nearest(distance, SEARCH.apart * self.size)[: SEARCH.around]

    def _taken(self, state: Fit, kind: int, rows: Ints) -> Bools:
        """Places too near to a suspect of the same kind or nature to be a second one, (n,)."""
        c = self.problem.catalogue[kind]
        taken = np.zeros(len(rows), bool)
        for s in state.suspects:
            other = self.problem.catalogue[s.kind]
            if s.kind == kind or other.kind.joins(c.kind):
                apart = np.linalg.norm(c.spots[rows] - other.spots[s.row], axis=1)
                taken |= apart < SEARCH.apart * self.size
        return taken

    def fitted(
        self, state: Fit, suspects: Sequence[Suspect], iterations: int, soften: bool = False
    ) -> Fit:
        """Fit suspects and parameters on the basis of a state, then weigh on the full basis."""
        small, _ = self.local(state)
        first = state.nuisance, suspects
        if soften:
            near = fit(softened(small), state.nuisance, suspects, self.active, iterations)
            suspects, state = near.suspects, near
        quick = fit(small, state.nuisance, suspects, self.active, iterations)
        whole, steps = self.problem, SEARCH.steps_whole
        try:
            return fit(whole, quick.nuisance, quick.suspects, self.active, steps)
        except np.linalg.LinAlgError:  # shells made thinner leave no mass on the whole basis
            return fit(whole, *first, self.active, steps)

    def refined(self, state: Fit) -> Fit:
        """Move every suspect to better neighbours until none is better."""
        n = len(state.suspects)
        left, q = n, 0
        for _ in range(SEARCH.rounds * n):
            better = self._neighbour(state, q)
            state, left = (state, left - 1) if better is None else (better, n)
            if not left:
                break
            q = (q + 1) % n
        return state

    def settled(self, state: Fit) -> Fit:
        """Fit again from the deck's values.

        Parameters that came from a poorer hypothesis may hold a fit in a valley of its own.
        """
        fresh = np.zeros_like(state.nuisance)
        near = fit(softened(self.problem), fresh, state.suspects, self.active, SEARCH.steps)
        again = fit(self.problem, near.nuisance, near.suspects, self.active, SEARCH.steps)
        return again if again.objective < state.objective else state

    def _neighbour(self, state: Fit, q: int) -> Fit | None:
        suspect = state.suspects[q]
        if stretches := stretches_beside(self.problem.catalogue, suspect):
            return self._best_of(state, q, stretches)
        small, here = self.without(state, q)
        every = self._near(softened(small), here, suspect)
        near = sorted(every, key=lambda moved: moved[0])[: SEARCH.promising]
        soft = softened(self.local(state)[0])
        options = self._hoped(soft, state, (state.instead(q, moved) for _, moved in near))
        stays = promised(soft, state.nuisance, state.suspects, self.active)
        for hope, suspects in options:
            if hope > stays:
                break
            trial = self.fitted(state, suspects, SEARCH.steps_moved)
            if trial.objective < state.objective - SEARCH.better:
                return trial
        return None

    def _hoped(
        self, soft: Problem, state: Fit, options: Iterable[tuple[Suspect, ...]]
    ) -> list[tuple[float, tuple[Suspect, ...]]]:
        """Return the few of which a step of all unknowns would leave least, with what it would."""
        hoped = [(promised(soft, state.nuisance, s, self.active), s) for s in options]
        return sorted(hoped, key=lambda h: h[0])[: SEARCH.moves_tried]

    def forms(self, suspect: Suspect) -> Iterator[tuple[int, Floats, float]]:
        """Give kinds, place and ln of the size of what a suspect may be as well: one of its nature.

        A mass at a point is one on a patch, twins beside each other are one between them.
        """
        own = self.problem.catalogue[suspect.kind]
        spots = np.array([c.xyz[row] for c, row in places_of(own, suspect.row)])
        if np.linalg.norm(np.ptp(spots, axis=0)) < SEARCH.beside * self.size:
            for kind, c in enumerate(self.problem.catalogue):
                if kind != suspect.kind and c.kind.joins(own.kind) and not c.copies:
                    yield kind, spots.mean(axis=0), suspect.theta[0] + float(np.log(len(spots)))

    def _near(self, small: Problem, here: Fit, suspect: Suspect) -> Iterator[tuple[float, Suspect]]:
        """Give the best places near a suspect, in every form, beside all others `here`."""
        c = self.problem.catalogue[suspect.kind]
        away = np.linalg.norm(c.spots - c.spots[suspect.row], axis=1)
        theta, count = np.array(suspect.theta), SEARCH.neighbours
        near = self._promising(small, here, suspect.kind, away, theta, count)
        yield from ((cost, s) for cost, s in near if s.row != suspect.row)
        for kind, spot, size in self.forms(suspect):
            c = self.problem.catalogue[kind]
            away = np.linalg.norm(c.xyz - spot, axis=1)
            yield from self._promising(small, here, kind, away, c.like([size]), SEARCH.around)

    def _promising(
        self, small: Problem, here: Fit, kind: int, away: Floats, theta: Floats, count: int
    ) -> list[tuple[float, Suspect]]:
        """Return what is best of a kind at `count` places near by, from so far `away` (n,)."""
        c = self.problem.catalogue[kind]
        rows = _some(nearest(away, SEARCH.near * self.size), count)
        rows = rows[~self._taken(here, kind, rows)]
        if not len(rows):
            return []
        own = c.within(theta)[None]
        alike = scan(small, here, kind, rows, own)
        kept = np.argsort(alike[:, 0], kind="stable")[: SEARCH.sized]
        rows, moved = rows[kept], c.around(own[0].tolist(), np.array(SEARCH.neighbouring))
        trials = np.concatenate([own, moved])
        score = np.hstack([alike[kept], scan(small, here, kind, rows, moved)])
        best, theta = score.min(axis=1), trials[score.argmin(axis=1)].tolist()
        return [
            (float(best[i]), Suspect(kind, int(rows[i]), tuple(theta[i])))
            for i in np.argsort(best, kind="stable")[: SEARCH.promising]
        ]

    def _best_of(self, state: Fit, q: int, options: Sequence[Suspect]) -> Fit | None:
        """Return the best fit with another suspect in place of one, None where none is better."""
        small, _ = self.without(state, q)
        tried = [
            fit(small, state.nuisance, state.instead(q, s), self.active, SEARCH.steps_moved)
            for s in options
        ]
        for near in sorted(tried, key=objective_of)[: SEARCH.shapes_tried]:
            trial = fit(self.problem, near.nuisance, near.suspects, self.active, SEARCH.steps_moved)
            if trial.objective < state.objective - SEARCH.better:
                return trial
        return None

    def reconsidered(self, state: Fit) -> Fit:
        """Take each suspect but the last out in turn, and look for a better one."""
        for q in self.doubtful(state, len(state.suspects) - 1):
            others = state.others(q)
            without = self.fitted(state, others, SEARCH.steps_moved)
            for _, branch in self.branches(without, SEARCH.anew_looked)[: SEARCH.moves_tried]:
                trial = self.fitted(without, (*others, branch), SEARCH.steps_new, soften=True)
                if trial.objective < state.objective + SEARCH.anew_near * abs(state.objective):
                    trial = self.settled(self.refined(trial))
                if trial.objective < state.objective - 2.0 * SEARCH.likelier:
                    state = trial
                    break
        return state

    def moved_at_once(self, state: Fit) -> Fit:
        """Move two suspects of one nature near each other at once, where that is better.

        Each makes up for the wrong place of the other, so that none moves alone.
        """
        soft = softened(self.local(state)[0])
        pairs = permutations(range(len(state.suspects)), 2)
        moved = (self._moved_both(soft, state, *pair) for pair in pairs)
        options = sorted(chain.from_iterable(moved), key=lambda o: o[0])[: SEARCH.together]
        for _, suspects in self._hoped(soft, state, (s for _, s in options)):
            trial = self.fitted(state, suspects, SEARCH.steps_new, soften=True)
            if trial.objective < state.objective - 2.0 * SEARCH.likelier:
                return self.refined(trial)
        return state

    def _moved_both(
        self, soft: Problem, state: Fit, p: int, q: int
    ) -> Iterator[tuple[float, tuple[Suspect, ...]]]:
        """Give what is left with two suspects near each other both at other places near by."""
        one, other = state.suspects[p], state.suspects[q]
        c, d = (self.problem.catalogue[s.kind] for s in (one, other))
        apart = np.linalg.norm(c.xyz[one.row] - d.xyz[other.row])
        if apart > SEARCH.together_near * self.size or not c.kind.joins(d.kind):
            return
        away, beside = (
            np.linalg.norm(e.spots - e.spots[s.row], axis=1) for e, s in ((c, one), (d, other))
        )
        for row in _some(nearest(away, SEARCH.near * self.size), SEARCH.around):
            moved = replace(state, suspects=state.instead(p, replace(one, row=int(row))))
            here = evaluate(soft, state.nuisance, moved.others(q))
            near = beside, np.array(other.theta), SEARCH.neighbours
            for cost, s in self._promising(soft, here, other.kind, *near):
                yield cost, moved.instead(q, s)

    def doubtful(self, state: Fit, first: int) -> list[int]:
        """Of the `first` suspects those to be looked for anew: of many the one missed least."""
        older = list(range(first))
        if len(state.suspects) < SEARCH.anew_all:
            return older
        left = [evaluate(self.problem, state.nuisance, state.others(q)).objective for q in older]
        return [int(np.argmin(left))]


@lru_cache(maxsize=SEARCH.locals_kept)
def _local(problem: Problem, state: Fit, n: int) -> tuple[Problem, Fit]:
    values, T = solve(problem, state.nuisance, state.suspects, problem.basis.size)
    n = none_cut(values, n)
    T, own = np.split(T, [problem.basis.size])
    rest = T[:, n:] / np.sqrt(np.maximum(values[n:], np.finfo(float).tiny))
    bare = replace(problem, basis=problem.basis.bare(), modes=n)
    small = bare.turned(structural(T[:, :n], own[:, :n]), rest, state.suspects)
    return small, evaluate(small, state.nuisance, state.suspects)


def nearest(away: Floats, most: float) -> Ints:
    """Return the rows of what is so far `away` (n,) at most, nearest first."""
    rows = np.flatnonzero(away <= most)
    return np.asarray(rows[np.argsort(away[rows], kind="stable")])


def _some(rows: Ints, count: int) -> Ints:
    """Return so many of rows in order of distance: half are the nearest, half spread over all."""
    near, far = np.split(rows, [count // 2])
    return np.concatenate([near, far[:: max(1, -(-2 * len(far) // count))]])
