"""What to measure next where the data do not decide."""

from collections.abc import Sequence

from ....core.results.discovery import DiscoverTables
from ..html.markup import esc, tag
from ..tables.table import Table, left
from .section import ReportedRun, Section


def _tables(found: DiscoverTables) -> Sequence[Table]:
    rows = [(said,) for said in found.would_decide]
    return [Table.of("What would decide", left(""), rows)] if rows else []


def _render(run: ReportedRun[DiscoverTables]) -> str:
    said = run.tables.would_decide
    return tag("ul", *[tag("li", esc(s)) for s in said]) if said else ""


WOULD_DECIDE = Section("What would decide", "decide", DiscoverTables, _tables, _render)
