"""The report: one self-contained page made from what a run folder holds."""

from collections.abc import Sequence
from importlib.resources import files
from pathlib import PurePath

from ...core.data.geometry import Geometry
from ...core.results.correlation import RunTables
from ...core.results.discovery import DiscoverTables
from ...core.results.made import MadeTables
from .html.html_table import html_table
from .html.markup import esc, tag
from .imprint import Imprint, colophon, letterhead
from .pictures import colour
from .pictures.film import Film
from .pictures.function_overlay import Curves
from .sections.findings import FINDINGS
from .sections.known_sections import SECTIONS
from .sections.pairs import PAIRS
from .sections.parameters import PARAMETERS
from .sections.section import ReportedRun
from .tables.headline import VERDICTS, figures, story

_FIRST = (FINDINGS, PAIRS, PARAMETERS)
"""Sections whose tables a notebook shows."""
Fact = tuple[str, str, str]
_VERBS = {"correlate": "Correlation", "update": "Update", "discover": "Discovery"}


def make_report(
    answer: RunTables,
    diff: str | None = None,
    geometry: Geometry | None = None,
    title: str | None = None,
    shapes: Film | None = None,
    imprint: Imprint | None = None,
    curves: Curves | None = None,
) -> str:
    """Return the report of a run as one HTML page that needs nothing else.

    No network, no fonts, no scripts from elsewhere; pictures are inline SVG and stand without
    JavaScript, which only adds the values under the pointer.

    Parameters
    ----------
    answer : CorrelateTables, UpdateTables or DiscoverTables
        The content of ``result.json``.
    diff : str, optional
        Unified diff of the deck.
    geometry : Geometry, optional
        The analysis model, for the pictures; drawn coarser where it is large.
    title : str, optional
        What was compared; stands above the headline.
    shapes : Film, optional
        Of pairs and single modes (`paired_film` makes them), shown moving.
    imprint : Imprint, optional
        Whose report it is.
    curves : Curves, optional
        Measured frequency responses with those of the model over them.

    Returns
    -------
    str
        The page, UTF-8 when written.
    """
    run = ReportedRun(answer, geometry, shapes, diff or "", curves)
    shown = [(section, body) for section in SECTIONS if (body := section.body(run))]
    kind = _VERBS[answer.verb]
    name = title or _compared(answer)
    verdict = ""
    if isinstance(answer, DiscoverTables):
        told = esc(VERDICTS.get(answer.verdict, answer.verdict))
        verdict = tag("span", told, class_="verdict")
    kicker = tag("p", esc(" · ".join(t for t in (kind, name) if t)), verdict, class_="kicker")
    first, *rest = story(answer)
    links = tag("nav", *[tag("a", esc(s.title), href=f"#{s.anchor}") for s, _ in shown],
                aria_label="Sections")  # fmt: skip
    return sheet(
        answer,
        (kind, name),
        kicker,
        tag("h1", _unbroken(first)),
        tag("p", _unbroken(" ".join(rest)), class_="lede") if rest else "",
        figures_strip(figures(answer)),
        warned(answer.all_warnings),
        links if len(shown) > 2 else "",
        *[tag("section", tag("h2", esc(s.title), id=s.anchor), body) for s, body in shown],
        imprint=imprint,
        scripts=["viewer.js"] * (shapes is not None) + ["functions.js"] * (curves is not None),
    )


def sheet(
    answer: MadeTables,
    names: tuple[str, str],
    *body: str,
    imprint: Imprint | None,
    scripts: Sequence[str] = (),
) -> str:
    """Return a page that needs nothing else, in the style of the reports, light and dark.

    Parameters
    ----------
    answer : MadeTables
        What made it stands at its foot.
    names : (str, str)
        What it is and of what, for its title.
    *body : str
        Markup between letterhead and foot.
    imprint : Imprint or None
        Whose page it is.
    scripts : sequence of str
        Of this folder, besides what shows values under the pointer.
    """
    title = imprint.title if imprint and imprint.title else names[1] or names[0]
    head = (
        '<meta charset="utf-8"><meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>trueup · {esc(title)}</title><style>{_style()}</style>"
    )
    main = tag("main", letterhead(imprint), *body, colophon(answer))
    tip = '<div id="tip" role="status" hidden></div>'
    script = f"<script>{''.join(map(_asset, ('page.js', *scripts)))}</script>"
    return (
        f'<!doctype html>\n<html lang="en"><head>{head}</head><body>{main}{tip}{script}</body>'
        "</html>\n"
    )


def titled(kind: str, name: str, heading: str, warnings: Sequence[str], *facts: Fact) -> str:
    """Return the top of a page: what it is, the heading, key figures, warnings."""
    return (
        tag("p", esc(" · ".join(t for t in (kind, name) if t)), class_="kicker")
        + tag("h1", esc(heading))
        + figures_strip(facts)
        + warned(warnings)
    )


def sections(*shown: tuple[str, str]) -> str:
    """Return sections, each a title and its markup, without those that have none."""
    return "".join(tag("section", tag("h2", title), body) for title, body in shown if body)


def summary(answer: RunTables) -> str:
    """Return the headline of a run and its first tables as HTML, for a notebook."""
    tables = [t for section in _FIRST for t in section.tables_of(answer)]
    said = [tag("b", esc(t.title)) + html_table(t) for t in tables]
    return tag("p", esc(" ".join(story(answer)))) + "".join(said)


def _unbroken(text: str) -> str:
    """Escape; a number stays on the line of its percent sign."""
    return esc(text).replace(" %", "&nbsp;%")


def _compared(answer: RunTables) -> str:
    """Name the deck and the test by their file names."""
    deck, test = answer.sources
    sides = ((deck,) if deck else (), test)
    return " against ".join(", ".join(PurePath(p).name for p in side) for side in sides if side)


def figures_strip(facts: Sequence[Fact]) -> str:
    """Return key figures, each a name, a value, and what it was before or nothing."""
    items = ""
    for what, now, then in facts:
        before = tag("small", esc(f"before {then}")) if then else ""
        items += tag("div", tag("dt", esc(what)), tag("dd", esc(now), before))
    return tag("dl", items, class_="figures") if items else ""


def warned(warnings: Sequence[str]) -> str:
    """Return warnings, more than a few folded away; nothing where there are none."""
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


def _style() -> str:
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
