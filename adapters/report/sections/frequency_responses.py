"""How well measured frequency responses are met before and after."""

from collections.abc import Sequence

from ....core.results.discovery import DiscoverTables
from ..tables.number_formats import fixed, general, percent
from ..tables.table import Cell, Column, Table
from .section import Section


def _tables(found: DiscoverTables) -> Sequence[Table]:
    frf = found.frf
    if frf is None or not frf.responses:
        return []
    mean, log = frf.mean_frac, frf.log_misfit
    worst = [min(r.before for r in frf.responses), min(r.after for r in frf.responses)]
    rows = (
        ("FRAC %, mean over the sensors", percent(mean.before, 1), percent(mean.after, 1)),
        ("FRAC %, worst sensor", *[percent(w, 1) for w in worst]),
        ("magnitudes, rms log ratio", fixed(log.before, 3), fixed(log.after, 3)),
    )
    columns = (Column("measure", numeric=False), Column("before"), Column("after"))
    note = (
        f"{frf.lines} lines at {len(frf.responses)} sensors, none of them used to fit a "
        f"hypothesis; {general(frf.independent_lines, 3)} count as independent."
    )
    cells = tuple(tuple(map(Cell, row)) for row in rows)
    return [Table("Frequency responses", columns, cells, note)]


FREQUENCY_RESPONSES = Section("Frequency responses", "responses", DiscoverTables, _tables)
