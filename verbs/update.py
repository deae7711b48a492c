"""The verb `update`."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Unpack

from ..core.data.parametric_model import Model
from ..core.errors import InputError
from ..core.results.correlation import compared
from ..core.results.plain import Table
from ..core.results.update import (
    damping_rows,
    parameter_rows,
    posterior_table,
    start_rows,
    weights_table,
)
from .analysis import both_given, correlated, named, read_analysis
from .made_of import made_of
from .options import Files, Say, UpdateOptions, said_to, study_of, unheard
from .run import Updated, content_of
from .sources import Source, measured
from .study import Study
from .updating_ways import by_itself, by_solver


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
    found = by_solver if asked.solver else by_itself
    way = found(analysis, placed, side, asked, progress)
    done, starts, intervals = way.moved
    before, after, (changed, values) = way.before, way.after, way.written
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
        solver=way.solver,
        damping=damping_rows(done),
        stopped=done.stopped.sentence,
        seconds=time.perf_counter() - start,
        warnings=(*analysis.warnings, *told.warnings, *done.warnings, *way.warnings),
        content=content_of(before, final, after, history),
        study=named(asked, analysis.deck, side, None),
        deck=changed,
    )
