"""Several configurations of one structure, updated with one set of parameters."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

from ...core.correlation.comparison import Placed
from ...core.errors import InputError
from ...core.results.plain import Table
from ...core.results.together import configuration_rows, pair_rows, shared_rows
from ...core.results.update import drawn, posterior_table, sample_rows, start_rows
from ...core.updating.problem import Problem
from ...core.version import VERSION
from ..analysis import Analysis, correlated, read_analysis
from ..files.made_of import made_of
from ..files.sources import Measured, measured, read_deck
from ..runs.run import Updated
from ..runs.together import UpdatedTogether
from ..studies.options import Files, Say
from ..studies.relations import names_in, read_relation
from ..studies.study import Study
from ..studies.study_tables import ConfigurationRequest
from .kept import kept_in
from .updated import updated
from .updating_ways import Moved, configuration, moved, way_of


@dataclass(frozen=True, eq=False)
class _State:
    """A configuration that was read: what of it was asked, its test, its model, the test on it."""

    name: str
    asked: Study
    side: Measured
    analysis: Analysis
    placed: Placed


def update_together(asked: Study, progress: Say, keep: Files | None = None) -> UpdatedTogether:
    """Move one set of parameters so that every configuration of a study meets its test.

    Each deck is read for itself; a parameter moves the cards it names in every deck that has them.
    Residuals of all are stacked, and each updated deck is read back and solved.

    Raises
    ------
    InputError
        As `update`, of any configuration; a parameter whose cards no deck has, or that differ; a
        configuration without any.
    CheckError
        As `update`.
    """
    start = time.perf_counter()
    if not any((asked.parameters, *(c.parameters for c in asked.configurations))):
        raise InputError("no parameter is named; say what may move, for example 'PBAR 11 I1'")
    if asked.solver is not None:
        raise InputError("a solver of your own verifies one configuration; leave it out of several")
    _require_one_meaning(asked)
    states: list[_State] = []
    relations = asked.relations
    for one in asked.configurations:
        progress(f"reading and correlating {one.name}")
        states.append(_read(replace(asked, relations=relations), one))
        here = states[-1].asked.relations
        relations = tuple(text for text in relations if text not in here)
    every = [configuration(s.analysis, s.placed, s.asked, s.name) for s in states]
    problem = Problem.of(every)
    _require_all_used(asked, problem)
    _require_all_told(relations, problem)
    kept = kept_in(keep, asked, [made_of(s.analysis.given, s.side) for s in states])
    progress("updating")
    way = moved(every, problem.parameters, asked, kept)
    found, intervals = way.done, way.intervals
    results: dict[str, Updated] = {}
    for k, s in enumerate(states):
        progress(f"writing the updated deck of {s.name} and solving it again")
        own = intervals if intervals is None else intervals[problem.parts[k].own]
        alone = Moved(found.of(problem, k), intervals=own)
        seconds = time.perf_counter() - start
        changed = way_of(s.analysis, s.placed, s.asked, alone)
        results[s.name] = updated(s.analysis, s.side, s.placed, s.asked, changed, seconds)
    told = [f"{name}: {w}" for name, r in results.items() for w in r.warnings]
    of_all = [w for w in told if w.partition(": ")[2] not in found.warnings]
    inputs = dict.fromkeys(row for r in results.values() for row in r.inputs)
    return UpdatedTogether(
        version=VERSION,
        inputs=Table(inputs),
        configurations=configuration_rows(results),
        parameters=shared_rows([q.name for q in problem.parameters], results),
        pairs=pair_rows(results),
        history=Table(found.history),
        eigensolutions=found.eigensolutions,
        stopped=found.stopped.sentence,
        seconds=time.perf_counter() - start,
        warnings=(*found.warnings, *of_all),
        starts=start_rows(way.starts),
        posterior=posterior_table(problem.parameters, found),
        samples=sample_rows(problem.parameters, way.sampled),
        draws=drawn(problem.parameters, way.sampled),
        evidence=Table(way.evidence) if way.evidence else None,
        results=results,
        study=asked,
    )


def _read(asked: Study, one: ConfigurationRequest) -> _State:
    """Read a configuration with those of the parameters that its deck has, and their relations."""
    from ...adapters.nastran.assembly.wide_parameters import stands_in
    from ...adapters.nastran.fields.parameter_references import parse_request

    own = asked.of(one)
    assert own.deck is not None
    deck = read_deck(own.deck)
    there = tuple(text for text in own.parameters if stands_in(deck, text))
    if not there:
        raise InputError(
            f"configuration '{one.name}': {own.deck} has none of the cards that the parameters name"
        )
    names = {parse_request(text).name for text in there}
    known = tuple(text for text in own.relations if names_in(text) <= names)
    own = replace(own, parameters=there, relations=known)
    side = measured(own.test, own)
    analysis = read_analysis(deck, own, side.highest(own))
    return _State(one.name, own, side, analysis, correlated(analysis, side, own).placed)


def _require_one_meaning(asked: Study) -> None:
    """Refuse a name that stands for other cards in another configuration."""
    from ...adapters.nastran.fields.parameter_references import parse_request

    known: dict[str, str] = {}
    for one in asked.configurations:
        for text in asked.of(one).parameters:
            request = parse_request(text)
            meant = ", ".join(v.text for v in request.values)
            before = known.setdefault(request.name, meant)
            if before != meant:
                raise InputError(
                    f"parameter '{request.name}' is {before} in one configuration and {meant} in "
                    f"'{one.name}'; one parameter moves one property: give each its own name"
                )


def _require_all_told(left: Sequence[str], problem: Problem) -> None:
    """Refuse a relation that no configuration has all parameters of."""
    for text in left:
        read_relation(text, problem.parameters)
        raise InputError(f"relation '{text}': no configuration has all parameters that it names")


def _require_all_used(asked: Study, problem: Problem) -> None:
    """Refuse a parameter of which no deck has a card."""
    from ...adapters.nastran.fields.parameter_references import parse_request

    known = {q.name for q in problem.parameters}
    texts: Sequence[str] = [t for c in asked.configurations for t in asked.of(c).parameters]
    for text in texts:
        if parse_request(text).name not in known:
            raise InputError(f"parameter '{text}': none of the decks has a card that it names")
