"""Search over combinations of suspects, able to take back an earlier choice.

A beam of hypotheses grows by one suspect at a time. From each, every place and several sizes of
every kind are evaluated exactly on the basis of its own eigenvectors; the best places that lie
apart are fitted together with everything chosen before, moved to better neighbours, and each
earlier suspect is taken out and looked for anew.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Bools, Floats, Ints
from .candidates import Suspect
from .fitting import Fit, Problem, evaluate, fit, solve
from .scanning import best_apart, scan

_NEIGHBOURING = np.array([-0.5, -0.2, 0.0, 0.2, 0.5])
"""Changes of θ tried when a suspect moves to a neighbouring place."""


@dataclass(frozen=True)
class Effort:
    """How wide the search looks."""

    beam: int = 3
    branches: int = 4
    most: int = 4
    search_modes: int = 56
    apart: float = 0.08
    near: float = 0.06


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
        rest = T[:, n:] / np.sqrt(np.maximum(values[n:], np.finfo(float).tiny))
        small = replace(self.problem.turned(T[:, :n], rest), modes=n)
        return small, evaluate(small, state.log_p, state.suspects)

    def branches(self, state: Fit, kinds: Sequence[int], count: int) -> list[tuple[float, Suspect]]:
        """Return the most promising further suspects of every kind by exact evaluation."""
        small, here = self.local(state)
        out: list[tuple[float, Suspect]] = []
        for kind in kinds:
            c, rows = small.catalogue[kind], self.coarse[kind]
            if not len(rows):
                continue
            score = scan(small, here, kind, rows, c.trials)
            score[self._taken(state, kind, rows)] = np.inf
            prior = ((c.trials - c.typical) / c.spread) ** 2
            total = score + prior[None, :]
            best = total.min(axis=1)
            for i in best_apart(c.xyz[rows], best, self.effort.apart * self.size, count):
                theta = float(c.trials[total[i].argmin()])
                out.append((float(best[i]), Suspect(kind, int(rows[i]), theta)))
        return sorted(out, key=lambda b: b[0])

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
    ) -> Fit:
        """Fit suspects and parameters on the basis of a state, then weigh on the full basis."""
        small = small or self.local(state)[0]
        quick = fit(small, state.log_p, suspects, self.active, iterations)
        return fit(self.problem, quick.log_p, quick.suspects, self.active, 2)

    def refined(self, state: Fit) -> Fit:
        """Move every suspect to better neighbours until none is better."""
        moved = True
        rounds = 0
        while moved and rounds < 6:
            moved, rounds = False, rounds + 1
            for q in range(len(state.suspects)):
                better = self._neighbour(state, q)
                if better is not None:
                    state, moved = better, True
        return state

    def _neighbour(self, state: Fit, q: int) -> Fit | None:
        suspect = state.suspects[q]
        others = state.suspects[:q] + state.suspects[q + 1 :]
        c = self.problem.catalogue[suspect.kind]
        distance = np.linalg.norm(c.xyz - c.xyz[suspect.row], axis=1)
        rows = np.flatnonzero(distance <= self.effort.near * self.size)
        rows = rows[np.argsort(distance[rows], kind="stable")][:160]
        without = evaluate(self.problem, state.log_p, others)
        rows = rows[~self._taken(without, suspect.kind, rows)]
        if not len(rows):
            return None
        small, here = self.local(without)
        trials = suspect.theta + _NEIGHBOURING
        score = scan(small, here, suspect.kind, rows, trials)
        best = score.min(axis=1)
        for i in np.argsort(best, kind="stable")[:3]:
            if rows[i] == suspect.row:
                continue
            moved = replace(suspect, row=int(rows[i]), theta=float(trials[score[i].argmin()]))
            trial = self.fitted(state, (*state.suspects[:q], moved, *state.suspects[q + 1 :]), 4)
            if trial.objective < state.objective - 0.3:
                return trial
        return None

    def reconsidered(self, state: Fit, kinds: Sequence[int]) -> Fit:
        """Take each suspect out in turn and look for a better one anywhere."""
        moved = True
        rounds = 0
        while moved and rounds < 2:
            moved, rounds = False, rounds + 1
            for q in range(len(state.suspects)):
                others = state.suspects[:q] + state.suspects[q + 1 :]
                without = self.fitted(state, others, 4)
                for _, branch in self.branches(without, kinds, 3)[:4]:
                    trial = self.fitted(without, (*others, branch), 6)
                    if trial.objective < state.objective + 0.05 * abs(state.objective):
                        trial = self.refined(trial)
                    if trial.objective < state.objective - 1.0:
                        state, moved = trial, True
                        break
        return state

    def run(
        self, enough: Callable[[Fit, Fit], bool], progress: Callable[[str], None] = lambda _: None
    ) -> Found:
        """Grow the beam until one more suspect no longer earns its place.

        Parameters
        ----------
        enough : callable
            ``enough(previous, next)``: whether the richer fit is not worth its suspects.
        progress : callable
            Told what happens.
        """
        everything = tuple(range(len(self.problem.catalogue)))
        levels = [self.null()]
        rivals: list[tuple[Fit, ...]] = [()]
        beam = [levels[0]]
        kinds: Sequence[int] = everything
        for depth in range(1, self.effort.most + 1):
            progress(f"looking for {depth} missing effect{'s' if depth > 1 else ''}")
            grown: list[Fit] = []
            for state in beam:
                small = self.local(state)[0]
                for _, branch in self.branches(state, kinds, self.effort.branches)[:7]:
                    grown.append(self.fitted(state, (*state.suspects, branch), 5, small))
            chosen = self._distinct(sorted(grown, key=lambda f: f.objective))
            beam = sorted(
                (self.refined(f) for f in chosen[: self.effort.beam]), key=lambda f: f.objective
            )
            if not beam:
                break
            if depth > 1:
                beam[0] = self.reconsidered(beam[0], kinds)
            beam = self._distinct(sorted(beam, key=lambda f: f.objective))
            best = beam[0]
            rest = (*beam[1:], *chosen[self.effort.beam :])
            rivals.append(rest[:12])
            previous = levels[-1]
            levels.append(best)
            if enough(previous, best):
                break
            strong = {
                s.kind
                for f in (*beam, *chosen[:8])
                for s in f.suspects
                if f.objective < best.objective + 0.6 * (previous.objective - best.objective)
            }
            kinds = sorted(strong) or everything
        return Found(tuple(levels), tuple(rivals))

    def _distinct(self, fits: Sequence[Fit]) -> list[Fit]:
        """Drop fits whose suspects are the same kinds at about the same places as a better one."""
        kept: list[Fit] = []
        for f in fits:
            if not any(self._same(f, g) for g in kept):
                kept.append(f)
        return kept

    def _same(self, f: Fit, g: Fit) -> bool:
        if len(f.suspects) != len(g.suspects):
            return False
        left = list(g.suspects)
        for s in f.suspects:
            twin = next((t for t in left if self._close(s, t)), None)
            if twin is None:
                return False
            left.remove(twin)
        return True

    def _close(self, s: Suspect, t: Suspect) -> bool:
        if s.kind != t.kind:
            return False
        xyz: Floats = self.problem.catalogue[s.kind].xyz
        apart = float(np.linalg.norm(xyz[s.row] - xyz[t.row]))
        return apart < 0.5 * self.effort.apart * self.size
