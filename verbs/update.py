"""The verb `update`."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Unpack, overload

from ..core.data.parametric_model import Model
from ..core.errors import InputError
from .analysis import both_given, correlated, read_analysis
from .files.made_of import made_of
from .files.sources import Source, measured, read_deck
from .runs.run import Updated
from .runs.together import UpdatedTogether
from .studies.design_variables import NOT_NAMED, with_design_variables
from .studies.heard import require_heard
from .studies.options import Files, Say, UpdateOptions, said_to, study_of, unheard
from .studies.study import Study
from .updating.kept import kept_in
from .updating.solver_in_the_loop import by_solver
from .updating.update_together import update_together
from .updating.updated import updated
from .updating.updating_ways import State, by_itself


@overload
def update(
    deck: Source,
    test: Source,
    parameters: str | Sequence[str] | None = None,
    *,
    study: Study | Files | None = None,
    keep: Files | None = None,
    progress: Say = unheard,
    **options: Unpack[UpdateOptions],
) -> Updated: ...
@overload
def update(
    deck: None = None,
    test: None = None,
    parameters: str | Sequence[str] | None = None,
    *,
    study: Study | Files | None = None,
    keep: Files | None = None,
    progress: Say = unheard,
    **options: Unpack[UpdateOptions],
) -> Updated | UpdatedTogether: ...
def update(
    deck: Source | None = None,
    test: Source | None = None,
    parameters: str | Sequence[str] | None = None,
    *,
    study: Study | Files | None = None,
    keep: Files | None = None,
    progress: Say = unheard,
    **options: Unpack[UpdateOptions],
) -> Updated | UpdatedTogether:
    """Move named parameters so that the analysis meets the test, by sensitivities.

    Parameters
    ----------
    deck : path or Deck
        Default: the deck of `study`.
    test : path, sequence of paths or Measurement
        Default: the test of `study`.
    parameters : str or sequence of str
        What may move, as the analyst reads the deck: ``"PBAR 11 I1"``, ``"front = PBAR 11 I1,
        PBAR 11 I2 [0.2, 5]"``. Default: those of `study`, or the design variables of the deck.
    study : path or Study, optional
        A study file; keyword arguments win.
    keep : path, optional
        A folder that what is done is kept in, piece by piece: the steps, what comes of each other
        start, each run of the user's solver. An update that is given such a folder of the same
        study, deck, test and version goes on where that ended. What is in it is run as code when it
        is read: give only what you made yourself.
    progress : callable
        Told what is done, a few words at a time.
    **options
        See `UpdateOptions` and `CompareOptions`.

    Returns
    -------
    Updated
        Of several `configurations` of the structure, with a deck and a test each,
        `UpdatedTogether`.

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
    require_heard(asked)
    said_to(progress)
    if asked.configurations:
        if deck is not None or test is not None:
            raise InputError("each of the configurations has its deck and test; give none beside")
        return update_together(asked, progress, keep)
    deck, test = both_given(deck, test, asked)
    if isinstance(deck, Model):
        raise InputError("update changes a deck, and a model has none; give the deck")
    remarks: tuple[str, ...] = ()
    if not asked.parameters:
        asked, remarks = with_design_variables(asked, read_deck(deck))
    if not asked.parameters:
        raise InputError("; ".join((NOT_NAMED, *remarks)))
    if asked.modes is not None:
        raise InputError(
            "modes= gives fixed modes, which no parameter can move; leave it out to update"
        )
    progress("reading and correlating")
    side = measured(test, asked)
    analysis = read_analysis(deck, asked, side.highest(asked))
    placed = correlated(analysis, side, asked).placed
    kept = kept_in(keep, asked, [made_of(analysis.given, side)])
    state = State("", asked, side, analysis, placed)
    _, (way,) = (by_solver if asked.solver else by_itself)([state], asked, progress, kept)
    return updated(state, way, time.perf_counter() - start)
