"""``trueup discover DECK TEST``."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ...core.errors import InputError
from ..completing import borne_out, completed, written
from ..console import stderr, working
from ..options import Output
from ..study import Study


def discover(study: Study, output: Output) -> None:
    """Find where and what the model lacks, or what is wrong in the test."""
    from ..writing import answer

    result, run = run_discover(study, output)
    answer(result, output, run)


def run_discover(study: Study, output: Output) -> tuple[dict[str, Any], Path]:
    """Write the run folder of a discovery; return its result and where it is."""
    from ...adapters.nastran import read_deck, weight
    from ...adapters.nastran.mass_unit import mass_unit
    from ...adapters.nastran.structure import build_structure
    from ...core import eigen
    from ...core.comparison import compare, place_test
    from ...core.disagreement import agrees
    from ...core.discovery.discover import Request
    from ...core.discovery.discover import discover as find
    from ...core.discovery.hearing import place_responses
    from ...core.results import correlate_tables, disagreement_tables
    from ...core.weighting import with_scatter
    from ..doubting import doubted, settled
    from ..further_evidence import damping_tables, response_tables
    from ..inplace import put_in_place
    from ..pipeline import criteria_of, highest_frequency, naming, read_measurement
    from ..runfolder import refuse_existing, run_folder
    from ..writing import default_folder, fill_run_folder

    if study.modes is not None:
        raise InputError("--modes gives fixed modes, which no effect can change; leave it out")
    assert study.deck is not None
    run = default_folder(study, "discover")
    refuse_existing(run, output.force)
    start = time.perf_counter()
    measurement = read_measurement(study)
    top = highest_frequency(measurement, study)
    with working("reading and placing", output):
        deck = read_deck(study.deck)
        every = doubted(study, deck)
        structure = build_structure(deck, every.specs)
        model = structure.model
        solution = eigen.solve(model, fmax=max(1.6 * top / 1.3, top), keep_factor=True)
        if len(solution.eigenvalues) < 60 < model.n_free // 4:
            solution = eigen.solve(model, n_modes=60, keep_factor=True)
        modes = eigen.modes_of(model, solution)
        geometry = model.geometry
        if geometry.length_unit is None and deck.length_unit:
            geometry = replace(geometry, length_unit=deck.length_unit)
        with naming(study.test[0]):
            placed = place_test(
                geometry,
                modes,
                measurement,
                study.deck_length_unit,
                motion=model.expansion,
                seed=study.seed,
            )
        if study.frequency_scatter is not None or study.shape_scatter is not None:
            errors = with_scatter(
                placed.errors,
                len(placed.observation),
                len(placed.test),
                study.frequency_scatter or 0.0,
                study.shape_scatter or 0.0,
            )
            placed = replace(placed, errors=errors)
    before = compare(geometry, modes, placed, criteria_of(study), solution.rigid_body_modes)
    resting = _resting(placed, solution, model)
    vibrating = placed.test.frequencies_hz[~resting]
    structure, known = settled(deck, structure, solution, vibrating, every)
    model, specs = structure.model, list(known.specs)
    responses, unheard = place_responses(
        measurement.frfs, placed, geometry, model.dofs, model.expansion
    )

    with working("mapping where model and test disagree", output):
        maps = disagreement_maps(before, structure, solution.vectors)

    def told(what: str) -> None:
        if output.verbose:
            stderr().print(what, markup=False)

    with working("discovering", output):
        found = find(
            Request(
                structure,
                np.array(known.spreads),
                solution,
                placed.of_modes(~resting),
                weight(deck).mass,
                mass_unit(deck, placed.test_geometry.length_unit),
                responses=responses,
                modes=np.flatnonzero(~resting) + 1,
            ),
            told,
        )
    found = borne_out(found, maps is not None and agrees(before, maps))
    with run_folder(run, output.force) as work:
        with working("completing the deck and solving it again", output):
            found, done = completed(study, deck, specs, model, found, before, work, len(modes))
        after = done["after"]
        result = discover_tables(study, found, specs, model, before, after, done)
        result["seconds"] = time.perf_counter() - start
        damped = damping_tables(
            found,
            placed.test.damping,
            ~resting,
            (before, solution, structure.damping),
            done["damped"],
        )
        result |= {} if damped is None else {"damping": damped}
        result |= {} if found.responses is None else {"frf": response_tables(found.responses)}
        result["warnings"] = [
            *deck.warnings,
            *model.warnings,
            *before.warnings,
            *found.warnings,
            *_said_resting(np.flatnonzero(resting) + 1),
            *unheard,
            *done["refused"],
        ]
        result["before"]["warnings"] = result["after"]["warnings"] = []
        result["pairs"] = correlate_tables(after)["pairs"]
        if maps is not None:
            result["misfit"] = disagreement_tables(before, maps)
        fill_run_folder(work, study, result, before, after)
        if output.in_place:
            put_in_place(done["text"], work, result)
    return result, run


def _resting(placed: Any, solution: Any, model: Any) -> Any:
    """Return which test modes are no vibration of the structure, (n_test,)."""
    from ...core.discovery.resting import elastic

    resting = ~elastic(placed, solution, model.expansion @ solution.vectors)
    if resting.all():
        raise InputError(
            "no mode of the test is elastic: all are at 0 Hz or motions of the structure as a whole"
        )
    return resting


def _said_resting(modes: Any) -> list[str]:
    if not len(modes):
        return []
    which = ", ".join(str(m) for m in modes)
    subject = (
        f"test mode {which} is a motion" if len(modes) == 1 else f"test modes {which} are motions"
    )
    return [
        f"{subject} of the structure as a whole (at 0 Hz, or on its suspension), and no evidence "
        "of what the model lacks"
    ]


def disagreement_maps(before: Any, structure: Any, free_shapes: Any) -> Any:
    """Return the maps of the misfit, or None where nothing pairs or the test side was turned."""
    from ...core.disagreement import disagreement

    if not before.correlation.pairs or before.correlation.criteria.rotate == "test":
        return None
    deck = structure.model.deck_point
    return disagreement(before, structure.members, structure.displacement, free_shapes, deck)


def discover_tables(
    study: Study,
    found: Any,
    specs: list[Any],
    model: Any,
    before: Any,
    after: Any,
    done: dict[str, Any],
) -> dict[str, Any]:
    """Return result.json of a discovery."""
    from ...core.results import correlate_tables, gap

    out = set(found.held_out_modes)

    def gaps(c: Any) -> dict[str, Any]:
        return gap(
            replace(
                c.correlation, pairs=tuple(p for p in c.correlation.pairs if p.test + 1 not in out)
            )
        )

    def held(c: Any) -> dict[str, Any] | None:
        if not out:
            return None
        return gap(
            replace(c.correlation, pairs=tuple(p for p in c.correlation.pairs if p.test + 1 in out))
        )

    return {
        "schema": "trueup/discover/1",
        "input_deck": str(study.deck),
        "deck": done["deck"],
        "test": [str(p) for p in study.test],
        "verdict": found.verdict,
        "findings": [
            {
                "side": f.side,
                "kind": f.kind,
                "where": f.where,
                "magnitude": f.magnitude,
                "interval": f.interval,
                "credible_set": list(f.credible_set),
                "confidence": f.confidence,
                "cards": cards,
                "sentence": f.sentence,
            }
            for f, cards in zip(found.findings, done["cards"], strict=True)
        ],
        "alternatives": [
            {
                "kinds": list(a.kinds),
                "xyz": [list(p) for p in a.places],
                "times_less_likely": a.times_less_likely,
                "sentence": a.sentence,
            }
            for a in found.alternatives
        ],
        "gap": {
            "before": gaps(before),
            "after": gaps(after),
            "held_out": {
                "test_modes": list(found.held_out_modes),
                "sensors": list(found.held_out_sensors),
                "before": held(before),
                "after": held(after),
            },
        },
        "parameters": [
            {
                "name": specs[m.number].name,
                "cards": list(model.parameters[m.number].handle),
                "initial": list(model.parameters[m.number].deck_values),
                "updated": [
                    v * written(found.verdict, m.factor)
                    for v in model.parameters[m.number].deck_values
                ],
                "factor": m.factor,
                "standard_error": m.standard_error,
                "at_bound": False,
                "significant": m.significant,
            }
            for m in found.parameters
        ],
        "would_decide": list(found.would_decide),
        "noise_scale": found.noise_scale,
        "judgement": {
            "evidence": found.evidence_for,
            "posterior": found.posterior,
            "foretold": found.foretold,
        },
        "before": correlate_tables(before),
        "after": correlate_tables(after),
    }
