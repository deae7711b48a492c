"""What else was considered, and how likely it is beside what was found."""

from collections.abc import Sequence

from ....core.results.discovery import DiscoverTables
from ..tables.table import Cell, Column, Table
from .findings import kind_in_words
from .section import Section


def _tables(found: DiscoverTables) -> Sequence[Table]:
    rows = tuple(
        (
            Cell(" and ".join(map(kind_in_words, a.kinds)) or "nothing missing"),
            Cell(a.where or a.sentence),
            Cell(a.odds),
        )
        for a in found.alternatives
    )
    columns = ("what", "where", "beside what was found")
    headings = tuple(Column(c, numeric=False) for c in columns)
    return [Table("Also considered", headings, rows)] if rows else []


ALTERNATIVES = Section("Also considered", "alternatives", DiscoverTables, _tables)
