"""``trueup update DECK TEST``."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import typer

from ...core.errors import CheckError, InputError
from ..console import working
from ..options import Output
from ..study import Study

_AGREES = 1e-4


def update(study: Study, output: Output) -> None:
    """Move the named parameters to the test, by sensitivities."""
    from ..writing import answer

    result, run = run_update(study, output)
    answer(result, output, run)


def run_update(study: Study, output: Output) -> tuple[dict[str, Any], Path]:
    """Write the run folder of an update; return its result and where it is."""
    from ...core import eigen
    from ...core.comparison import compare
    from ...core.residuals import Weights
    from ...core.results import correlate_tables, history_tables, parameter_tables
    from ...core.updating import Target
    from ...core.updating import update as move
    from ...core.weighting import weight_tables
    from ..inplace import put_in_place
    from ..pipeline import correlated, criteria_of
    from ..runfolder import refuse_existing, run_folder
    from ..stages import stages_of
    from ..writing import default_folder, fill_run_folder

    if not study.parameters:
        raise typer.BadParameter(
            "no parameter is named; say what may move, for example -p 'PBAR 11 I1' (repeatable)"
        )
    if study.modes is not None:
        raise InputError(
            "--modes gives fixed modes, which no parameter can move; leave it out to update"
        )
    run = default_folder(study, "update")
    refuse_existing(run, output.force)
    start = time.perf_counter()
    with working("reading and correlating", output):
        analysis, placed, _ = correlated(study)
    model, before_modes = analysis.model, analysis.modes
    stages = stages_of(study, model.parameters)
    chosen = tuple(m - 1 for m in study.test_modes) or None
    if chosen and max(chosen) >= len(placed.test):
        raise InputError(
            f"test_modes names mode {max(chosen) + 1}; the test has {len(placed.test)} modes"
        )
    with working("updating", output):
        done = move(
            model,
            Target(
                placed.test.frequencies_hz,
                placed.weighted(placed.test.shapes),
                placed.weighted(placed.observation.matrix @ model.expansion),
                chosen,
                None if placed.errors is None else placed.errors.frequency,
                None if placed.errors is None else placed.errors.length,
            ),
            stages,
            criteria_of(study),
            Weights(study.frequency_sigma, study.shape_sigma, study.regularisation),
            n_modes=len(before_modes),
        )
    geometry = analysis.model.geometry

    def comparison(solution: Any) -> Any:
        modes = eigen.modes_of(model, solution)
        return compare(geometry, modes, placed, criteria_of(study), solution.rigid_body_modes)

    before, after = comparison(done.before.solution), comparison(done.after.solution)
    with run_folder(run, output.force) as work:
        with working("writing the updated deck and solving it again", output):
            written = write_updated(study, model, done, work)
        result: dict[str, Any] = {
            "schema": "trueup/update/1",
            "deck": str(Path("deck") / written["top"]),
            "input_deck": str(study.deck),
            "test": [str(p) for p in study.test],
            "parameters": parameter_tables(model.parameters, done, written["values"]),
            "history": history_tables(done.history),
            "before": correlate_tables(before),
            "after": correlate_tables(after),
            "weights": weight_tables(placed.errors),
            "eigensolutions": done.eigensolutions,
            "stopped": done.stopped,
            "seconds": time.perf_counter() - start,
            "warnings": [*analysis.warnings, *placed.warnings, *done.warnings],
        }
        result["before"]["warnings"] = result["after"]["warnings"] = []
        fill_run_folder(work, replace(study, out=None), result, before, after)
        if output.in_place:
            put_in_place(written["text"], work, result)
    return result, run


def write_updated(study: Study, model: Any, done: Any, work: Path) -> dict[str, Any]:
    """Write ``deck/`` and ``changes.diff``, read the deck back and check that it solves alike.

    Raises
    ------
    CheckError
        When the deck read back does not give the frequencies of the updated model.
    """
    import numpy as np

    from ...adapters.nastran import (
        build_model,
        parse_parameter,
        read_deck,
        read_deck_text,
        read_value,
        set_values,
        unified_diff,
        write_deck,
    )
    from ...core import eigen

    assert study.deck is not None
    original = read_deck_text(study.deck)
    specs = [parse_parameter(p) for p in study.parameters]
    wanted = {
        ref: value * float(factor)
        for spec, parameter, factor in zip(specs, model.parameters, done.factors, strict=True)
        for ref, value in zip(spec.fields, parameter.deck_values, strict=True)
        if abs(factor - 1.0) > 1e-12
    }
    changed = set_values(original, wanted)
    top = write_deck(changed, work / "deck")
    (work / "changes.diff").write_text(
        unified_diff(original, changed), encoding="utf-8", newline=""
    )
    again = eigen.solve(build_model(read_deck(top)), n_modes=len(done.after.solution.eigenvalues))
    target, got = done.after.solution.eigenvalues, again.eigenvalues
    elastic = slice(again.rigid_body_modes, None)
    off = np.max(np.abs(got[elastic] / target[elastic] - 1.0), initial=0.0)
    if not off < _AGREES:
        raise CheckError(
            f"the updated deck, read back, gives frequencies up to {50 * off:.2g} % from the "
            "updated model's; nothing was written"
        )
    values = [[read_value(changed, ref) for ref in spec.fields] for spec in specs]
    place = top.relative_to((work / "deck").absolute())
    return {"top": place, "values": values, "text": changed}
