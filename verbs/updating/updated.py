"""What an update of one deck answers."""

from __future__ import annotations

from dataclasses import replace

from ...core.results.correlation import compared
from ...core.results.plain import Table
from ...core.results.update import (
    damping_rows,
    drawn,
    parameter_rows,
    posterior_table,
    sample_rows,
    start_rows,
    weights_table,
)
from ..analysis import named
from ..files.made_of import beside, made_of
from ..runs.run import Updated, content_of
from .updating_ways import State, Way


def updated(state: State, way: Way, seconds: float) -> Updated:
    """Return the result of an update that was made in some way."""
    asked, side, analysis, placed = state.asked, state.side, state.analysis, state.placed
    moved, parameters = way.moved, analysis.model.parameters
    done = moved.done
    before, after, (changed, values) = way.before, way.after, way.written
    history = Table(done.history)
    told, final = compared(before), replace(compared(after), warnings=())
    assert analysis.deck is not None
    return Updated(
        **made_of(analysis.given, side),
        **beside(
            asked,
            placed.test_geometry.length_unit,
            before=analysis.given,
            after=changed if changed.diff else None,
        ),
        deck_file=f"deck/{changed.name}",
        input_deck=analysis.deck.told,
        test_files=tuple(map(str, side.files)),
        parameters=parameter_rows(parameters, done, values, moved.intervals),
        history=history,
        before=replace(told, warnings=()),
        after=final,
        weights=weights_table(placed.errors),
        eigensolutions=done.eigensolutions,
        starts=start_rows(moved.starts),
        posterior=posterior_table(parameters, done),
        solver=way.solver,
        damping=damping_rows(done),
        samples=sample_rows(parameters, moved.sampled),
        draws=drawn(parameters, moved.sampled),
        evidence=Table(moved.evidence) if moved.evidence else None,
        stopped=done.stopped.sentence,
        seconds=seconds,
        warnings=(*analysis.warnings, *told.warnings, *done.warnings, *way.warnings),
        content=content_of(before, final, after, history),
        study=named(asked, analysis.deck, side, None),
        deck=changed,
    )
