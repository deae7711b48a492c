"""A plan for a test, for the terminal."""

from __future__ import annotations

from collections.abc import Iterator

from rich.table import Table
from rich.text import Text

from ..adapters.report.tables.number_formats import general, hz, percent
from ..core.results.plan import PlanTables
from .terminal_tables import titled


def plan_tables(found: PlanTables) -> Iterator[Table]:
    """Yield the sensors by grid, the exciters, and what the test will tell of each mode."""
    table = titled(f"{len(found.sensors)} sensors", ("grid", "directions", "x", "y", "z"))
    by_node: dict[int, list[str]] = {}
    for s in found.sensors:
        by_node.setdefault(s.node, []).append(s.direction)
    at = {s.node: s.xyz for s in found.sensors}
    for node, ways in by_node.items():
        table.add_row(str(node), " ".join(ways), *[general(x, 5) for x in at[node]])
    yield table
    headings = ("grid", "direction", "least residue %", "of mode")
    table = titled("Exciters", headings)
    for e in found.exciters:
        table.add_row(str(e.node), e.direction, percent(e.share, 1), str(e.least))
    yield table
    table = titled("Modes", ("mode", "Hz", "largest MAC %", "with", "excited %"))
    for m in found.modes:
        like = "" if m.like is None else str(m.like)
        table.add_row(str(m.mode), hz(m.hz), percent(m.worst_mac, 1), like, percent(m.reached, 1))
    table.caption = Text(
        "Largest MAC with another of these modes at the sensors; drive-point residue of the best "
        "exciter, of the largest that any place has.", style="dim",
    )  # fmt: skip
    table.caption_justify = "left"
    yield table
