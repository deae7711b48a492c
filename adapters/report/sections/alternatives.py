"""What else was considered, and how likely it is beside what was found."""

from collections.abc import Sequence

from ....core.results.discovery import DiscoverTables
from ..tables.table import Table, left
from .section import Section


def _tables(found: DiscoverTables) -> Sequence[Table]:
    rows = [(a.where or a.sentence, a.odds) for a in found.alternatives]
    columns = left("what", "beside what was found")
    return [Table.of("Also considered", columns, rows)] if rows else []


ALTERNATIVES = Section("Also considered", "alternatives", DiscoverTables, _tables)
