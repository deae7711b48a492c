"""The report: one self-contained page made from what a run folder holds."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.resources import files
from pathlib import PurePath

from ...core.arrays import Floats
from ...core.geometry import Geometry
from . import colour, disagreement, discovery_sections, reading, sections, viewer
from .headline import VERDICTS, figures, story
from .markup import esc, tag
from .overlay import Overlay
from .reading import Result
from .section import Section

_VERBS = {"correlate": "Correlation", "update": "Update", "discover": "Discovery"}


def make_report(
    result: Result,
    diff: str | None = None,
    geometry: Geometry | None = None,
    sensors_xyz: Floats | None = None,
    title: str | None = None,
    shapes: Overlay | None = None,
) -> str:
    """Return the report of a run as one HTML page that needs nothing else.

    No network, no fonts, no scripts from elsewhere; pictures are inline SVG and stand without
    JavaScript, which only adds the values under the pointer.

    Parameters
    ----------
    result : mapping
        The content of ``result.json``, schema ``trueup/correlate/1``, ``trueup/update/1`` or
        ``trueup/discover/1``. A key that is absent leaves its section out; further keys are
        passed over.
    diff : str, optional
        Unified diff of the deck.
    geometry : Geometry, optional
        The analysis model, for the pictures; drawn coarser where it is large.
    sensors_xyz : (n_sensor, 3) float, optional
        Positions in the analysis frame and length unit, one a row of ``alignment.sensors``.
        Default: the positions of their nearest grids.
    title : str, optional
        What was compared; stands above the headline.
    shapes : Overlay, optional
        The paired shapes (`overlay` makes them), shown moving.

    Returns
    -------
    str
        The page, UTF-8 when written.
    """
    shown = [s for s in _sections(result, diff, geometry, sensors_xyz, shapes) if s is not None]
    kind = _VERBS.get(reading.verb(result), "Run")
    name = title or _compared(result)
    kicker = tag(
        "p", esc(" · ".join(t for t in (kind, name) if t)), _verdict(result), class_="kicker"
    )
    first, *rest = story(result)
    links = tag("nav", *[tag("a", esc(s.heading), href=f"#{s.anchor}") for s in shown],
                aria_label="Sections")  # fmt: skip
    body = tag(
        "main",
        kicker,
        tag("h1", _unbroken(first)),
        tag("p", _unbroken(" ".join(rest)), class_="lede") if rest else "",
        _strip(result),
        _warnings(reading.texts(result, "warnings") + _nested_warnings(result)),
        links if len(shown) > 2 else "",
        *[tag("section", tag("h2", esc(s.heading), id=s.anchor), s.body) for s in shown],
        tag("footer", esc(f"trueup · {result.get('schema', 'no schema')}")),
    )
    head = (
        '<meta charset="utf-8"><meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>{esc(' · '.join(t for t in ('trueup', name or kind) if t))}</title>"
        f"<style>{style()}</style>"
    )
    tip = '<div id="tip" role="status" hidden></div>'
    moving = "" if shapes is None else _asset("viewer.js")
    script = f"<script>{_asset('page.js')}{moving}</script>"
    return (
        f'<!doctype html>\n<html lang="en"><head>{head}</head><body>{body}{tip}{script}</body>'
        "</html>\n"
    )


def _unbroken(text: str) -> str:
    """Escape; a number stays on the line of its percent sign."""
    return esc(text).replace(" %", "&nbsp;%")


def _compared(result: Result) -> str:
    """Name the deck and the test by their file names."""
    deck = result.get("input_deck") or result.get("deck")
    sides = ([str(deck)] if deck else [], reading.texts(result, "test"))
    named = [", ".join(PurePath(p).name for p in paths) for paths in sides if paths]
    return " against ".join(named)


def _sections(
    result: Result,
    diff: str | None,
    geometry: Geometry | None,
    sensors_xyz: Floats | None,
    shapes: Overlay | None,
) -> list[Section | None]:
    return [
        discovery_sections.findings(result, geometry, sensors_xyz),
        discovery_sections.would_decide(result),
        discovery_sections.gap(result),
        discovery_sections.damping(result),
        discovery_sections.responses(result),
        disagreement.section(result, geometry),
        sections.pairs(result),
        sections.matrices(result),
        viewer.shapes(shapes),
        sections.unpaired(result),
        sections.parameters(result),
        discovery_sections.alternatives(result),
        sections.alignment(result, geometry, sensors_xyz),
        sections.deck(diff),
    ]


def _verdict(result: Result) -> str:
    word = str(result.get("verdict") or "")
    return tag("span", esc(VERDICTS.get(word, word)), class_="verdict") if word else ""


def _strip(result: Result) -> str:
    items = ""
    for what, now, then in figures(result):
        before = tag("small", esc(f"before {then}")) if then else ""
        items += tag("div", tag("dt", esc(what)), tag("dd", esc(now), before))
    return tag("dl", items, class_="figures") if items else ""


def _nested_warnings(result: Result) -> list[str]:
    own = set(reading.texts(result, "warnings"))
    nested = [
        w for k in ("before", "after") for w in reading.texts(reading.part(result, k), "warnings")
    ]
    return [w for w in dict.fromkeys(nested) if w not in own]


def _warnings(warnings: Sequence[str]) -> str:
    if not warnings:
        return ""
    items = [tag("li", esc(w)) for w in warnings]
    shown = tag("ul", *items[:6])
    more = (
        tag("details", tag("summary", f"{len(items) - 6} more"), tag("ul", *items[6:]))
        if len(items) > 6
        else ""
    )
    return tag("div", tag("b", "Warnings"), shown, more, class_="warnings", role="note")


def style() -> str:
    """Return the style sheet of the pages, light and dark."""
    ramp = "".join(
        f".c{k}{{fill:var(--c{k})}}.mesh .bar.k{k}{{stroke:var(--c{k})}}"
        for k in range(colour.STEPS)
    )
    ramp += "".join(f".f{k}{{fill:var(--f{k})}}" for k in range(6))
    dark = colour.variables(dark=True)
    return (
        f":root{{{colour.variables(dark=False)}}}"
        f"@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}"
        f"{_asset('page.css')}{ramp}"
    )


def _asset(name: str) -> str:
    return files(__package__).joinpath(name).read_text(encoding="utf-8")
