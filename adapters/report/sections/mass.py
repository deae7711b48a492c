"""What the deck weighs, and where its centre of gravity is."""

from collections.abc import Sequence

from ....core.results.correlation import RunTables
from ..tables.number_formats import placed, weighed
from ..tables.table import Table, left
from .section import Section


def _tables(answer: RunTables) -> Sequence[Table]:
    rows = [
        (row.deck, weighed(row.mass, row.kilograms), placed((row.x, row.y, row.z), row.length_unit))
        for row in answer.weight
    ]
    note = "" if all(row.kilograms for row in answer.weight) else "Densities do not tell the unit."
    columns = [*left("deck"), "mass", *left("centre of gravity")]
    return [Table.of("Mass and centre of gravity", columns, rows, note)] if rows else []


MASS = Section("Mass and centre of gravity", "mass", RunTables, _tables)
