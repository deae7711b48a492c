"""The verb `correlate`."""

from __future__ import annotations

from typing import Unpack

import numpy as np

from ..core.correlation.pair_expansion import expand_pairs
from ..core.errors import InputError
from ..core.results.correlation import compared
from ..core.results.orthogonality import orthogonality_tables
from ..core.results.response_agreement import response_tables
from .analysis import both_given, correlated, named, read_analysis
from .files.made_of import beside, made_of
from .files.sources import Source, measured
from .runs.run import Correlated, content_of
from .studies.options import CorrelateOptions, Files, study_of
from .studies.study import Study


def correlate(
    deck: Source | None = None,
    test: Source | None = None,
    *,
    modes: Source | None = None,
    study: Study | Files | None = None,
    **options: Unpack[CorrelateOptions],
) -> Correlated:
    """Align a test with a model, pair their modes, rotate close modes, and tabulate.

    Parameters
    ----------
    deck : path, Deck or Model
        The analysis side; default: the deck of `study`.
    test : path, sequence of paths or Measurement
        Modes, or responses of which modes are identified; default: the test of `study`.
    modes : path or Modes, optional
        Analysis modes of the user's own Nastran run instead of the embedded solver's.
    study : path or Study, optional
        A study file; keyword arguments win.
    **options
        See `CorrelateOptions`.

    Returns
    -------
    Correlated

    Raises
    ------
    InputError
        A file, an object or an option that is at fault: which, and what to do.
    CheckError
        The eigensolution does not meet its own check.
    """
    asked = study_of("correlate", study, options, CorrelateOptions.__annotations__)
    deck, test = both_given(deck, test, asked)
    modes = asked.modes if modes is None else modes
    side = measured(test, asked)
    analysis = read_analysis(deck, asked, side.highest(asked), modes)
    if asked.reduction and modes is not None:
        raise InputError(
            "reduction= needs the modes of the deck's own matrices; leave modes= out, or reduction="
        )
    found = correlated(analysis, side, asked)
    tables, told, expanded = compared(found), None, None
    if asked.reduction:
        pairs = expand_pairs(found, analysis.model, asked.reduction, analysis.rigid_body_modes)
        told, expanded = orthogonality_tables(found, pairs), pairs.modes
    content = content_of(found, tables, expanded=expanded)
    responses = None
    if "measured" in content.frfs:
        frac = np.asarray(content.matrices["frac"])
        responses = response_tables(content.frfs["measured"], frac)
    return Correlated(
        **vars(tables),
        **made_of(analysis.deck, side, modes),
        **beside(asked, found.placed.test_geometry.length_unit, deck=analysis.deck),
        deck_file=analysis.deck.told if analysis.deck else "",
        test_files=tuple(map(str, side.files)),
        orthogonality=told,
        responses=responses,
        content=content,
        study=named(asked, analysis.deck, side, modes),
    )
