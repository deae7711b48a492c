"""An update by the embedded solver alone, or such that the user's own meets the test."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ...core.arrays import Floats
from ...core.correlation.comparison import Comparison, Placed, compare
from ...core.correlation.mode_pairing import Pair
from ...core.data.parameter import Parameter
from ...core.data.parametric_model import Model
from ...core.eigen.normal_modes import Eigensolution, modes_of
from ...core.errors import CheckError, InputError
from ...core.reduction.eigenpair_derivatives import sensitivities
from ...core.results.update import SolverRow
from ...core.updating import update as core
from ...core.updating.determined import put_back, update_determined
from ...core.updating.posterior import Start, from_elsewhere, profile_intervals, remarks
from ...core.updating.prior_evidence import PriorWeighed, weigh_prior
from ...core.updating.sampling import Sampled, sample_posterior
from ..analysis import Analysis, placed as place, rigid_count, target_of
from ..files.sources import Measured
from ..studies.options import Say
from ..studies.study import Study, meant
from .kept import Kept
from .outside_solver import outside_solver

if TYPE_CHECKING:
    from ...adapters.nastran.assembly.read_back import ReadBack
    from ...adapters.nastran.editing.changed_deck import ChangedDeck
    from ...adapters.nastran.fields.parameter_references import FieldRef

_MOST_RUNS = 4
"""Updates that the user's solver verifies, at most."""
_SETTLED = 0.05
"""Percent of a frequency by which the correction for the user's solver may still change."""
_AGREES = 1e-4
"""Relative difference of eigenvalues, updated model and deck read back, that is none."""


_CURVED = 10.0
"""Relative change of an eigenvalue by the square of that of a factor: a thickness bends by 3."""
_Written = tuple["ChangedDeck", list[list[float | None]]]
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
    written: _Written
    solver: SolverRow | None = None
    warnings: tuple[str, ...] = ()


def by_itself(
    analysis: Analysis, placed: Placed, _: Measured, asked: Study, progress: Say, kept: Kept
) -> Way:
    """Update, solved by the embedded solver alone."""
    progress("updating")
    one = configuration(analysis, placed, asked)
    found = moved([one], analysis.model.parameters, asked, kept)
    progress("writing the updated deck and solving it again")
    return way_of(analysis, placed, asked, found)


def way_of(analysis: Analysis, placed: Placed, asked: Study, found: Moved) -> Way:
    """Return what an update by the embedded solver did to a deck, both states compared."""

    def comparison(model: Model, solution: Eigensolution) -> Comparison:
        modes = modes_of(model, solution)
        rigid = solution.rigid_body_modes
        return compare(analysis.geometry, modes, placed, asked.criteria, rigid)

    written, again = _written(analysis, found.done)
    before = comparison(analysis.model, found.done.before.solution)
    return Way(found, before, comparison(again.model, again.solution), written)


def by_solver(
    analysis: Analysis, placed: Placed, side: Measured, asked: Study, progress: Say, kept: Kept
) -> Way:
    """Update such that the user's own solver meets the test.

    What it says of each pair's frequency over what the embedded solver says corrects the test that
    is aimed at, until both go together; its modes are those that are compared.
    """
    from ...adapters.nastran.editing.changed_deck import ChangedDeck

    assert analysis.deck is not None
    assert analysis.given is not None
    assert asked.solver is not None
    deck, began = analysis.deck, time.perf_counter()

    def judged(changed: ChangedDeck) -> Comparison:
        modes = kept.once(partial(solver.modes, changed, deck))
        progress(f"{len(modes)} modes of your solver")
        at = place(analysis.model, deck, modes, side, asked)
        return compare(analysis.geometry, modes, at, asked.criteria, rigid_count(modes))

    with outside_solver(asked.solver, asked.solver_limit) as solver:
        progress("your solver solves the deck as it came")
        before = judged(ChangedDeck.of(analysis.given.text, analysis.given.text))
        own = compare(
            analysis.geometry, analysis.modes, placed, asked.criteria, analysis.rigid_body_modes
        )
        factor = first = _correction(before, own.correlation.pairs)
        for round_ in range(1, _MOST_RUNS + 1):
            runs = round_ + 1
            progress("updating")
            test = placed.test
            aim = replace(test, frequencies_hz=test.frequencies_hz / factor)
            one = configuration(analysis, replace(placed, test=aim), asked)
            found = moved([one], analysis.model.parameters, asked, kept)
            written, _ = _written(analysis, found.done)
            progress("your solver solves the updated deck")
            after = judged(written[0])
            last, factor = factor, _correction(after, found.done.after.correlation.pairs)
            left = _percent(factor / last)
            if left < _SETTLED:
                break
    row = SolverRow(
        asked.solver,
        runs,
        time.perf_counter() - began,
        _percent(first),
        _percent(factor),
        left,
    )
    open_ = f"your solver and the embedded one still part by {left:.2g} % after {runs} runs"
    return Way(found, before, after, written, row, () if left < _SETTLED else (open_,))


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


