"""A discovery as sections of the report; None where the run says nothing."""

from __future__ import annotations

from collections.abc import Sequence

from ...core.arrays import Floats
from ...core.geometry import Geometry
from . import discovery, heatmap, placing, reading
from .html_table import html_table
from .markup import esc, tag
from .reading import Result
from .scene import scene
from .section import Section
from .tables import Table

_SHOWN = 12
"""So many of the cards that carry an effect are shown."""


def findings(
    result: Result, geometry: Geometry | None, sensors_xyz: Floats | None
) -> Section | None:
    """Return what is missing or wrong: sentences, picture, table."""
    found = reading.records(result, "findings")
    misfit = placing.misfit(result, geometry)
    if not found and misfit is None:
        return None
    said = ""
    for k, f in enumerate(found, 1):
        cards = reading.texts(f, "cards")
        text = str(f.get("sentence") or f"{discovery.kind(f)}, {discovery.where(f)}")
        written = _written(cards)
        said += tag(
            "div",
            tag("span", str(k), class_=f"no {f.get('side', '')}"),
            tag("p", esc(text)),
            tag("pre", written, class_="diff") if written else "",
            class_="finding",
        )
    picture = ""
    if geometry is not None:
        rows = reading.records(
            reading.part(reading.final(result), "alignment") or reading.part(result, "alignment"),
            "sensors",
        )
        marks = placing.sensors(rows, geometry, sensors_xyz, result, directions=False)
        marks += placing.findings(found, geometry, marks)
        picture = scene(geometry, "Where", marks=marks, values=misfit)
        scale = heatmap.legend("misfit, % of its largest") if misfit is not None else ""
        picture += scale + tag(
            "p",
            *[
                tag("span", tag("i", class_=role), text, class_="key")
                for role, text in (
                    ("effect", "missing in the model"),
                    ("credible", "places that explain the data about as well"),
                    ("fault", "fault of the test"),
                    ("sensor", "sensor"),
                )
                if any(m.role == role for m in marks)
            ],
            class_="note",
        )
    table = discovery.findings(result)
    body = said + picture + (html_table(table) if table else "")
    return Section("What was found", "findings", body)


def _written(cards: Sequence[str]) -> str:
    """Return the cards in the deck as they stand there, the first of many."""
    left = len(cards) - _SHOWN
    more = f"\n... and {left} more, see changes.diff" if left > 0 else ""
    return esc("\n".join(cards[:_SHOWN]) + more)


def gap(result: Result) -> Section | None:
    """Return how the gap shrank, on the searched and on the held-out data."""
    return _only_table("The gap", "gap", discovery.gap(result))


def damping(result: Result) -> Section | None:
    """Return damping ratios before and after."""
    return _only_table("Damping", "damping", discovery.damping(result))


def responses(result: Result) -> Section | None:
    """Return how well frequency responses are met before and after."""
    return _only_table("Frequency responses", "responses", discovery.responses(result))


def would_decide(result: Result) -> Section | None:
    """Return what to measure next where the data do not decide."""
    said = reading.texts(result, "would_decide")
    if not said:
        return None
    return Section("What would decide", "decide", tag("ul", *[tag("li", esc(s)) for s in said]))


def alternatives(result: Result) -> Section | None:
    """Return what else was considered."""
    return _only_table("Also considered", "alternatives", discovery.alternatives(result))


def _only_table(heading: str, anchor: str, table: Table | None) -> Section | None:
    return None if table is None else Section(heading, anchor, html_table(table))
