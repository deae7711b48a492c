"""What was moved, and how an update went."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ....core.arrays import Floats
from ....core.results.discovery import DiscoverTables
from ....core.results.update import ChangingTables, ParameterRow, SolverRow, UpdateTables
from ....core.updating.stages import Iteration
from ..html.html_table import html_table
from ..html.markup import tag
from ..pictures import charts
from ..tables.number_formats import MISSING, few, fixed, general, hz
from ..tables.table import Cell, Column, Heading, Table, left
from .section import ReportedRun, Section

_LOOSE = 0.5
"""Standard error of a factor over the factor from which the data hardly identify it."""
_STEEP = 15.0
"""Ratio of the largest objective to the smallest from which their scale is logarithmic."""
_UNSURE = " One above half the factor: the data hardly identify the parameter."
_NOT_CLEAR = "What the test does not say is off was left as it was, unless --adopt says otherwise. "
_LEFT = "The deck was left as it was; the factors are those of the best explanation. "


def _tables(answer: ChangingTables) -> Sequence[Table]:
    note = ""
    if isinstance(answer, DiscoverTables):
        note = _NOT_CLEAR if answer.adopted else _LEFT
    tables = [parameters_table(answer.parameters, note)] if answer.parameters else []
    if isinstance(answer, UpdateTables) and answer.history:
        names = [p.name for p in answer.parameters]
        tables.append(iterations_table(answer.history, names, answer.stopped))
    if isinstance(answer, UpdateTables) and answer.solver is not None:
        tables.append(_solver(answer.solver))
    return tables


def _solver(s: SolverRow) -> Table:
    headings = [*left("command"), "runs", "s", "off before %", "off after %", "left %"]
    row = (s.command, str(s.runs), fixed(s.seconds, 0), *(fixed(v, 3) for v in _off(s)))
    note = (
        "Off: the largest difference of a pair's frequency from the embedded solver, which the "
        "update corrected for; left: by how much that still changed. The pairs are of your solver."
    )
    return Table.of("Your solver", headings, [row], note)


def _off(s: SolverRow) -> tuple[float, float, float]:
    return s.off_before, s.off_after, s.left


def parameters_table(moved: Sequence[ParameterRow], note: str = "") -> Table:
    """Return what was moved: cards, values before and after, factor, standard error, bounds."""
    rows = [_row(p) for p in moved]
    numbers = ("initial", "updated", "factor", "std. error", "95 %")
    columns = [*left("parameter", "cards"), *numbers, *left("")]
    used = [k for k in range(len(columns)) if any(r[k].text for r in rows)]
    note += "The standard error is that of the factor." + _UNSURE * any(r[5].tone for r in rows)
    cells = [[r[k] for k in used] for r in rows]
    return Table.of("Parameters", [columns[k] for k in used], cells, note)


def _row(p: ParameterRow) -> tuple[Cell, ...]:
    cards, error = few(p.cards), p.standard_error
    left_alone = "left as it was" if p.significant is not None and p.updated == p.initial else ""
    loose = error is not None and error > _LOOSE * abs(p.factor)
    return (
        Cell(p.name),
        Cell("" if cards == p.name else cards, "muted"),
        Cell(few([general(v, 6) for v in p.initial])),
        Cell(few([general(v, 6) for v in p.updated])),
        Cell(fixed(p.factor, 4)),
        Cell(MISSING if error is None else f"± {fixed(error, 4)}", "poor" if loose else ""),
        Cell("" if p.interval is None else " … ".join(map(_end, p.interval))),
        Cell("at bound", "poor") if p.at_bound else Cell(left_alone, "muted"),
    )


def _end(value: float | None) -> str:
    return "?" if value is None else fixed(value, 4)


def iterations_table(history: Sequence[Iteration], names: Sequence[str], stopped: str) -> Table:
    """Return the iterations: objective, mean and worst deviation, factors."""
    rows = []
    for h in history:
        off = np.abs(h.deviations_percent[np.isfinite(h.deviations_percent)])
        cells = [str(h.iteration), general(h.objective)]
        cells += [fixed(float(f(off)), 2) if len(off) else MISSING for f in (np.mean, np.max)]
        rows.append([*cells, *[fixed(f, 4) for f in h.factors]])
    factors = [Column(name, "factors") for name in names]
    columns: list[Heading] = ["iteration", "objective", "mean |dev.| %", "worst |dev.| %"]
    note = f"Ended: {stopped}." if stopped else ""
    return Table.of("Iterations", [*columns, *factors], rows, note)


def _render(run: ReportedRun[ChangingTables]) -> str:
    answer = run.tables
    tables = [html_table(table) for table in _tables(answer)]
    body = "".join(tables[:1])
    if isinstance(answer, UpdateTables) and answer.history:
        body += _progress(answer)
        body += tag("details", tag("summary", "Iterations as a table"), *tables[1:])
    return body


def _progress(answer: UpdateTables) -> str:
    steps = answer.history
    at, breaks = _counted_through(steps)
    factors = _series([p.name for p in answer.parameters], [h.factors for h in steps])
    known = answer.final.test_hz
    modes = [f"{k} · {hz(f)} Hz" for k, f in enumerate(known, 1)]
    deviations = [
        replace(s, brief=str(k))
        for k, s in enumerate(_series(modes, [h.deviations_percent for h in steps]), 1)
    ]
    objective = [h.objective for h in steps]
    steep = 0.0 < _STEEP * min(objective) < max(objective)
    return tag(
        "div",
        charts.lines("Factors on the deck's values", at, factors, reference=1.0, breaks=breaks),
        charts.lines(
            "Objective", at, _by_stage(objective, at, breaks), log=steep, breaks=breaks,
        ),
        charts.lines(
            "Frequency deviation of each pair", at, deviations, unit="%", reference=0.0,
            ordered=True, width=1056, height=330, breaks=breaks,
        ),
        class_="row",
    )  # fmt: skip


def _series(names: Sequence[str], steps: Sequence[Floats]) -> list[charts.Series]:
    """Return one line a name; no value where the step has none."""
    values = [[v if np.isfinite(v) else None for v in step.tolist()] for step in steps]
    return [
        charts.Series(n, tuple(v)) for n, v in zip(names, zip(*values, strict=True), strict=True)
    ]


def _by_stage(
    objective: list[float], at: list[float], breaks: list[tuple[float, str]]
) -> list[charts.Series]:
    """Cut the objective where a stage begins: each stage minimises another one."""
    starts = [at[0], *[x for x, _ in breaks], float("inf")]
    names = ["first stage" if breaks else "objective", *[name for _, name in breaks]]
    return [
        charts.Series(
            name, tuple(v if a <= x < b else None for v, x in zip(objective, at, strict=True))
        )
        for name, (a, b) in zip(names, pairwise(starts), strict=True)
    ]


def _counted_through(steps: Sequence[Iteration]) -> tuple[list[float], list[tuple[float, str]]]:
    """Return the x of each step, and where a new stage begins.

    Iterations that start again with every stage are counted through.
    """
    x = [float(h.iteration) for h in steps]
    if any(b <= a for a, b in pairwise(x)):
        x = [float(k) for k in range(len(steps))]
    breaks = [
        (x[k], f"stage {b.stage}")
        for k, (a, b) in enumerate(pairwise(steps), 1)
        if b.stage != a.stage
    ]
    return x, breaks


PARAMETERS = Section("Parameters and progress", "parameters", ChangingTables, _tables, _render)
