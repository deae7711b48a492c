"""An update such that the user's own solver meets the test."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...core.arrays import Floats
from ...core.correlation.comparison import Comparison, compare
from ...core.correlation.mode_pairing import Pair
from ...core.results.update import SolverRow
from ..analysis import placed as place, rigid_count
from ..studies.options import Say
from ..studies.study import Study
from .kept import Kept
from .outside_solver import outside_solver
from .updating_ways import Moved, State, Way, apart, configuration, moved, written

if TYPE_CHECKING:
    from ...adapters.nastran.editing.changed_deck import ChangedDeck

_MOST_RUNS = 4
"""Updates that the user's solver verifies, at most."""
_SETTLED = 0.05
"""Percent of a frequency by which the correction for the user's solver may still change."""


def by_solver(
    states: Sequence[State], asked: Study, progress: Say, kept: Kept
) -> tuple[Moved, list[Way]]:
    """Update such that the user's own solver meets the test of every configuration.

    What it says of each pair's frequency over what the embedded solver says corrects the test that
    is aimed at, until both go together; its modes are those that are compared. Decks of several
    configurations are solved by the executor.
    """
    from ...adapters.nastran.editing.changed_deck import ChangedDeck

    assert asked.solver is not None
    began = time.perf_counter()

    def judged(decks: Sequence[ChangedDeck]) -> list[Comparison]:
        found = []
        for s, modes in zip(states, kept.each(asked.executor)(solver.modes, decks), strict=True):
            progress(f"{len(modes)} modes of your solver{s.named}")
            at = place(s.analysis.model, s.analysis.deck, modes, s.side, s.asked)
            count = rigid_count(modes)
            found.append(compare(s.analysis.geometry, modes, at, s.asked.criteria, count))
        return found

    with outside_solver(asked.solver, asked.solver_limit) as solver:
        progress("your solver solves the deck as it came")
        given = [s.analysis.given.text for s in states if s.analysis.given]
        before = judged([ChangedDeck.of(text, text) for text in given])
        factors = first = [
            _correction(b, _own(s).correlation.pairs) for s, b in zip(states, before, strict=True)
        ]
        for round_ in range(_MOST_RUNS):
            progress("updating" if not round_ else "updating again")
            every = [configuration(s, f) for s, f in zip(states, factors, strict=True)]
            found = moved(every, asked, kept)
            own = apart(found, every)
            decks = [deck for deck, _ in written(states, own, asked)]
            progress("your solver solves the updated deck")
            after = judged([changed for changed, _ in decks])
            last = factors
            factors = [
                _correction(a, m.done.after.correlation.pairs)
                for a, m in zip(after, own, strict=True)
            ]
            left = [_percent(f / old) for f, old in zip(factors, last, strict=True)]
            if max(left) < _SETTLED:
                break
    seconds, runs = time.perf_counter() - began, round_ + 2
    ways = []
    for k, alone in enumerate(own):
        off = _percent(first[k]), _percent(factors[k])
        row = SolverRow(asked.solver, runs, seconds, *off, left[k])
        open_ = f"your solver and the embedded one still part by {left[k]:.2g} % after {runs} runs"
        said = (open_,) * (left[k] >= _SETTLED)
        ways.append(Way(alone, before[k], after[k], decks[k], row, said))
    return found, ways


def _own(state: State) -> Comparison:
    a = state.analysis
    return compare(a.geometry, a.modes, state.placed, state.asked.criteria, a.rigid_body_modes)


def _correction(by_solver: Comparison, own: Sequence[Pair]) -> Floats:
    """Frequency by the user's solver over that by the embedded one, by test mode, (n_test,)."""
    factor = np.full(len(by_solver.test), np.nan)
    ours = {p.test: p.analysis_hz for p in own}
    for p in by_solver.correlation.pairs:
        if p.test in ours:
            factor[p.test] = p.analysis_hz / ours[p.test]
    known = np.isfinite(factor)
    factor[~known] = np.median(factor[known]) if known.any() else 1.0
    return factor


def _percent(factor: Floats) -> float:
    return float(100.0 * np.abs(factor - 1.0).max(initial=0.0))
