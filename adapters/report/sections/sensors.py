"""The sensors that agree least with the model."""

from collections.abc import Sequence
from dataclasses import replace

from ....core.results.correlation import CorrelateTables, RunTables
from ....core.results.update import UpdateTables
from ..html.html_table import html_table
from ..html.markup import tag
from ..pictures import heatmap
from ..pictures.scene import scene
from ..tables.number_formats import percent
from ..tables.table import Cell, Table, left
from . import marks_on_structure
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
            Cell(percent(r.mac_if_reversed, 1) + " !" * r.suspect, "poor" if r.suspect else ""),
        )
        for r in worst
    ]
    note = (
        f"The {len(worst)} of {len(rows)} with the largest rms misfit, in % of the rms of the "
        "shapes. The last column is the mean MAC were the sensor turned round"
        + ("; !: check its polarity." if any(r.suspect for r in worst) else ".")
    )
    columns = (*left("sensor"), "COMAC %", "misfit %", "MAC % if reversed")
    return [Table.of("Sensors that agree least", columns, cells, note)]


def _render(run: ReportedRun[RunTables]) -> str:
    tables = "".join(map(html_table, _tables(run.tables)))
    if not tables or run.geometry is None:
        return tables
    found = run.tables.final
    largest = max(r.misfit for r in found.agreement) or 1.0
    of_node: dict[int, float] = {}
    for s, r in zip(found.alignment.sensors, found.agreement, strict=True):
        of_node[s.node] = max(r.misfit / largest, of_node.get(s.node, 0.0))
    marks = [
        replace(
            m,
            role="misfit",
            value=of_node[int(m.name)],
            note=f"{m.note}\nmisfit {percent(of_node[int(m.name)] * largest, 1)} %",
        )
        for m in marks_on_structure.sensors(found.alignment.sensors, run.geometry, directions=False)
    ]
    picture = scene(run.geometry, "Misfit of the sensors", marks=marks, width=480, behind=False)
    scale = heatmap.legend("misfit, % of its largest")
    return tag("div", tag("div", tables), tag("div", picture, scale), class_="beside")


SENSORS = Section("Sensors", "sensors", RunTables, _tables, _render)
