"""Where model and test disagree, as a section of the report."""

from __future__ import annotations

from ...core.geometry import Geometry
from . import heatmap, placing, reading
from .formats import fixed, hz, percent
from .html_table import html_table
from .markup import esc, tag
from .reading import Result
from .scene import scene
from .section import Section
from .tables import Cell, Column, Table

_MAPS = {
    "values": ("Seen by the sensors", "misfit, % of its largest"),
    "mass": ("If mass were missing", "explained, % of the best place"),
    "stiffness": ("If stiffness were wrong", "explained, % of the best place"),
    "ground": ("If a spring to ground were missing", "explained, % of the best place"),
}
_OF = {"mass": "mass", "stiffness": "stiffness", "ground": "a spring to ground"}
_MOST_SENSORS = 8


def section(result: Result, geometry: Geometry | None) -> Section | None:
    """Return maps on the structure, and tables by mode and by sensor; None without any."""
    told = reading.part(result, "misfit")
    if not told:
        return None
    pictures = ""
    for key, (title, legend) in _MAPS.items():
        values = placing.misfit(result, geometry, key)
        if geometry is not None and values is not None:
            drawn = scene(geometry, title, values=values, width=400, height=340, most=900)
            pictures += tag("div", drawn, heatmap.legend(legend))
    body = tag("p", esc(_said(told)), class_="note")
    body += tag("div", pictures, class_="maps") if pictures else ""
    by_mode, by_sensor = modes(result), sensors(result)
    body += "".join(html_table(t) for t in (by_mode, by_sensor) if t is not None)
    return Section("Where model and test disagree", "disagreement", body)


def _said(told: Result) -> str:
    """Say what the best place of each kind would explain, and what the maps are worth."""
    best = [
        f"{_OF[of]} around grid {peak.get('grid')} would explain {percent(share, 0)} %"
        for peak in reading.records(told, "peaks")
        for of, share in [(str(peak.get("of")), reading.number(peak.get("explained")))]
        if of in _OF and share is not None
    ]
    first = f"Of the misfit, {'; '.join(best)}. " if best else ""
    return first + (
        "To first order and one place at a time: the maps show where to look, the search decides."
    )


def modes(result: Result) -> Table | None:
    """Return the misfit of each pair."""
    found = reading.records(reading.part(result, "misfit"), "modes")
    if not found:
        return None
    known = reading.mode_hz(reading.initial(result) or reading.final(result), "test")
    rows = []
    for m in found:
        test = reading.mode_number(m.get("test"), "test")
        frequency = hz(known.get(test)) if test is not None else ""
        cells = (fixed(m.get("shape"), 1), fixed(m.get("frequency"), 1))
        rows.append((Cell("" if test is None else str(test)), Cell(frequency), *map(Cell, cells)))
    columns = (Column("test mode"), Column("Hz"), Column("shape"), Column("frequency"))
    note = "In standard deviations of the measurement: 1 is noise alone."
    return Table("Misfit of the pairs", columns, tuple(rows), note)


def sensors(result: Result) -> Table | None:
    """Return the sensors that disagree most."""
    found = reading.records(reading.part(result, "misfit"), "sensors")
    ranked = sorted(found, key=lambda s: -(reading.number(s.get("misfit")) or 0.0))
    rows = tuple(
        (
            Cell(str(s.get("sensor"))),
            Cell(fixed(s.get("misfit"), 1)),
            Cell(percent(s.get("comac"), 1)),
        )
        for s in ranked[:_MOST_SENSORS]
    )
    if not rows:
        return None
    columns = (Column("sensor", numeric=False), Column("misfit"), Column("COMAC %"))
    note = f"The {len(rows)} of {len(found)} that disagree most, before anything was completed."
    return Table("Misfit of the sensors", columns, rows, note)
