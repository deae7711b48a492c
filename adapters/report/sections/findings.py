"""What is missing in the model or wrong in the test: sentences, picture, table."""

from collections.abc import Sequence

from ....core.discovery.effects import KINDS as EFFECTS
from ....core.discovery.faults import FAULTS
from ....core.discovery.findings import Finding, Where
from ....core.results.discovery import DiscoverTables
from ....core.results.plain import Json
from ..html.html_table import html_table
from ..html.markup import esc, key, tag
from ..pictures import heatmap
from ..pictures.scene import scene
from ..tables.number_formats import MISSING, general, percent
from ..tables.table import Cell, Table, left
from . import marks_on_structure
from .section import ReportedRun, Section

_SHOWN = 12
"""So many of the cards that carry an effect are shown."""
_APART = (
    "The colours are what the sensors miss of the deck as it came; the numbers are where the "
    "search, with the known parameters moving along, places the cause. A cause often shows where "
    "the structure moves most, not where it sits, so the two need not agree."
)
_ROLES = (
    ("effect", "missing in the model"),
    ("credible", "places that explain the data about as well"),
    ("fault", "fault of the test"),
    ("sensor", "sensor"),
)


def kind_in_words(kind: str) -> str:
    """Return what a kind of effect or fault calls itself; an unknown kind as it stands."""
    known = EFFECTS.get(kind) or FAULTS.get(kind)
    return known.label if known else kind.replace("_", " ")


def _tables(found: DiscoverTables) -> Sequence[Table]:
    rows = [
        (
            f.side,
            kind_in_words(f.kind),
            f.where.region or "",
            _magnitude(f),
            Cell(percent(f.confidence), bar=f.confidence),
            _places(f),
        )
        for f in found.findings
    ]
    words = left("side", "what", "where", "size (95 % interval)")
    note = "Sizes without a unit are in deck units."
    columns = (*words, "confidence %", "places as good")
    return [Table.of("Findings", columns, rows, note)] if rows else []


def _places(finding: Finding) -> str:
    """Return how many places explain the data as well, and of how many grids or elements."""
    places = finding.credible_set
    named = {"elements": {e for p in places for e in p.elements or ()},
             "grids": {g for p in places for g in _carrying(p)}}  # fmt: skip
    word, members = max(named.items(), key=lambda one: len(one[1]))
    more = f" ({len(members)} {word})" if len(members) > len(places) else ""
    return f"{len(places)}{more}" if places else MISSING


def _carrying(place: Where) -> tuple[int, ...]:
    """Return the grids that carry what is at a place: of a foot on one grid that alone."""
    grids = place.grids or ()
    return grids[:1] if place.normal else grids


def _magnitude(finding: Finding) -> str:
    """Return the magnitudes, the first with its 95 % interval; masses in kilograms if known."""
    sizes = dict(finding.magnitude)
    kilograms, mass = sizes.pop("kilograms", None), sizes.get("mass")
    each = kilograms / mass if isinstance(mass, float) and isinstance(kilograms, float) else None
    told = {k: _value(v) for k, v in sizes.items()}
    if each is not None:
        told["mass"] = f"{general(kilograms, 3)} kg"
    said = [k.replace("_", " ") + ("" if sizes[k] is True else f" {v}") for k, v in told.items()]
    if said and finding.interval is not None:
        scale = each if each is not None and next(iter(told)) == "mass" else 1.0
        low, high = (scale * v for v in finding.interval)
        said[0] += f" ({general(low, 3)} to {general(high, 3)})"
    return "; ".join(said) or MISSING


def _value(value: Json) -> str:
    if isinstance(value, list | tuple):
        return ", ".join(map(_value, value))
    return general(value, 3) if isinstance(value, int | float) else str(value)


def _render(run: ReportedRun[DiscoverTables]) -> str:
    found, misfit = run.tables.findings, run.tables.misfit
    if not found and misfit is None:
        return ""
    said = ""
    for k, f in enumerate(found, 1):
        left = len(f.cards) - _SHOWN
        more = f"\n... and {left} more, see changes.diff" if left > 0 else ""
        said += tag(
            "div",
            tag("span", str(k), class_=f"no {f.side}"),
            tag("p", esc(f.sentence)),
            tag("pre", esc("\n".join(f.cards[:_SHOWN]) + more), class_="diff") if f.cards else "",
            class_="finding",
        )
    return said + _picture(run) + "".join(map(html_table, _tables(run.tables)))


def _picture(run: ReportedRun[DiscoverTables]) -> str:
    if run.geometry is None:
        return ""
    told, geometry = run.tables, run.geometry
    values = None
    if told.misfit is not None:
        values = marks_on_structure.spread(told.misfit.grids, told.misfit.values, geometry)
    sensors = marks_on_structure.sensors(told.final.alignment.sensors, geometry, directions=False)
    marks = sensors + marks_on_structure.findings(told.findings, geometry, sensors)
    scale = heatmap.legend("misfit, % of its largest") if values is not None else ""
    keys = [key(text, role) for role, text in _ROLES if any(m.role == role for m in marks)]
    return (
        scene(geometry, "Where", marks=marks, values=values)
        + scale
        + tag("p", *keys, class_="note")
        + (tag("p", _APART, class_="note") if values is not None and told.findings else "")
    )


FINDINGS = Section("What was found", "findings", DiscoverTables, _tables, _render)
