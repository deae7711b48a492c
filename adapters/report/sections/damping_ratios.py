"""Damping ratios of the pairs before and after an update."""

from collections.abc import Sequence

from ....core.results.update import DampingRow, UpdateTables
from ..tables.number_formats import MISSING, fixed
from ..tables.table import Table
from .section import Section


def _tables(answer: UpdateTables) -> Sequence[Table]:
    cells = [
        (str(r.test), *(MISSING if v is None else fixed(v, 3) for v in _ratios(r)))
        for r in answer.damping or ()
    ]
    note = "Of critical damping; those of the analysis are of its complex modes."
    headings = ["test mode", "test %", "before %", "after %"]
    return [Table.of("Damping ratios", headings, cells, note)] if cells else ()


def _ratios(r: DampingRow) -> tuple[float | None, ...]:
    return r.test_percent, r.before, r.after


DAMPING_RATIOS = Section("Damping ratios", "damping-ratios", UpdateTables, _tables)
