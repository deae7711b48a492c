"""Measured damping ratios beside those of the deck before and after."""

from collections.abc import Sequence

from ....core.results.discovery import DiscoverTables
from ..tables.number_formats import fixed, percent
from ..tables.table import Table
from .section import Section


def _tables(found: DiscoverTables) -> Sequence[Table]:
    if found.damping is None or not found.damping.modes:
        return []
    rows = [
        (str(m.test), *[percent(v, 2) for v in (m.measured, m.before, m.after)])
        for m in found.damping.modes
    ]
    columns = ("test mode", "measured %", "before %", "after %")
    typical = found.damping.typical_factor
    note = (
        f"Off by a factor of {fixed(typical.before, 2)} typically before, "
        f"{fixed(typical.after, 2)} after. Dampers do not enter normal modes: the ratios "
        "are those of complex modes with the structure's own damping as the test shows it."
    )
    return [Table.of("Damping ratios", columns, rows, note)]


DAMPING = Section("Damping", "damping", DiscoverTables, _tables)
