"""Orthogonality of test and analysis by the mass of the model, beside what contracts ask."""

from collections.abc import Sequence

from ....core.results.correlation import CorrelateTables, MacTable
from ..html.html_table import html_table
from ..pictures import heatmap
from ..tables.number_formats import fixed, percent
from ..tables.table import Cell, Table, left
from .section import ReportedRun, Section

_METHODS = {"serep": "SEREP", "guyan": "Guyan", "irs": "IRS"}


def _tables(answer: CorrelateTables) -> Sequence[Table]:
    found = answer.orthogonality
    if found is None:
        return ()
    rows = [
        (
            str(p.test),
            str(p.analysis),
            Cell(percent(p.cross, 1), bar=p.cross),
            percent(p.beside, 1),
            percent(p.own, 1),
            "" if p.own_with is None else str(p.own_with),
        )
        for p in found.pairs
    ]
    pairs = Table.of(
        "Orthogonality of the pairs",
        ["test mode", "analysis mode", "cross %", "beside %", "own %", "with test mode"],
        rows,
        f"By the mass of the model reduced to the sensors ({_METHODS[found.reduction]}). Cross: "
        "test with its analysis mode; beside: the largest of either with another pair's; own: "
        "the largest of the test mode with another.",
    )
    asked = [
        (
            r.name,
            f"≤ {fixed(r.deviation_percent, 0)}",
            f"≥ {percent(r.diagonal)}",
            f"≤ {percent(r.off_diagonal)}",
            Cell("met", "good") if r.met else Cell(", ".join(r.unmet), "poor"),
        )
        for r in found.requirements
    ]
    headings = [*left("asked by"), "deviation %", "cross %", "beside and own %", *left("the pairs")]
    return [pairs, Table.of("What contracts ask", headings, asked)]


def _render(run: ReportedRun[CorrelateTables]) -> str:
    answer, found = run.tables, run.tables.orthogonality
    if found is None:
        return ""
    numbers = (tuple(p.test for p in found.pairs), tuple(p.analysis for p in found.pairs))
    picture = heatmap.heatmap(
        MacTable(*numbers, found.cross),
        "Cross-orthogonality",
        test_hz=answer.test_hz,
        analysis_hz=answer.analysis_hz,
        pairs=[(p.test, p.analysis) for p in answer.pairs],
        width=500,
    )
    return "".join(map(html_table, _tables(answer))) + picture


ORTHOGONALITY = Section("Orthogonality", "orthogonality", CorrelateTables, _tables, _render)
