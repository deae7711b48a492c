"""The sensors that agree least with the model."""

from collections.abc import Sequence

from ....core.results.correlation import CorrelateTables, RunTables
from ....core.results.update import UpdateTables
from ..html.html_table import html_table
from ..tables.number_formats import percent
from ..tables.table import Cell, Table, left
from .section import ReportedRun, Section

_MOST = 10


def _tables(answer: RunTables) -> Sequence[Table]:
    rows = answer.final.agreement
    if not isinstance(answer, CorrelateTables | UpdateTables) or not rows:
        return []
    worst = sorted(rows, key=lambda r: (not r.suspect, -r.misfit))[:_MOST]
    cells = [
        (
            r.sensor,
            percent(r.comac, 1),
            percent(r.misfit, 1),
            Cell(percent(r.mac_if_reversed, 1), "poor" if r.suspect else ""),
        )
        for r in worst
    ]
    note = (
        f"The {len(worst)} of {len(rows)} with the largest rms misfit, in % of the rms of the "
        "shapes. The last column is the mean MAC were the sensor turned round; red: check its "
        "polarity."
    )
    columns = (*left("sensor"), "COMAC %", "misfit %", "MAC % if reversed")
    return [Table.of("Sensors that agree least", columns, cells, note)]


def _render(run: ReportedRun[RunTables]) -> str:
    return "".join(map(html_table, _tables(run.tables)))


SENSORS = Section("Sensors", "sensors", RunTables, _tables, _render)
