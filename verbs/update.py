"""The verb `update`."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Unpack

import numpy as np

from ..core.arrays import Floats
from ..core.correlation.comparison import Comparison, Placed, compare
from ..core.data.parameter import Parameter
from ..core.data.parametric_model import Model
from ..core.eigen.normal_modes import Eigensolution, modes_of
from ..core.errors import CheckError, InputError
from ..core.results.correlation import compared
from ..core.results.plain import Table
from ..core.results.update import parameter_rows, posterior_table, start_rows, weights_table
from ..core.updating import update as core
from ..core.updating.determined import update_determined
from ..core.updating.posterior import Start, from_elsewhere, profile_intervals, remarks
from .analysis import Analysis, both_given, correlated, named, read_analysis, target_of
from .made_of import made_of
from .options import Files, Say, UpdateOptions, said_to, study_of, unheard
from .run import Updated, content_of
from .sources import Source, measured
from .study import Study, meant

if TYPE_CHECKING:
    from ..adapters.nastran.editing.changed_deck import ChangedDeck

_AGREES = 1e-4
"""Relative difference of eigenvalues, updated model and deck read back, that is none."""


def update(
    deck: Source | None = None,
    test: Source | None = None,
    parameters: str | Sequence[str] | None = None,
    *,
    study: Study | Files | None = None,
    progress: Say = unheard,
    **options: Unpack[UpdateOptions],
) -> Updated:
    """Move named parameters so that the analysis meets the test, by sensitivities.

    Parameters
    ----------
    deck : path or Deck
        Default: the deck of `study`.
    test : path, sequence of paths or Measurement
        Default: the test of `study`.
    parameters : str or sequence of str
        What may move, as the analyst reads the deck: ``"PBAR 11 I1"``, ``"front = PBAR 11 I1,
        PBAR 11 I2 [0.2, 5]"``. Default: those of `study`.
    study : path or Study, optional
        A study file; keyword arguments win.
    progress : callable
        Told what is done, a few words at a time.
    **options
        See `UpdateOptions` and `CompareOptions`.

    Returns
    -------
    Updated

    Raises
    ------
    InputError
        A file, an object or an option that is at fault: which, and what to do; no test mode
        pairs with the model as it is.
    CheckError
        An eigensolution does not meet its own check, or the updated deck, read back, is not the
        updated model.
    """
    start = time.perf_counter()
    accepted = {**UpdateOptions.__annotations__, "parameters": None, "modes": None}
    asked = study_of("update", study, {**options, "parameters": parameters}, accepted)
    said_to(progress)
    deck, test = both_given(deck, test, asked)
    if not asked.parameters:
        raise InputError("no parameter is named; say what may move, for example 'PBAR 11 I1'")
    if asked.modes is not None:
        raise InputError(
            "modes= gives fixed modes, which no parameter can move; leave it out to update"
        )
    if isinstance(deck, Model):
        raise InputError("update changes a deck, and a model has none; give the deck")
    progress("reading and correlating")
    side = measured(test, asked)
    analysis = read_analysis(deck, asked, side.highest(asked.frequency_tolerance))
    placed = correlated(analysis, side, asked).placed
    progress("updating")
    done, starts, intervals = _moved(analysis, placed, asked)

    def comparison(solution: Eigensolution) -> Comparison:
        modes = modes_of(analysis.model, solution)
        rigid = solution.rigid_body_modes
        return compare(analysis.geometry, modes, placed, asked.criteria, rigid)

    states = [s.solution for s in (done.before, done.after)]
    before, after = (comparison(s) for s in states if isinstance(s, Eigensolution))
    progress("writing the updated deck and solving it again")
    changed, values = _written(analysis, done)
    history = Table(done.history)
    told, final = compared(before), replace(compared(after), warnings=())
    assert analysis.deck is not None
    return Updated(
        **made_of(analysis.given, side),
        deck_file=f"deck/{changed.name}",
        input_deck=analysis.deck.told,
        test_files=tuple(map(str, side.files)),
        parameters=parameter_rows(analysis.model.parameters, done, values, intervals),
        history=history,
        before=replace(told, warnings=()),
        after=final,
        weights=weights_table(placed.errors),
        eigensolutions=done.eigensolutions,
        starts=start_rows(starts),
        posterior=posterior_table(analysis.model.parameters, done),
        stopped=done.stopped.sentence,
        seconds=time.perf_counter() - start,
        warnings=(*analysis.warnings, *told.warnings, *done.warnings),
        content=content_of(before, final, after, history),
        study=named(asked, analysis.deck, side, None),
        deck=changed,
    )


def _moved(
    analysis: Analysis, placed: Placed, asked: Study
) -> tuple[core.Updated, tuple[Start, ...], Floats | None]:
    """Return the update, those from other starts, and intervals where they are asked for."""
    model, target = analysis.model, target_of(analysis.model, placed, asked)
    stages, update = _stages(asked, model.parameters), update_determined
    if asked.write_undetermined:
        update = core.update
    how, count = (asked.criteria, asked.weights), len(analysis.modes)
    done = update(model, target, stages, *how, n_modes=count)
    best, starts = from_elsewhere(
        model, target, stages, done, asked.starts, *how, n_modes=count, seed=asked.seed
    )
    best = replace(best, warnings=(*best.warnings, *remarks(done, best, starts)))
    if not asked.intervals:
        return best, starts, None
    return best, starts, profile_intervals(model, target, stages[-1], best, *how, n_modes=count)


def _written(
    analysis: Analysis, done: core.Updated
) -> tuple[ChangedDeck, list[list[float | None]]]:
    """Return the updated deck and the values of its parameters' fields, read back and solved.

    Raises
    ------
    CheckError
        When the deck read back does not give the frequencies of the updated model.
    """
    from ..adapters.nastran import read_value, set_values
    from ..adapters.nastran.assembly.read_back import read_back
    from ..adapters.nastran.editing.changed_deck import ChangedDeck
    from ..adapters.nastran.fields.parameter_references import moved

    assert analysis.deck is not None
    assert analysis.given is not None
    wanted = moved(analysis.specs, analysis.model.parameters, done.factors)
    text, given = set_values(analysis.deck.text, wanted), analysis.given.text
    changed = ChangedDeck.of(given, text if wanted else given)
    target = done.after.solution.eigenvalues
    again = read_back(changed, len(target)).solution
    elastic = slice(again.rigid_body_modes, None)
    off = np.max(np.abs(again.eigenvalues[elastic] / target[elastic] - 1.0), initial=0.0)
    if not off < _AGREES:
        raise CheckError(
            f"the updated deck, read back, gives frequencies up to {50 * off:.2g} % from the "
            "updated model's; nothing was written"
        )
    return changed, [[read_value(text, r) for r in s.fields] for s in analysis.specs]


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
