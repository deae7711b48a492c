"""What a section of the report declares, and the run that it is made from."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from ....core.data.geometry import Geometry
from ....core.results.correlation import RunTables
from ..html.html_table import html_table
from ..pictures.film import Film
from ..pictures.function_overlay import Curves
from ..tables.table import Table

T = TypeVar("T", bound=RunTables)


@dataclass(frozen=True, eq=False)
class ReportedRun(Generic[T]):
    """A run as the report sees it.

    Parameters
    ----------
    tables : RunTables
        What the verb answered: `CorrelateTables`, `UpdateTables`, `DiscoverTables`.
    geometry : Geometry or None
        The analysis model, for pictures.
    shapes : Film or None
        Shapes of the pairs and of modes without a partner.
    diff : str
        Unified diff of the deck; empty where it was not changed.
    curves : Curves or None
        Measured frequency responses and those of the model.
    """

    tables: T
    geometry: Geometry | None = None
    shapes: Film | None = None
    diff: str = ""
    curves: Curves | None = None


def no_tables(tables: RunTables) -> Sequence[Table]:
    """Return no table: for a section of pictures."""
    return ()


@dataclass(frozen=True)
class Section(Generic[T]):
    """A section of the report.

    Parameters
    ----------
    title : str
        Heading, and name among the links.
    anchor : str
        Where links lead; one of its own.
    of : type
        Answers that may have something to say to it: a verb's own, or `RunTables` for all.
    tables : callable, optional
        ``tables(answer)`` returns its tables, which the terminal shows as well.
    render : callable, optional
        ``render(run)`` returns the markup under the heading, empty where the run says nothing
        (then there is no section). Default: the tables.
    """

    title: str
    anchor: str
    of: type[T]
    tables: Callable[[T], Sequence[Table]] = no_tables
    render: Callable[[ReportedRun[T]], str] | None = None

    def tables_of(self, answer: RunTables) -> Sequence[Table]:
        """Return its tables of an answer; none where it says nothing."""
        return self.tables(answer) if isinstance(answer, self.of) else ()

    def body(self, run: ReportedRun[T]) -> str:
        """Return the markup under the heading; empty where the run says nothing."""
        if not isinstance(run.tables, self.of):
            return ""
        if self.render is not None:
            return self.render(run)
        return "".join(html_table(table) for table in self.tables(run.tables))
