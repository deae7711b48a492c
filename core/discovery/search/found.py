"""What a search comes to: the best hypothesis for each number of suspects, and its rivals."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ..likelihood.hypothesis import Fit, Problem
from ..likelihood.map_fit import evaluate
from .search_numbers import SEARCH


@dataclass(frozen=True, eq=False)
class Found:
    """The best hypothesis for each number of suspects, and rivals.

    `levels` [k] is the best fit with k suspects; `rivals` are other fits with as many suspects as
    the best one, best first, places or kinds apart.
    """

    levels: tuple[Fit, ...]
    rivals: tuple[tuple[Fit, ...], ...]

    def with_level(self, f: Fit) -> Found:
        """Return the same with another best hypothesis of as many suspects."""
        k = len(f.suspects)
        return Found((*self.levels[:k], f, *self.levels[k + 1 :]), self.rivals)

    def with_rivals(self, fits: Iterable[Fit]) -> Found:
        """Return the same with further rivals, each to those of as many suspects."""
        rivals = [list(level) for level in self.rivals]
        for f in fits:
            rivals[len(f.suspects)].append(f)
        return Found(self.levels, tuple(map(tuple, rivals)))


def objective_of(f: Fit) -> float:
    """Return what hypotheses are ordered by: misfit and prior, -2 ln."""
    return f.objective


def noise_scale(problem: Problem, best: Fit) -> float:
    """Return how many times the assumed variance a fit leaves of the whole test, at least 1."""
    misfit = evaluate(problem.entire(), best.nuisance, best.suspects).misfit
    found = len(best.suspects) + sum(len(s.theta) for s in best.suspects)
    freedom = SEARCH.per_mode * len(problem.whole.frequencies_hz) - len(best.active) - found
    return max(1.0, misfit / max(freedom, 1.0))
