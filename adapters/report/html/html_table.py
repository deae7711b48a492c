"""A table of the run as HTML."""

from itertools import groupby

from ..tables.table import Cell, Table
from .markup import esc, tag


def html_table(table: Table) -> str:
    """Return a table as HTML, its note under it."""
    groups = [c.group for c in table.columns]
    head = ""
    if any(groups):
        runs = ((name, len([*run])) for name, run in groupby(groups))
        head = tag("tr", *(tag("th", esc(name), colspan=n, class_="group" if name else None)
                           for name, n in runs))  # fmt: skip
    starts = {k for k, g in enumerate(groups) if g and (k == 0 or groups[k - 1] != g)}
    classes = [
        " ".join([*["r"] * c.numeric, *["g"] * (k in starts)]) or None
        for k, c in enumerate(table.columns)
    ]
    named = zip(table.columns, classes, strict=True)
    head += tag("tr", *[tag("th", esc(c.heading), class_=kind, scope="col") for c, kind in named])
    rows = [tag("tr", *map(_cell, row, classes)) for row in table.rows]
    both = "both" if any(groups) else None
    body = tag("table", tag("thead", head), tag("tbody", *rows), class_=both)
    note = tag("p", esc(table.note), class_="note") if table.note else ""
    return tag("div", tag("div", body, class_="wide"), note, class_="tabled")


def _cell(cell: Cell, classes: str | None) -> str:
    bar = ""
    if cell.bar is not None:
        width = 100 * min(max(cell.bar, 0.0), 1.0)
        bar = tag("span", tag("i", style=f"width:{width:.0f}%"), class_="bar", aria_hidden="true")
    joined = " ".join(c for c in (classes, cell.tone) if c)
    return tag("td", esc(cell.text), bar, class_=joined or None)
