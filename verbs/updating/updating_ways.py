"""An update by the embedded solver alone, or such that the user's own meets the test."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ...core.arrays import Floats
from ...core.correlation.comparison import Comparison, Placed, compare
from ...core.data.parameter import Parameter
from ...core.data.parametric_model import Model
from ...core.eigen.normal_modes import Eigensolution, modes_of
from ...core.errors import CheckError, InputError
from ...core.reduction.eigenpair_derivatives import sensitivities
from ...core.results.update import SolverRow
from ...core.updating import update as core
from ...core.updating.determined import made_up, put_back, update_determined
from ...core.updating.posterior import Start, from_elsewhere, profile_intervals, remarks
from ...core.updating.prior_evidence import PriorWeighed, weigh_prior
from ...core.updating.problem import Problem
from ...core.updating.sampling import Sampled, sample_posterior
from ..analysis import Analysis, target_of
from ..files.sources import Measured
from ..studies.options import Say
from ..studies.study import Study
from ..studies.values import meant
from .kept import Kept
from .solved_decks import Solved, solved_again

if TYPE_CHECKING:
    from ...adapters.nastran import Deck
    from ...adapters.nastran.editing.changed_deck import ChangedDeck
    from ...adapters.nastran.fields.parameter_references import FieldRef

_AGREES = 1e-4
"""Relative difference of eigenvalues, updated model and deck read back, that is none."""


_CURVED = 10.0
"""Relative change of an eigenvalue by the square of that of a factor: a thickness bends by 3."""
Written = tuple["ChangedDeck", list[list[float | None]]]
"""The updated deck, and the values of its parameters' fields."""


@dataclass(frozen=True, eq=False)
class Moved:
    """An update, and what was asked of it besides."""

    done: core.Updated
    starts: tuple[Start, ...] = ()
    intervals: Floats | None = None
    sampled: Sampled | None = None
    evidence: tuple[PriorWeighed, ...] = ()


@dataclass(frozen=True, eq=False)
class Way:
    """An update, both states compared with the test, and the deck."""

    moved: Moved
    before: Comparison
    after: Comparison
    written: Written
    solver: SolverRow | None = None
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class State:
    """A configuration that was read: what of it was asked, its test, its model, the test on it.

    The name is empty where there is one.
    """

    name: str
    asked: Study
    side: Measured
    analysis: Analysis
    placed: Placed

    @property
    def named(self) -> str:
        """For what is told while it lasts."""
        return f" of {self.name}" * bool(self.name)


def by_itself(
    states: Sequence[State], asked: Study, progress: Say, kept: Kept
) -> tuple[Moved, list[Way]]:
    """Update, solved by the embedded solver alone: what came of it, and of each configuration."""
    progress("updating")
    every = [configuration(s) for s in states]
    found = moved(every, asked, kept)
    own = apart(found, every)
    progress("writing the updated deck and solving it again")
    decks = written(states, own, asked)
    return found, [_way_of(*of) for of in zip(states, own, decks, strict=True)]


def apart(found: Moved, every: Sequence[core.Configuration]) -> list[Moved]:
    """Return what came of each configuration, with its own parameters alone."""
    if len(every) == 1:
        return [found]
    problem, k = Problem.of(every), found.intervals
    return [
        Moved(found.done.of(problem, n), intervals=None if k is None else k[part.own])
        for n, part in enumerate(problem.parts)
    ]


def _way_of(state: State, found: Moved, again: tuple[Written, Solved]) -> Way:
    """Return what an update by the embedded solver did to a deck, both states compared."""
    analysis, placed, criteria = state.analysis, state.placed, state.asked.criteria

    def comparison(model: Model, solution: Eigensolution) -> Comparison:
        modes = modes_of(model, solution)
        return compare(analysis.geometry, modes, placed, criteria, solution.rigid_body_modes)

    deck, solved = again
    before = comparison(analysis.model, found.done.before.solution)
    return Way(found, before, comparison(*solved), deck)


def configuration(state: State, corrected: Floats | float = 1.0) -> core.Configuration:
    """Return a model and its test as the core updates them, its frequencies over a correction."""
    test, model = state.placed.test, state.analysis.model
    aim = replace(test, frequencies_hz=test.frequencies_hz / corrected)
    target = target_of(model, replace(state.placed, test=aim), state.asked)
    how = state.asked.criteria, state.asked.weights
    return core.Configuration(model, target, *how, len(state.analysis.modes), state.name)


