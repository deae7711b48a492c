"""Several configurations of one structure, updated with one set of parameters."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from ...core.errors import InputError
from ...core.results.plain import Table
from ...core.results.together import configuration_rows, pair_rows, shared_rows
from ...core.results.update import drawn, posterior_table, sample_rows, start_rows
from ...core.updating.problem import Problem
from ...core.version import VERSION
from ..analysis import correlated
from ..files.made_of import made_of
from ..files.sources import measured, read_deck
from ..runs.run import Updated
from ..runs.together import UpdatedTogether
from ..studies.options import Files, Say
from ..studies.relations import names_in, read_relation
from ..studies.study import Study
from ..studies.study_tables import ConfigurationRequest
from .kept import kept_in
from .solved_decks import analyses
from .solver_in_the_loop import by_solver
from .updated import updated
from .updating_ways import State, by_itself, configuration

if TYPE_CHECKING:
    from ...adapters.nastran import Deck


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
    _require_one_meaning(asked)
    progress(f"reading and correlating {', '.join(c.name for c in asked.configurations)}")
    requests, relations = [], asked.relations
    for one in asked.configurations:
        requests.append(_read(replace(asked, relations=relations), one))
        here = requests[-1][1].relations
        relations = tuple(text for text in relations if text not in here)
    sides = [measured(own.test, own) for _, own in requests]
    decks = [(d, own, s.highest(own)) for (d, own), s in zip(requests, sides, strict=True)]
    every = zip(asked.configurations, sides, analyses(decks, asked.executor), requests, strict=True)
    states = [
        State(one.name, own, side, a, correlated(a, side, own).placed)
        for one, side, a, (_, own) in every
    ]
    problem = Problem.of([configuration(s) for s in states])
    _require_all_used(asked, problem)
    _require_all_told(relations, problem)
    kept = kept_in(keep, asked, [made_of(s.analysis.given, s.side) for s in states])
    way, ways = (by_solver if asked.solver else by_itself)(states, asked, progress, kept)
    found, results = way.done, dict[str, Updated]()
    for state, own in zip(states, ways, strict=True):
        results[state.name] = updated(state, own, time.perf_counter() - start)
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


def _read(asked: Study, one: ConfigurationRequest) -> tuple[Deck, Study]:
    """Read the deck of a configuration; ask of it what it has of the parameters and relations."""
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
    return deck, replace(own, parameters=there, relations=known)


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
