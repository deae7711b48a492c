"""Where model and test disagree, as a section of the report."""

from collections.abc import Sequence

from ....core.data.geometry import Geometry
from ....core.results.discovery import DiscoverTables
from ....core.results.evidence import MisfitTable
from ..html.html_table import html_table
from ..html.markup import esc, tag
from ..pictures import heatmap
from ..pictures.scene import scene
from ..tables.number_formats import fixed, hz, percent
from ..tables.table import Table, left
from . import marks_on_structure
from .section import ReportedRun, Section

_MAPS = {
    "values": ("Seen by the sensors", "misfit, % of its largest"),
    "mass": ("If mass were missing", "explained, % of the best place"),
    "stiffness": ("If stiffness were wrong", "explained, % of the best place"),
    "ground": ("If a spring to ground were missing", "explained, % of the best place"),
}
_OF = {"mass": "mass", "stiffness": "stiffness", "ground": "a spring to ground"}
_MOST_SENSORS = 8


def _render(run: ReportedRun[DiscoverTables]) -> str:
    told = run.tables.misfit
    if told is None:
        return ""
    body = tag("p", esc(_said(told)), class_="note")
    if run.geometry is not None:
        body += tag("div", _maps(told, run.geometry), class_="maps")
    return body + "".join(map(html_table, misfit_tables(run.tables)))


def _maps(told: MisfitTable, geometry: Geometry) -> str:
    pictures = ""
    for key, (title, legend) in _MAPS.items():
        values = marks_on_structure.spread(told.grids, getattr(told, key), geometry)
        if values is not None:
            drawn = scene(geometry, title, values=values, width=400, height=340, most=900)
            pictures += tag("div", drawn, heatmap.legend(legend))
    return pictures


def _said(told: MisfitTable) -> str:
    """Say what the best place of each kind would explain, and what the maps are worth."""
    best = [
        f"{_OF.get(p.of, p.of)} around grid {p.grid} would explain {percent(p.explained, 0)} %"
        for p in told.peaks
    ]
    first = f"Of the misfit, {'; '.join(best)}. " if best else ""
    return first + (
        "To first order and one place at a time: the maps show where to look. The search lets "
        "the known parameters move along and decides, so what it found may stand elsewhere."
    )


def misfit_tables(found: DiscoverTables) -> Sequence[Table]:
    """Return the misfit of each pair, and the sensors that disagree most."""
    told = found.misfit
    if told is None:
        return []
    known = found.before.test_hz
    pairs = [
        (str(m.test), hz(known[m.test - 1]), fixed(m.shape, 1), fixed(m.frequency, 1))
        for m in told.modes
    ]
    worst = sorted(told.sensors, key=lambda s: -s.misfit)[:_MOST_SENSORS]
    sensors = [(s.sensor, fixed(s.misfit, 1), percent(s.comac, 1)) for s in worst]
    tables = (
        Table.of(
            "Misfit of the pairs", ("test mode", "Hz", "shape", "frequency"), pairs,
            "In standard deviations of the measurement: 1 is noise alone.",
        ),
        Table.of(
            "Misfit of the sensors", (*left("sensor"), "misfit", "COMAC %"), sensors,
            f"The {len(sensors)} of {len(told.sensors)} that disagree most, before anything was "
            "completed.",
        ),
    )  # fmt: skip
    return [t for t in tables if t.rows]


DISAGREEMENT = Section(
    "Where model and test disagree", "disagreement", DiscoverTables, render=_render
)
