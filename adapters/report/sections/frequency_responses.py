"""How well measured frequency responses are met before and after."""

from collections.abc import Sequence

from ....core.results.discovery import DiscoverTables
from ..tables.number_formats import fixed, general, percent
from ..tables.table import Table, left
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
    columns = [*left("measure"), "before", "after"]
    note = (
        f"{frf.lines} lines at {len(frf.responses)} sensors, none of them used to fit a "
        f"hypothesis; {general(frf.independent_lines, 3)} count as independent."
    )
    return [Table.of("Frequency responses", columns, rows, note)]


FREQUENCY_RESPONSES = Section("Frequency responses", "responses", DiscoverTables, _tables)