def configuration(
    analysis: Analysis, placed: Placed, asked: Study, name: str = ""
) -> core.Configuration:
    """Return a model and its test as the core updates them."""
    target, count = target_of(analysis.model, placed, asked), len(analysis.modes)
    how = asked.criteria, asked.weights
    return core.Configuration(analysis.model, target, *how, count, name)


def moved(
    every: Sequence[core.Configuration], parameters: Sequence[Parameter], asked: Study, kept: Kept
) -> Moved:
    """Return the update and what was asked of it."""
    stages = _stages(asked, parameters)

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
    intervals = profile_intervals(every, last, best) if asked.intervals else None
    sampled = (
        sample_posterior(every, last, best, asked.samples, asked.seed, each)
        if asked.samples
        else None
    )
    evidence = weigh_prior(every, last, best) if asked.evidence else ()
    if sampled:
        best = replace(best, warnings=(*best.warnings, *sampled.doubts))
    return Moved(put_back(every, last, best), starts, intervals, sampled, evidence)


def _written(analysis: Analysis, done: core.Updated) -> tuple[_Written, ReadBack]:
    """Return the updated deck and the values of its parameters' fields; and it read back, solved.

    Raises
    ------
    CheckError
        When the deck read back does not give the frequencies of the updated model.
    """
    from ...adapters.nastran import read_value, set_values
    from ...adapters.nastran.assembly.read_back import read_back
    from ...adapters.nastran.editing.changed_deck import ChangedDeck
    from ...adapters.nastran.fields.parameter_references import moved_as_known

    assert analysis.deck is not None
    assert analysis.given is not None
    parameters = analysis.model.parameters
    wanted = moved_as_known(analysis.specs, parameters, done.factors, done.standard_error)
    text, given = set_values(analysis.deck.text, wanted), analysis.given.text
    changed = ChangedDeck.of(given, text if wanted else given)
    target, unsure = _as_written(analysis, done, wanted)
    again = read_back(changed, len(target))
    elastic = slice(again.solution.rigid_body_modes, None)
    found = again.solution.eigenvalues[elastic]
    off = np.max(np.abs(found / target[elastic] - 1.0), initial=0.0)
    if not off < _AGREES + unsure:
        raise CheckError(
            f"the updated deck, read back, gives frequencies up to {50 * off:.2g} % from the "
            "updated model's; nothing was written"
        )
    values = [[read_value(text, r) for r in s.fields] for s in analysis.specs]
    return (changed, values), again


def _as_written(
    analysis: Analysis, done: core.Updated, wanted: Mapping[FieldRef, float]
) -> tuple[Floats, float]:
    """Return the eigenvalues of the updated model at the values that are written, first order.

    Beside them a bound of what is left out, relative.
    """
    found = done.after.solution
    off = np.zeros(len(done.factors))
    for k, (spec, q) in enumerate(zip(analysis.specs, analysis.model.parameters, strict=True)):
        if spec.fields[0] in wanted:
            off[k] = wanted[spec.fields[0]] / q.deck_values[0] - done.factors[k]
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