def moved(every: Sequence[core.Configuration], asked: Study, kept: Kept) -> Moved:
    """Return the update and what was asked of it."""
    stages = _stages(asked, Problem.of(every).parameters)

    def update() -> core.Updated:
        if not asked.write_undetermined:
            return update_determined(every, stages, kept.steps)
        gone_on, progress = kept.steps()
        return core.update_configurations(every, stages, progress=progress, gone_on=gone_on)

    done = update()
    each = kept.each(asked.executor)
    best, starts = from_elsewhere(every, stages, done, asked.starts, asked.seed, each)
    best = replace(best, warnings=(*best.warnings, *remarks(done, best, starts)))
    last = stages[-1]
    put = put_back(every, last, best)
    final = put if put is best else made_up(every, stages, put, kept.steps)
    best = best if final is put else final
    intervals = profile_intervals(every, last, best) if asked.intervals else None
    sampled = (
        sample_posterior(every, last, best, asked.samples, asked.seed, each)
        if asked.samples
        else None
    )
    evidence = weigh_prior(every, last, best) if asked.evidence else ()
    if sampled:
        final = replace(final, warnings=(*final.warnings, *sampled.doubts))
    if intervals is not None:
        intervals[[*best.combined]] = np.nan
    told = sampled and sampled.without(best.combined)
    return Moved(final, starts, intervals, told, evidence)


def written(
    states: Sequence[State], every: Sequence[Moved], asked: Study
) -> list[tuple[Written, Solved]]:
    """Return the updated decks, the values of their parameters' fields; each read back, solved.

    Raises
    ------
    CheckError
        When a deck read back does not give the frequencies of its updated model.
    """
    from ...adapters.nastran import read_value, set_values
    from ...adapters.nastran.editing.changed_deck import ChangedDeck
    from ...adapters.nastran.fields.parameter_references import moved_as_known

    told: list[Written] = []
    due: list[tuple[Floats, float]] = []
    given: list[Deck] = []
    for analysis, done in ((s.analysis, m.done) for s, m in zip(states, every, strict=True)):
        assert analysis.deck is not None
        assert analysis.given is not None
        parameters = analysis.model.parameters
        wanted = moved_as_known(analysis.specs, parameters, done.factors, done.standard_error)
        text, before = set_values(analysis.deck.text, wanted), analysis.given.text
        values = [[read_value(text, r) for r in s.fields] for s in analysis.specs]
        told.append((ChangedDeck.of(before, text if wanted else before), values))
        due.append(_as_written(analysis, done, wanted))
        given.append(analysis.given)
    decks = [(changed, len(due[k][0])) for k, (changed, _) in enumerate(told)]
    again = list(solved_again(decks, given, asked.executor))
    for (_, solution), (target, unsure) in zip(again, due, strict=True):
        elastic = slice(solution.rigid_body_modes, None)
        off = np.abs(solution.eigenvalues[elastic] / target[elastic] - 1.0).max(initial=0.0)
        if not off < _AGREES + unsure:
            raise CheckError(
                f"the updated deck, read back, gives frequencies up to {50 * off:.2g} % from the "
                "updated model's; nothing was written"
            )
    return list(zip(told, again, strict=True))


def _as_written(
    analysis: Analysis, done: core.Updated, wanted: Mapping[FieldRef, float]
) -> tuple[Floats, float]:
    """Return the eigenvalues of the updated model at the values that are written, first order.

    Beside them a bound of what is left out, relative.
    """
    found = done.after.solution
    off = np.zeros(len(done.factors))
    for k, (spec, q) in enumerate(zip(analysis.specs, analysis.model.parameters, strict=True)):
        ref = spec.fields[0]
        kept = wanted[ref] / q.deck_values[0] if ref in wanted else 1.0
        off[k] = kept - done.factors[k]
    modes = np.arange(found.rigid_body_modes, len(found.eigenvalues))
    moved = np.flatnonzero(off)
    slopes = sensitivities(analysis.model, done.factors, found, modes, moved.tolist()).slopes
    out = np.array(found.eigenvalues)
    out[modes] += slopes @ off[moved]
    return out, _CURVED * float(np.max(np.abs(off / done.factors), initial=0.0)) ** 2


def _stages(study: Study, parameters: Sequence[Parameter]) -> tuple[core.Stage, ...]:
    """Return the stages; without ``[[stages]]`` one that moves every parameter.

    Raises
    ------
    InputError
        A stage that names a parameter the study does not define.
    """
    names = [p.name for p in parameters]
    if not study.stages:
        every = tuple(range(len(names)))
        return (core.Stage(every, study.residuals, study.max_iterations),)
    return tuple(
        core.Stage(
            tuple(_number(name, names) for name in s.parameters) or tuple(range(len(names))),
            s.residuals,
            s.max_iterations,
        )
        for s in study.stages
    )


def _number(name: str, names: Sequence[str]) -> int:
    if name in names:
        return names.index(name)
    lacks = f"a stage names the parameter '{name}', which the study does not define"
    raise InputError(lacks + meant(name, names))
