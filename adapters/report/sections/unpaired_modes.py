"""Modes of both sides without a partner, each with its closest look-alike by MAC."""

from collections.abc import Sequence

import numpy as np

from ....core.results.correlation import MacTable, RunTables
from ..html.html_table import html_table
from ..html.markup import esc, tag
from ..tables.number_formats import counted, hz, percent
from ..tables.table import Column, Table, left
from .section import ReportedRun, Section

_ABOVE = 1.02
"""Analysis modes above the highest test mode by this factor are only counted."""


def _tables(answer: RunTables) -> Sequence[Table]:
    found = answer.final
    top = _ABOVE * np.max(found.test_hz, initial=0.0)
    beyond = [a for a in found.unpaired_analysis if found.analysis_hz[a - 1] > top]
    rows = []
    for side, other, modes, frequencies in (
        ("test", "analysis", found.unpaired_test, found.test_hz),
        ("analysis", "test", found.unpaired_analysis, found.analysis_hz),
    ):
        for n in modes:
            if side == "analysis" and n in beyond:
                continue
            like, mac = _closest(found.mac_rotated, side, n)
            called = answer.named.get(n, "") if side == "test" else ""
            number = f"{n} {called}".rstrip()
            rows.append((side, number, hz(frequencies[n - 1]), f"{other} {like}", percent(mac, 1)))
    note = f"Above the test's range: {counted(len(beyond), 'analysis mode')}." if beyond else ""
    columns = [*left("side"), "mode", "Hz", "most alike", "MAC %"]
    return [Table.of("Modes without a partner", columns, rows, note)] if rows else []


def _closest(matrix: MacTable, side: str, mode: int) -> tuple[int, float]:
    test = side == "test"
    own, others = (matrix.test, matrix.analysis) if test else (matrix.analysis, matrix.test)
    row = np.nan_to_num((matrix.values if test else matrix.values.T)[own.index(mode)])
    k = int(np.argmax(row))
    return others[k], float(row[k])


def _render(run: ReportedRun[RunTables]) -> str:
    for table in _tables(run.tables):
        sides = [_only(table, side) for side in ("test", "analysis")]
        shown = tag("div", *[html_table(t) for t in sides if t.rows], class_="row")
        return shown + (tag("p", esc(table.note), class_="note") if table.note else "")
    return ""


def _only(table: Table, side: str) -> Table:
    """Return the rows of one side, without that column and the note."""
    rows = tuple(r[1:] for r in table.rows if r[0].text == side)
    return Table(f"{table.title}: {side}", (Column(f"{side} mode"), *table.columns[2:]), rows)


UNPAIRED_MODES = Section("Modes without a partner", "unpaired", RunTables, _tables, _render)
