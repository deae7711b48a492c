"""The verb `discover`."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Unpack

import numpy as np
from threadpoolctl import threadpool_limits

from ..core.arrays import Bools
from ..core.correlation.comparison import Comparison, Placed, compare
from ..core.correlation.mode_errors import with_scatter
from ..core.data.parametric_model import Model
from ..core.discovery import discover as core
from ..core.discovery.effects import KINDS
from ..core.discovery.findings import Discovery
from ..core.discovery.likelihood.frf_evidence import place_responses
from ..core.discovery.reduction.discretisation_error import lowered
from ..core.discovery.reduction.elements_and_supports import Structure
from ..core.discovery.screening.completed_model import (
    SolvedModel,
    borne_out,
    upheld,
    written,
)
from ..core.discovery.screening.mode_selection import (
    matchable,
    reference_modes,
    said_of_others,
    said_of_unfounded,
    unfounded,
    vibrating,
)
from ..core.eigen.normal_modes import Eigensolution, modes_of
from ..core.errors import InputError
from ..core.localisation.error_localisation import Disagreement, disagreement
from ..core.results.correlation import compared
from ..core.results.discovery import JudgementTable, gap_table
from ..core.results.doubts import doubts
from ..core.results.evidence import damping_table, misfit_table, response_table
from ..core.results.plain import Table
from ..core.results.update import ParameterRow
from .analysis import both_given, named, placed
from .files.made_of import beside, made_of
from .files.sources import Measured, Source, geometry_of, measured, read_deck
from .runs.run import Discovered, content_of
from .studies.options import DiscoverOptions, Files, Say, said_to, study_of, unheard
from .studies.study import Study

if TYPE_CHECKING:
    from ..adapters.nastran import Deck, ParameterSpec


def discover(
    deck: Source | None = None,
    test: Source | None = None,
    *,
    study: Study | Files | None = None,
    progress: Say = unheard,
    **options: Unpack[DiscoverOptions],
) -> Discovered:
    """Find where and what the model lacks, or what is wrong in the test, and complete the deck.

    Parameters
    ----------
    deck : path or Deck
        Default: the deck of `study`.
    test : path, sequence of paths or Measurement
        Modes, responses or both; default: the test of `study`.
    study : path or Study, optional
        A study file; keyword arguments win.
    progress : callable
        Told what is done, a few words at a time.
    **options
        See `DiscoverOptions` and `CompareOptions`.

    Returns
    -------
    Discovered

    Raises
    ------
    InputError
        A file, an object or an option that is at fault: which, and what to do; no mode of the
        test is a vibration of the structure.
    CheckError
        An eigensolution does not meet its own check.
    """
    from ..adapters.nastran.assembly.wide_parameters import parameters_of
    from ..adapters.nastran.discovery.build_structure import build_structure
    from ..adapters.nastran.discovery.complete_deck import CompletedDeck, complete
    from ..adapters.nastran.discovery.doubted_parameters import doubted, settled
    from ..adapters.nastran.discovery.writers import writer_of
    from ..adapters.nastran.editing.changed_deck import ChangedDeck

    start = time.perf_counter()
    accepted = {**DiscoverOptions.__annotations__, "modes": None}
    asked = study_of("discover", study, options, accepted)
    said_to(progress)
    deck, test = both_given(deck, test, asked)
    if asked.modes is not None:
        raise InputError("modes= gives fixed modes, which no effect can change; leave it out")
    if isinstance(deck, Model):
        raise InputError("discover completes a deck, and a model has none; give the deck")
    for kind in KINDS:
        writer_of(kind)
    progress("reading and placing")
    side = measured(test, asked)
    top = side.highest(asked)
    given = read_deck(deck)
    deck, named_ones = parameters_of(given, asked.parameters)
    every = doubted(deck, named_ones)
    structure = build_structure(deck, every.specs)
    solution = reference_modes(structure.model, top, len(side.modes))
    before = _compared(deck, structure, solution, side, asked)
    elastic = vibrating(before.placed, solution, structure.model)
    part = asked.criteria.test_modes(before.test.frequencies_hz)
    moving, unused = elastic, unfounded(before, elastic & part)
    elastic = elastic & part & ~unused
    if not elastic.any():
        raise InputError("no mode that takes part is elastic; exclude fewer")
    matchable(int(elastic.sum()), solution)
    structure, known = settled(
        deck, structure, solution, before.test.frequencies_hz[elastic], every
    )
    progress("mapping where model and test disagree")
    maps = _maps(before, structure, solution)
    progress("discovering")
    request, unplaced = _request(deck, structure, known.spreads, solution, before, side, elastic)
    with threadpool_limits(1, "blas"):  # on small matrices threads but wait for each other
        found = core.discover(request, progress)
    progress("completing the deck and solving it again")

    def completed(found: Discovery) -> CompletedDeck:
        return complete(
            deck, known.specs, structure.model, found, before.placed, asked.criteria,
            len(before.analysis),
        )  # fmt: skip

    found, done = upheld(written(found, "significant"), completed)
    pairs = before.correlation, done.after.compared.correlation
    readings = len(done.after.compared.placed.observation)
    coarse = lowered(structure, solution.vectors)
    borne = borne_out(found, *pairs, coarse, int(np.count_nonzero(elastic)), readings)
    if asked.adopt != "significant" or borne.adopted != found.adopted:
        borne = written(borne, asked.adopt)
    if borne.adopted != found.adopted or borne.parameters != found.parameters:
        done = completed(borne)
    found = borne
    after = done.after.compared
    final = replace(compared(after), warnings=())
    own = SolvedModel(before, solution, structure.damping)
    return Discovered(
        **made_of(given, side),
        **beside(
            asked,
            before.placed.test_geometry.length_unit,
            before=given,
            after=done.again if done.deck.diff else None,
        ),
        deck_file=f"deck/{done.deck.name}",
        input_deck=deck.told,
        test_files=tuple(map(str, side.files)),
        verdict=found.verdict,
        findings=Table(
            replace(f, cards=tuple(own)) for f, own in zip(found.findings, done.cards, strict=True)
        ),
        alternatives=Table(found.alternatives),
        gap=gap_table(found, before, after),
        parameters=_parameters(known.specs, structure.model, found),
        would_decide=found.would_decide,
        noise_scale=found.noise_scale,
        judgement=JudgementTable.of(found),
        before=replace(compared(before), warnings=()),
        after=final,
        damping=damping_table(found, before.test.damping, elastic, own, done.after),
        frf=response_table(found.responses),
        pairs=final.pairs,
        misfit=None if maps is None else misfit_table(before, maps),
        seconds=time.perf_counter() - start,
        warnings=(
            *deck.warnings,
            *structure.model.warnings,
            *before.warnings,
            *doubts(before, None),
            *found.warnings,
            *said_of_others(np.flatnonzero(part & ~moving) + 1),
            *said_of_unfounded(before, unused),
            *unplaced,
            *done.refused,
        ),
        content=content_of(before, final, after),
        study=named(asked, deck, side, None),
        deck=done.deck if deck is given else ChangedDeck.of(given.text, done.deck.text),
    )


def _compared(
    deck: Deck, structure: Structure, solution: Eigensolution, side: Measured, asked: Study
) -> Comparison:
    """Return the deck as it is beside the test, whose scatter the user may state."""
    model = structure.model
    modes = modes_of(model, solution)
    on_model = _scattered(placed(model, deck, modes, side, asked), asked)
    geometry = geometry_of(model, deck)
    return compare(geometry, modes, on_model, asked.criteria, solution.rigid_body_modes)


def _scattered(test: Placed, asked: Study) -> Placed:
    scatter = asked.frequency_scatter, asked.shape_scatter
    if scatter == (None, None):
        return test
    count = len(test.observation), len(test.test)
    return replace(test, errors=with_scatter(test.errors, *count, *(s or 0.0 for s in scatter)))


def _maps(before: Comparison, structure: Structure, solution: Eigensolution) -> Disagreement | None:
    """Return the maps of the misfit; None where nothing pairs or the test side was turned."""
    if not before.correlation.pairs or before.correlation.criteria.rotate == "test":
        return None
    point = structure.model.deck_point
    return disagreement(before, structure.members, structure.displacement, solution.vectors, point)


def _request(
    deck: Deck,
    structure: Structure,
    spreads: tuple[float, ...],
    solution: Eigensolution,
    before: Comparison,
    side: Measured,
    elastic: Bools,
) -> tuple[core.Request, tuple[str, ...]]:
    """Return what discovery is asked, and what of the responses cannot be used."""
    from ..adapters.nastran import weight
    from ..adapters.nastran.properties.mass_unit import densest, mass_unit

    model, on_model = structure.model, before.placed
    responses, unplaced = place_responses(
        side.measurement.frfs, on_model, before.geometry, model.dofs, model.expansion
    )
    request = core.Request(
        structure,
        np.array(spreads),
        solution,
        on_model.of_modes(elastic),
        weight(deck).mass,
        mass_unit(deck, on_model.test_geometry.length_unit),
        responses=responses,
        densest=densest(deck),
        numbers=np.flatnonzero(elastic) + 1,
    )
    return request, tuple(unplaced)


def _parameters(
    specs: tuple[ParameterSpec, ...], model: Model, found: Discovery
) -> Table[ParameterRow]:
    rows = []
    for m in found.parameters:
        q = model.parameters[m.number]
        values = tuple(v * m.written for v in q.deck_values)
        told = (m.factor, m.standard_error, False, m.significant)
        rows.append(ParameterRow(specs[m.number].name, q.handle, q.deck_values, values, *told))
    return Table(rows)
