"""Search over combinations of suspects, able to take back an earlier choice.

A beam of hypotheses grows by one suspect at a time. From each, every place and several sizes of
every kind are evaluated exactly on the basis of its own eigenvectors; the best places that lie
apart are fitted together with everything chosen before, moved to better neighbours, and each
earlier suspect is taken out and looked for anew.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Bools, Floats, Ints
from .alike import distinct
from .basis import structural
from .candidates import Suspect
from .fitting import Fit, Problem, evaluate, fit, softened, solve
from .looking import look
from .scanning import best_apart, scan

_NEIGHBOURING = np.array([-0.5, -0.2, 0.0, 0.2, 0.5])
"""Steps of θ tried when a suspect moves to a neighbouring place."""
_HOPELESS = 0.3
"""A further suspect that gains less than this share of its price before it is moved to better
neighbours is given up."""
_NEAR = 0.5
"""A kind whose best place gains this share of what the best of all gains is followed too."""
_NEARBY = np.array([-0.35, 0.0, 0.35])
"""Steps of θ tried around the best places of the first scan."""
_FEW = 300
"""Places of all kinds but tuned ones up to which more of them are fitted, the known parameters
with them."""
_WORTH = 0.35
"""A branch that gains less than this share of what the best one gains is not fitted."""
_TUNED = 2
"""Hypotheses with a tuned suspect that are followed beside the others, if they lead."""
_CLOSE = 0.35
"""A hypothesis that gained less than all but this share of what the best gained is not grown."""
_ROUNDS = 6
"""Times that a suspect moves to a neighbour at most."""
_WORSE = 1.015
"""A neighbour with more than this times the misfit, before it is fitted, is not fitted: one in
thirty of them would have turned out better."""
_PROMISING = 10
"""Neighbouring places, the best at θ as it is, at which those changes are tried."""


@dataclass(frozen=True)
class Effort:
    """How wide the search looks.

    Models of up to `twice` degrees of freedom are searched a second time, with all kinds at once.
    """

    beam: int = 3
    branches: int = 4
    looked_at: int = 6
    around: int = 22
    neighbours: int = 60
    of_each_kind: int = 2
    most: int = 4
    search_modes: int = 48
    apart: float = 0.08
    near: float = 0.06
    twice: int = 8000


@dataclass(frozen=True, eq=False)
class Found:
    """The best hypothesis for each number of suspects, and rivals.

    `levels` [k] is the best fit with k suspects; `rivals` are other fits with as many suspects as
    the best one, best first, places or kinds apart.
    """

    levels: tuple[Fit, ...]
    rivals: tuple[tuple[Fit, ...], ...]


@dataclass(frozen=True, eq=False)
class Searcher:
    """The search with what it needs at every step.

    `coarse` holds for every kind the rows that a first scan looks at.
    """

    problem: Problem
    coarse: tuple[Ints, ...]
    active: tuple[int, ...]
    start: Floats
    size: float
    effort: Effort

    def null(self) -> Fit:
        """Fit the known parameters alone."""
        return fit(self.problem, self.start, (), self.active, iterations=25)

    def local(self, state: Fit) -> tuple[Problem, Fit]:
        """Return the problem on the lowest eigenvectors of a fit, and the fit there."""
        n = min(self.effort.search_modes, self.problem.basis.size)
        values, T = solve(self.problem, state.log_p, state.suspects, self.problem.basis.size)
        T, own = np.split(T, [self.problem.basis.size])
        rest = T[:, n:] / np.sqrt(np.maximum(values[n:], np.finfo(float).tiny))
        bare = replace(self.problem, basis=self.problem.basis.bare(), modes=n)
        small = bare.turned(structural(T[:, :n], own[:, :n]), rest, state.suspects)
        return small, evaluate(small, state.log_p, state.suspects)

    def _varied(self, branches: Sequence[tuple[float, Suspect]], base: float) -> list[Suspect]:
        """Keep the best branches of all and the best of every kind, if they gain enough.

        A kind that is tuned can imitate the others before they are at their right place, so these
        are held against each other alone.
        """
        number: Counter[str | bool] = Counter()
        kept: list[Suspect] = []
        simple = next((b for b in branches if not self._tuned(b[1])), branches[0])
        for score, s in branches:
            tuned, kind = self._tuned(s), self.problem.catalogue[s.kind].kind
            best = (branches[0] if tuned else simple)[0]
            if base - score < _WORTH * (base - best) and kept and not self._small:
                continue
            number.update((tuned, kind))
            each = self.effort.of_each_kind * (4 if self._small else 1)
            if number[tuned] <= self.effort.branches or number[kind] <= each:
                kept.append(s)
        return kept

    def _tuned(self, s: Suspect) -> bool:
        return self.problem.catalogue[s.kind].tunings > 1

    @property
    def _small(self) -> bool:
        """Whether there are so few places that many of them can be fitted."""
        kinds = zip(self.problem.catalogue, self.coarse, strict=True)
        return sum(len(rows) for c, rows in kinds if c.tunings == 1) < _FEW

    def _leading(self, fits: Sequence[Fit], base: float) -> list[Fit]:
        """Keep the best fits, and the best whose last suspect is of another kind if it is near."""
        most = self.effort.beam - (len(fits[0].suspects) > 1)
        kept, kinds = list(fits[:most]), set()
        for f in fits:
            kind = self.problem.catalogue[f.suspects[-1].kind].kind
            near = base - f.objective > _NEAR * (base - fits[0].objective)
            if kind not in kinds and near and not any(f is g for g in kept):
                kept.append(f)
            kinds.add(kind)
        return kept

    def branches(self, state: Fit, count: int) -> list[tuple[float, Suspect]]:
        """Return the most promising further suspects of every kind by exact evaluation."""
        small, here = self.local(state)
        small = softened(small)
        out: list[tuple[float, Suspect]] = []
        for kind in range(len(small.catalogue)):
            c, rows = small.catalogue[kind], self.coarse[kind]
            rows = rows[~self._taken(state, kind, rows)]
            if not len(rows):
                continue
            seen = look(small, here, kind, rows)
            tried = list(zip(seen.cost, seen.rows, seen.theta, strict=True))
            coarse = best_apart(
                c.xyz[seen.rows], seen.cost, self.effort.apart * self.size, self.effort.looked_at
            )
            done = set(seen.rows.tolist())
            for i in coarse:
                near = self._around(kind, int(seen.rows[i]))
                near = near[~self._taken(state, kind, near)]
                near = np.array([r for r in near.tolist() if r not in done], dtype=np.int64)
                if not len(near):
                    continue
                done.update(near.tolist())
                theta = tried[i][2]
                alike = scan(small, here, kind, near, theta[None])[:, 0]
                near = near[np.argsort(alike, kind="stable")[: _PROMISING // 2]]
                trials = c.around(theta, _NEARBY)
                fine = scan(small, here, kind, near, trials) + c.surprise(trials)
                tried += zip(fine.min(axis=1), near, trials[fine.argmin(axis=1)], strict=True)
            best = np.array([t[0] for t in tried])
            every = np.array([t[1] for t in tried], dtype=np.int64)
            for i in best_apart(c.xyz[every], best, self.effort.apart * self.size, count):
                out.append((float(best[i]), Suspect(kind, int(every[i]), tuple(tried[i][2]))))
        return sorted(out, key=lambda b: b[0])

    def _around(self, kind: int, row: int) -> Ints:
        """Places next to one, nearest first."""
        xyz = self.problem.catalogue[kind].xyz
        distance = np.linalg.norm(xyz - xyz[row], axis=1)
        near = np.flatnonzero(distance < self.effort.apart * self.size)
        return np.asarray(near[np.argsort(distance[near], kind="stable")][: self.effort.around])

    def _taken(self, state: Fit, kind: int, rows: Ints) -> Bools:
        """Places too near to a suspect of the same kind to be a second one, (n,)."""
        xyz = self.problem.catalogue[kind].xyz
        taken = np.zeros(len(rows), bool)
        for s in state.suspects:
            if s.kind == kind:
                apart = np.linalg.norm(xyz[rows] - xyz[s.row], axis=1)
                taken |= apart < self.effort.apart * self.size
        return taken

    def fitted(
        self,
        state: Fit,
        suspects: Sequence[Suspect],
        iterations: int = 6,
        small: Problem | None = None,
        soften: bool = False,
    ) -> Fit:
        """Fit suspects and parameters on the basis of a state, then weigh on the full basis."""
        small = small or self.local(state)[0]
        if soften:
            near = fit(softened(small), state.log_p, suspects, self.active, iterations)
            suspects, state = near.suspects, near
        quick = fit(small, state.log_p, suspects, self.active, iterations)
        return fit(self.problem, quick.log_p, quick.suspects, self.active, 2)

    def refined(self, state: Fit) -> Fit:
        """Move every suspect to better neighbours until none is better."""
        n = len(state.suspects)
        left, q = n, 0
        for _ in range(_ROUNDS * n):
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
        fresh = np.zeros_like(state.log_p)
        near = fit(softened(self.problem), fresh, state.suspects, self.active, 6)
        again = fit(self.problem, near.log_p, near.suspects, self.active, 6)
        return again if again.objective < state.objective else state

    def _neighbour(self, state: Fit, q: int) -> Fit | None:
        suspect = state.suspects[q]
        others = state.suspects[:q] + state.suspects[q + 1 :]
        c = self.problem.catalogue[suspect.kind]
        distance = np.linalg.norm(c.xyz - c.xyz[suspect.row], axis=1)
        rows = np.flatnonzero(distance <= self.effort.near * self.size)
        rows = rows[np.argsort(distance[rows], kind="stable")][: self.effort.neighbours]
        without = evaluate(self.problem, state.log_p, others)
        rows = rows[~self._taken(without, suspect.kind, rows)]
        if not len(rows):
            return None
        small, here = self.local(without)
        first = scan(small, here, suspect.kind, rows, np.array([suspect.theta]))[:, 0]
        rows = rows[np.argsort(first, kind="stable")[:_PROMISING]]
        trials = c.around(suspect.theta, _NEIGHBOURING)
        score = scan(small, here, suspect.kind, rows, trials)
        best = score.min(axis=1)
        small = self.local(state)[0]
        stays = best[rows == suspect.row].min(initial=np.inf)
        for i in np.argsort(best, kind="stable")[:3]:
            if rows[i] == suspect.row or best[i] > _WORSE * stays:
                continue
            moved = replace(suspect, row=int(rows[i])).moved(trials[score[i].argmin()])
            beside = (*state.suspects[:q], moved, *state.suspects[q + 1 :])
            trial = self.fitted(state, beside, 4, small)
            if trial.objective < state.objective - 0.3:
                return trial
        return None

    def reconsidered(self, state: Fit) -> Fit:
        """Take each suspect out in turn and look for a better one anywhere.

        The last of a new state was looked for just so, and is left out in the first round.
        """
        moved = True
        rounds = 0
        while moved and rounds < 1:
            moved, rounds = False, rounds + 1
            for q in self._doubtful(state, rounds):
                others = state.suspects[:q] + state.suspects[q + 1 :]
                without = self.fitted(state, others, 4)
                for _, branch in self.branches(without, 2)[:3]:
                    trial = self.fitted(without, (*others, branch), 5, soften=True)
                    if trial.objective < state.objective + 0.05 * abs(state.objective):
                        trial = self.settled(self.refined(trial))
                    if trial.objective < state.objective - 1.0:
                        state, moved = trial, True
                        break
        return state

    def _fair(self, poorer: Fit, best: Fit) -> Fit:
        """Return the poorer hypothesis, or the better one with a suspect less if that fits better.

        A richer hypothesis must not win because its parameters came into a better valley.
        """
        for q in range(len(best.suspects)):
            others = best.suspects[:q] + best.suspects[q + 1 :]
            trial = fit(self.problem, best.log_p, others, self.active, 12)
            if trial.objective < poorer.objective:
                poorer = trial
        return poorer

    def _doubtful(self, state: Fit, rounds: int) -> list[int]:
        """Suspects to be looked for anew: of many only the one that is missed least."""
        older = list(range(len(state.suspects) - (rounds == 1)))
        if len(state.suspects) < 3:
            return older
        left = [
            evaluate(
                self.problem, state.log_p, state.suspects[:q] + state.suspects[q + 1 :]
            ).objective
            for q in older
        ]
        return [older[int(np.argmin(left))]]

    def run(
        self,
        enough: Callable[[Fit, Fit, float], bool],
        progress: Callable[[str], None] = lambda _: None,
    ) -> Found:
        """Grow the beam until one more suspect no longer earns its place.

        Parameters
        ----------
        enough : callable
            ``enough(previous, next, share)``: whether the richer fit is not worth that share of
            what its suspects cost.
        progress : callable
            Told what happens.
        """
        levels = [self.settled(self.null())]
        rivals: list[tuple[Fit, ...]] = [()]
        beam = [levels[0]]
        for depth in range(1, self.effort.most + 1):
            progress(f"looking for {depth} missing effect{'s' if depth > 1 else ''}")
            grown: list[Fit] = []
            for state in beam:
                count = self.effort.branches * (3 if self._small else 1)
                small, here = self.local(state)
                soft = evaluate(softened(small), here.log_p, here.suspects).objective
                for branch in self._varied(self.branches(state, count), soft):
                    grown.append(self.fitted(state, (*state.suspects, branch), 5, small, True))
                best = min(grown, key=lambda f: f.objective)
                if depth > 1 and enough(levels[-1], best, _HOPELESS):
                    break
            chosen = self._distinct(sorted(grown, key=lambda f: f.objective))
            if not chosen:
                break
            if depth > 1 and enough(levels[-1], chosen[0], _HOPELESS):
                levels.append(chosen[0])
                rivals.append(tuple(chosen[1:12]))
                break
            plain, tuned = self._leagues(chosen)
            before, _ = self._leagues(beam)
            base = min((f.objective for f in before), default=levels[-1].objective)
            followed = self._leading(plain, base) if plain else []
            followed += [f for f in tuned if any(f is g for g in chosen[:_TUNED])]
            beam = sorted(map(self.settled, map(self.refined, followed)), key=_objective)
            if depth > 1:
                firsts = [id(league[0]) for league in self._leagues(beam) if league]
                beam = [self.reconsidered(f) if id(f) in firsts else f for f in beam]
            beam = self._distinct(sorted(beam, key=_objective))
            best = beam[0]
            rest = (*beam[1:], *chosen[self.effort.beam :])
            rivals.append(rest[:12])
            levels[-1] = self._fair(levels[-1], best)
            previous = levels[-1]
            levels.append(best)
            if enough(previous, best, 1.0):
                break
            plain, tuned = self._leagues(beam)
            beam = [*self._near(plain, base), *(tuned[:1] if tuned and tuned[0] is best else ())]
            beam = sorted(beam, key=_objective)
        return Found(tuple(levels), tuple(rivals))

    def _distinct(self, fits: Sequence[Fit]) -> list[Fit]:
        near = 0.5 * self.effort.apart * self.size
        return distinct(fits, self.problem.catalogue, near)

    def _near(self, fits: Sequence[Fit], base: float) -> list[Fit]:
        """Return the best and the next few that gained nearly as much over `base`."""
        if not fits:
            return []
        near = fits[0].objective + _CLOSE * (base - fits[0].objective)
        return [f for f in fits[: self.effort.beam - 1] if f is fits[0] or f.objective < near]

    def _leagues(self, fits: Sequence[Fit]) -> tuple[list[Fit], list[Fit]]:
        """Return the fits without a tuned suspect, and those with one.

        Before the rest is right a tuned kind imitates the others; what has none is followed as if
        there were no tuned kinds.
        """
        plain = [f for f in fits if not any(map(self._tuned, f.suspects))]
        return plain, [f for f in fits if any(map(self._tuned, f.suspects))]


def _objective(f: Fit) -> float:
    return f.objective
