"""The page of several configurations that were updated together."""

from collections.abc import Sequence

from ...core.results.together import ConfigurationPairRow, TogetherTables
from .html.html_table import html_table
from .html.markup import esc, tag
from .imprint import Imprint
from .page import sections, sheet, titled
from .sections.parameters import iterations_table, parameters_table
from .tables.headline import counted_pairs
from .tables.number_formats import counted, fixed, hz, percent, signed
from .tables.table import Cell, Column, Heading, Table, left


def headline(found: TogetherTables) -> str:
    """Return the result in a sentence."""
    rows = found.configurations
    moved, states = counted(len(found.parameters), "parameter"), len(rows)
    pairs, before, n = (
        sum(getattr(r, k) for r in rows) for k in ("pairs", "pairs_before", "test_modes")
    )
    off, was = (
        [abs(d) for p in found.pairs if (d := getattr(p, k)) is not None]
        for k in ("deviation_percent", "deviation_before_percent")
    )
    text = f"After updating {moved} in {counted(states, 'configuration')}, "
    text += f"{counted_pairs(pairs, n)} ({before} before)"
    if off and was:
        mean, then = sum(off) / len(off), sum(was) / len(was)
        text += (
            f" and frequencies are {fixed(mean, 1)} % off on average ({fixed(then, 1)} % before)"
        )
    return f"{text}."


def together_tables(found: TogetherTables) -> list[Table]:
    """Return what the terminal and the page show: configurations, parameters, pairs of each."""
    return [
        _configurations(found),
        parameters_table(found.parameters),
        *(
            _pairs(c.name, [p for p in found.pairs if p.configuration == c.name])
            for c in found.configurations
        ),
    ]


def together_page(found: TogetherTables, imprint: Imprint | None = None) -> str:
    """Return the page; it leads to those of the configurations, which lie in folders beside it."""
    links = [
        tag("li", tag("a", esc(c.name), href=f"{c.folder}/report.html"))
        for c in found.configurations
    ]
    history = iterations_table(found.history, [p.name for p in found.parameters], found.stopped)
    name = ", ".join(c.name for c in found.configurations)
    return sheet(
        found,
        ("update", name),
        titled("Update", name, headline(found), found.warnings),
        tag("p", "The page of each configuration:"),
        tag("ul", *links),
        sections(
            *((esc(t.title), html_table(t)) for t in together_tables(found)),
            ("Iterations", html_table(history)),
        ),
        imprint=imprint,
    )


def _configurations(found: TogetherTables) -> Table:
    headings: list[Heading] = [*left("configuration"), "pairs", "before", "mean |dev.| %"]
    headings += ["before", "mean MAC %", "before"]
    rows = [
        [
            c.name,
            f"{c.pairs} of {c.test_modes}",
            str(c.pairs_before),
            fixed(c.mean_abs_deviation_percent, 2),
            fixed(c.mean_abs_deviation_percent_before, 2),
            percent(c.mean_mac, 1),
            percent(c.mean_mac_before, 1),
        ]
        for c in found.configurations
    ]
    return Table.of("Configurations", headings, rows)


def _pairs(name: str, pairs: Sequence[ConfigurationPairRow]) -> Table:
    columns: list[Heading] = ["test mode", "Hz"]
    what = ("analysis mode", "Hz", "deviation %", "MAC %")
    columns += [Column(heading, group) for group in ("before", "after") for heading in what]
    rows: list[list[Cell | str]] = []
    for p in pairs:
        then = p.analysis_before, p.analysis_before_hz, p.deviation_before_percent, p.mac_before
        now = p.analysis, p.analysis_hz, p.deviation_percent, p.mac
        rows.append([str(p.test), hz(p.test_hz), *_partner(*then), *_partner(*now)])
    return Table.of(f"Pairs of {name}", columns, rows)


def _partner(
    mode: int | None, f: float | None, off: float | None, mac: float | None
) -> list[Cell | str]:
    if mode is None or f is None:
        return [Cell("none", "muted"), "", "", ""]
    return [str(mode), hz(f), signed(off, 2), Cell(percent(mac, 1), bar=mac)]
