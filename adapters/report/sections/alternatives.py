"""What else was considered, and how likely it is beside what was found."""

from collections.abc import Sequence

from ....core.results.discovery import DiscoverTables
from ..tables.table import Table, left
from .findings import kind_in_words
from .section import Section


def _tables(found: DiscoverTables) -> Sequence[Table]:
    rows = [
        (
            " and ".join(map(kind_in_words, a.kinds)) or "nothing missing",
            a.where or a.sentence,
            a.odds,
        )
        for a in found.alternatives
    ]
    columns = left("what", "where", "beside what was found")
    return [Table.of("Also considered", columns, rows)] if rows else []


ALTERNATIVES = Section("Also considered", "alternatives", DiscoverTables, _tables)
