"""Runs, decks or modes side by side, for the terminal."""

from __future__ import annotations

from collections.abc import Iterator

from rich.padding import Padding
from rich.text import Text

from ..adapters.report.tables.number_formats import fixed, general, hz, percent, signed, weighed
from ..core.results.comparison import CompareTables
from .terminal_tables import titled


def comparison_tables(found: CompareTables) -> Iterator[Padding]:
    """Yield what each is, the modes of the reference with their partners, and the values."""
    names = [s.name for s in found.sources]
    table = titled(f"Beside {found.reference}")
    table.add_column("")
    for heading in ("modes", "mass", "pairs", "mean %", "worst %", "MAC %"):
        table.add_column(heading, justify="right")
    for s in found.sources:
        table.add_row(
            Text(f"{s.name} ({s.what})"), str(s.modes),
            "" if s.mass is None else weighed(s.mass, s.kilograms),
            "" if s.pairs is None else str(s.pairs), fixed(s.mean_abs_deviation_percent, 2),
            fixed(s.worst_deviation_percent, 2), percent(s.mean_mac, 1),
        )  # fmt: skip
    yield Padding(table, (1, 0, 0, 0), expand=False)
    told = [n for n in names if any(m.source == n for m in found.modes)]
    table = titled("Modes: deviation %, MAC %", ("mode", "Hz", *told))
    by = {(m.mode, m.source): m for m in found.modes}
    for mode in dict.fromkeys(m.mode for m in found.modes):
        row = [by.get((mode, n)) for n in told]
        own = next(m.hz for m in found.modes if m.mode == mode)
        table.add_row(str(mode), hz(own), *[
            "none" if m is None or m.mac is None
            else f"{signed(m.deviation_percent, 2)}  {percent(m.mac, 1)}" for m in row
        ])  # fmt: skip
    yield Padding(table, (1, 0, 0, 0), expand=False)
    if found.values:
        table = titled("Values that differ", ("", *names))
        values = {(v.name, v.source): v.value for v in found.values}
        for name in dict.fromkeys(v.name for v in found.values):
            table.add_row(Text(name), *[general(values.get((name, n)), 6) for n in names])
        yield Padding(table, (1, 0, 0, 0), expand=False)
